//! Names that an OBJ file and its library have in different code pages.

use encoding_rs::{
    EUC_JP, EUC_KR, Encoding, GB18030, MACINTOSH, SHIFT_JIS, UTF_8, WINDOWS_1250, WINDOWS_1251,
    WINDOWS_1252,
};
use residual_scenegen::desc::SceneDesc;

use crate::common::gltf_text::warns;
use crate::common::obj_text::{phong, try_import};

/// A triangle whose material is named in one encoding, and a library in which names are in another.
fn import(usemtl: &[u8], newmtls: &[&[u8]]) -> SceneDesc {
    let obj = [
        b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl ",
        usemtl,
        b"\nf 1 2 3\n",
    ];
    let mut mtl = b"newmtl other\nKd 0 0 0\n".to_vec();
    for (index, name) in newmtls.iter().enumerate() {
        mtl.extend(
            [
                b"newmtl ",
                *name,
                format!("\nKd 0.{} 0 0\n", index + 1).as_bytes(),
            ]
            .concat(),
        );
    }
    try_import(&[("a.obj", obj.concat()), ("a.mtl", mtl)]).unwrap()
}

/// The red of the material in use, 0.8 where it is the default.
fn red(scene: &SceneDesc) -> f32 {
    phong(&scene.materials[0]).diffuse.factor[0]
}

fn encode(text: &str, page: &'static Encoding) -> Vec<u8> {
    let (bytes, _, has_others) = page.encode(text);
    assert!(!has_others, "{text} {}", page.name());
    bytes.into_owned()
}

#[test]
fn names_are_the_same_in_any_two_encodings() {
    for (names, page) in [
        (["Größe", "Grüße"], WINDOWS_1252),
        (["Größe", "Grüße"], MACINTOSH),
        (["赤い皿", "青い皿"], SHIFT_JIS),
        (["赤い皿", "青い皿"], EUC_JP),
        (["红色", "蓝色"], GB18030),
        (["빨강", "파랑"], EUC_KR),
        (["красный", "синий"], WINDOWS_1251),
        (["żółty", "biały"], WINDOWS_1250),
    ] {
        let utf8 = names.map(|name| encode(name, UTF_8));
        let legacy = names.map(|name| encode(name, page));
        for (obj, mtl) in [
            (&utf8, &legacy),
            (&legacy, &utf8),
            (&legacy, &legacy),
            (&utf8, &utf8),
        ] {
            for (index, name) in obj.iter().enumerate() {
                let scene = import(name, &[&mtl[0], &mtl[1]]);
                let expected = [0.1, 0.2][index];
                assert_eq!(
                    red(&scene),
                    expected,
                    "{} {names:?}: {:?}",
                    page.name(),
                    scene.warnings
                );
                // Windows-1252 is what legacy bytes are read as.
                let is_plain = obj == mtl || page == WINDOWS_1252;
                assert_eq!(
                    warns(&scene, "line 5", "is used"),
                    !is_plain,
                    "{:?}",
                    scene.warnings
                );
            }
        }
    }
}

/// UTF-8 that another program took for Windows-1252, and wrote as UTF-8 again.
#[test]
fn names_that_were_decoded_wrongly_are_known_again() {
    let twice = "GrÃ¶ÃŸe".as_bytes();
    for (usemtl, newmtl) in [("Größe".as_bytes(), twice), (twice, "Größe".as_bytes())] {
        let scene = import(usemtl, &[newmtl]);
        assert_eq!(red(&scene), 0.1, "{:?}", scene.warnings);
    }
}

#[test]
fn what_may_be_several_names_is_none() {
    // One byte is a letter in both pages.
    let scene = import(b"\xe0", &["а".as_bytes(), "ŕ".as_bytes()]);
    assert_eq!(red(&scene), 0.8, "{:?}", scene.warnings);
    assert!(warns(&scene, "line 5", "is in no library; grey is used"));
    // Unless one of them is what the file says.
    let scene = import("ŕ".as_bytes(), &["а".as_bytes(), "ŕ".as_bytes()]);
    assert_eq!(red(&scene), 0.2);
    // Of materials of one name the last one counts, as always.
    let scene = import(&encode("синий", WINDOWS_1251), &["синий".as_bytes(); 2]);
    assert_eq!(red(&scene), 0.2, "{:?}", scene.warnings);
}
