//! OBJ and MTL files as text, in any encoding, and the files that they name.

use std::path::Path;

use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::{ImportOptions, import};

use crate::common::gltf_text::warns;
use crate::common::obj_text::{TRIANGLE, folder, material, phong, png, red, try_import, write};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const FACE: &str = "f 1/1 2/2 3/3 4/4\n";

/// The diffuse colours of the materials in use.
fn colors(scene: &SceneDesc) -> Vec<[f32; 3]> {
    scene
        .materials
        .iter()
        .map(|material| phong(material).diffuse.factor)
        .collect()
}

/// Encodings of a text, with their names.
fn encodings(text: &str) -> Vec<(&'static str, Vec<u8>)> {
    let utf16 =
        |bytes: fn(u16) -> [u8; 2]| -> Vec<u8> { text.encode_utf16().flat_map(bytes).collect() };
    vec![
        ("UTF-8", text.into()),
        ("UTF-8 with mark", format!("\u{feff}{text}").into()),
        ("UTF-16 LE", utf16(u16::to_le_bytes)),
        ("UTF-16 BE", utf16(u16::to_be_bytes)),
        (
            "UTF-16 LE with mark",
            [vec![0xff, 0xfe], utf16(u16::to_le_bytes)].concat(),
        ),
        (
            "UTF-16 BE with mark",
            [vec![0xfe, 0xff], utf16(u16::to_be_bytes)].concat(),
        ),
        ("CR LF", text.replace('\n', "\r\n").into()),
        ("CR", text.replace('\n', "\r").into()),
        (
            "CR, UTF-16 LE",
            text.replace('\n', "\r")
                .encode_utf16()
                .flat_map(u16::to_le_bytes)
                .collect(),
        ),
        ("no last line end", text.trim_end().into()),
        ("end of a DOS file", format!("{text}\u{1a}").into()),
    ]
}

#[test]
fn every_encoding_and_line_end_gives_the_same_scene() {
    let obj = format!("mtllib a.mtl\n{SQUARE}usemtl m\nf 1/1 2/2 \\\n3/3 4/4\n");
    let late = format!("{SQUARE}mtllib a.mtl\nusemtl m\n{FACE}");
    let mtl = "newmtl m\nKd 0.5 0.25 0.125\nillum 1\n";
    for text in [&*obj, &*late] {
        for (obj_encoding, obj) in encodings(text) {
            for (mtl_encoding, mtl) in encodings(mtl) {
                let scene = try_import(&[("a.obj", &obj), ("a.mtl", &mtl)]).unwrap();
                let pair = format!("{obj_encoding}, {mtl_encoding}");
                assert!(scene.warnings.is_empty(), "{pair}: {:?}", scene.warnings);
                assert_eq!(colors(&scene), [[0.5, 0.25, 0.125]], "{pair}");
                assert_eq!(scene.meshes[0].triangles.len(), 2, "{pair}");
            }
        }
    }
}

#[test]
fn comments_that_end_in_a_backslash_continue_nothing() {
    for comment in [
        "# D:\\scans\\tray\\",
        "  # D:\\ ",
        "#\\",
        "g tray # in D:\\",
        "o D:\\scans\\",
    ] {
        for end in ["\n", "\r\n", "\r"] {
            let text = format!("{comment}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1 2 3\n")
                .replace('\n', end);
            let scene = try_import(&[("a.obj", &text)]).unwrap();
            assert_eq!(scene.meshes[0].positions[1].x, 1.0, "{comment}");
            assert!(scene.warnings.is_empty(), "{comment}: {:?}", scene.warnings);
        }
    }
}

/// Whatever the code page, names stay apart, and name the same in both files.
#[test]
fn names_in_code_pages_stay_distinct() {
    let names: [&[u8]; 4] = [b"\xd6l", b"\xc4l", b"\x95\x5c", b"\x95\x5d"];
    let (mut obj, mut mtl) = (b"mtllib a.mtl\n".to_vec(), Vec::new());
    obj.extend(SQUARE.as_bytes());
    for (index, name) in names.into_iter().enumerate() {
        // Half of the third name is a backslash, which continues nothing.
        obj.extend([b"usemtl ", name, b"\n", FACE.as_bytes()].concat());
        mtl.extend(
            [
                b"newmtl ",
                name,
                b"\n",
                format!("Kd 0.{index} 0 0\n").as_bytes(),
            ]
            .concat(),
        );
    }
    let scene = try_import(&[("a.obj", obj), ("a.mtl", mtl)]).unwrap();
    let reds: Vec<f32> = colors(&scene).iter().map(|color| color[0]).collect();
    assert_eq!(reds, [0.0, 0.1, 0.2, 0.3]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn files_named_in_code_pages_are_found() {
    for (bytes, name) in [
        (&b"\xd6l.png"[..], "Öl.png"),
        (b"\x95\x5c.png", "表.png"),
        (b"\xb1\xed.png", "表.png"),
        (b"\xcc\xe0\xf1\xeb\xee.png", "масло.png"),
    ] {
        let mtl = [b"newmtl m\nmap_Kd ", bytes, b"\n"].concat();
        let folder = folder(&[("a.obj", TRIANGLE.as_bytes()), ("a.mtl", &mtl)]);
        write(folder.path(), name, &png([7, 0, 0, 255]));
        let scene = import(&folder.path().join("a.obj"), &ImportOptions::default()).unwrap();
        assert_eq!(red(&scene, 0), 7, "{name}: {:?}", scene.warnings);
    }
    // Or by these very bytes.
    #[cfg(unix)]
    {
        let name: &std::ffi::OsStr = std::os::unix::ffi::OsStrExt::from_bytes(b"\xd6\xff.png");
        let mtl = b"newmtl m\nmap_Kd \xd6\xff.png\n";
        let folder = folder(&[("a.obj", TRIANGLE.as_bytes()), ("a.mtl", mtl)]);
        write(folder.path(), Path::new(name), &png([7, 0, 0, 255]));
        let scene = import(&folder.path().join("a.obj"), &ImportOptions::default()).unwrap();
        assert_eq!(red(&scene, 0), 7, "{:?}", scene.warnings);
    }
}

/// Files that were packed on a Mac have accents as characters of their own.
/// Some programs write names as parts of URIs.
#[test]
fn percent_escapes_in_names_are_decoded_where_no_file_has_them() {
    let red_of = |written: &str, files: &[(&str, u8)]| {
        let mtl = format!("newmtl m\nmap_Kd {written}\n");
        let folder = folder(&[("a.obj", TRIANGLE), ("a.mtl", &mtl)]);
        for (name, red) in files {
            write(folder.path(), name, &png([*red, 0, 0, 255]));
        }
        let scene = import(&folder.path().join("a.obj"), &ImportOptions::default()).unwrap();
        (red(&scene, 0), scene.warnings.len())
    };
    let spaced = [("my tex.png", 7)];
    assert_eq!(red_of("my%20tex.png", &spaced), (7, 0));
    assert_eq!(red_of("my%2520tex.png", &spaced), (7, 0));
    assert_eq!(red_of("MY%20TEX.PNG", &spaced), (7, 0));
    assert_eq!(red_of("-s 2 2 \"my%20tex.png\"", &spaced), (7, 0));
    assert_eq!(red_of("%C3%96l.png", &[("Öl.png", 7)]), (7, 0));
    assert_eq!(red_of("%D6l.png", &[("Öl.png", 7)]), (7, 0));
    assert_eq!(red_of("100%25.png", &[("100%.png", 7)]), (7, 0));
    // From another machine.
    let url = "file:///C:/scans/my%20tex.png";
    assert_eq!(red_of(url, &spaced), (7, 1));
    // A file that is called so is meant.
    let both = [("my tex.png", 7), ("my%20tex.png", 8)];
    assert_eq!(red_of("my%20tex.png", &both), (8, 0));
    let obj = TRIANGLE.replace("a.mtl", "my%20lib.mtl");
    let scene = try_import(&[
        ("a.obj", &*obj),
        ("my lib.mtl", "newmtl m\nKd 0.5 0.5 0.5\n"),
    ]);
    assert_eq!(colors(&scene.unwrap()), [[0.5; 3]]);
}

#[test]
fn accents_may_be_composed_in_another_way() {
    let obj = format!("mtllib a.mtl\n{SQUARE}usemtl \u{d6}l\n{FACE}");
    let folder = folder(&[
        ("a.obj", &*obj),
        ("a.mtl", "newmtl O\u{308}l\nmap_Kd \u{d6}l.png\n"),
    ]);
    write(folder.path(), "O\u{308}l.png", &png([7, 0, 0, 255]));
    let scene = import(&folder.path().join("a.obj"), &ImportOptions::default()).unwrap();
    assert_eq!(red(&scene, 0), 7, "{:?}", scene.warnings);
}

#[test]
fn libraries_are_found_however_they_are_named() {
    let square = |mtllib: &str| format!("{mtllib}\n{SQUARE}usemtl m\n{FACE}");
    let mtl = "newmtl m\nKd 0.5 0 0\n";
    for (mtllib, file, is_silent) in [
        ("mtllib red tray.mtl", "red tray.mtl", true),
        ("mtllib \"red tray.mtl\"", "red tray.mtl", true),
        ("mtllib 'red tray.mtl'", "red tray.mtl", true),
        ("mtllib red.mtl # the red one", "red.mtl", true),
        ("mtllib red#1.mtl", "red#1.mtl", true),
        ("mtllib ./RED.MTL", "red.mtl", true),
        ("mtllib .\\sub\\red.mtl", "sub/Red.mtl", true),
        (
            "mtllib other.mtl red tray.mtl third.mtl",
            "red tray.mtl",
            false,
        ),
        ("mtllib C:\\jobs\\red tray.mtl", "red tray.mtl", false),
        ("mtllib \"C:\\jobs\\Red Tray.mtl\"", "red tray.mtl", false),
        ("mtllib /home/somebody/red.mtl", "red.mtl", false),
        ("mtllib C:\\jobs\\sub\\red.mtl", "sub/red.mtl", false),
        ("mtllib old name.mtl", "a.mtl", false),
        ("", "a.mtl", false),
    ] {
        let scene = try_import(&[("a.obj", &*square(mtllib)), (file, mtl)]).unwrap();
        assert_eq!(
            colors(&scene),
            [[0.5, 0.0, 0.0]],
            "{mtllib}: {:?}",
            scene.warnings
        );
        assert_eq!(
            scene.warnings.is_empty(),
            is_silent,
            "{mtllib}: {:?}",
            scene.warnings
        );
    }
    let several = format!("mtllib a b.mtl c.mtl\n{SQUARE}usemtl m\n{FACE}usemtl n\n{FACE}");
    let quoted = several.replace("a b.mtl c.mtl", "\"a b.mtl\" \"c.mtl\"");
    for text in [&*several, &*quoted] {
        let scene = try_import(&[
            ("a.obj", text),
            ("a b.mtl", mtl),
            ("c.mtl", "newmtl n\nKd 0 0.5 0"),
        ])
        .unwrap();
        assert_eq!(colors(&scene), [[0.5, 0.0, 0.0], [0.0, 0.5, 0.0]]);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

#[test]
fn libraries_may_come_late_and_define_names_anew() {
    let mtl = |red: &str| format!("newmtl m\nKd {red} 0 0\n");
    let files = |obj: String| {
        [
            ("a.obj", obj),
            ("1.mtl", mtl("0.5")),
            ("2.mtl", mtl("0.25")),
        ]
    };
    let import = |obj: String| {
        let scene = try_import(&files(obj)).unwrap();
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
        colors(&scene)
            .iter()
            .map(|color| color[0])
            .collect::<Vec<_>>()
    };
    assert_eq!(
        import(format!("{SQUARE}usemtl m\n{FACE}mtllib 1.mtl\n")),
        [0.5]
    );
    assert_eq!(
        import(format!("usemtl m\nmtllib 1.mtl\n{SQUARE}{FACE}")),
        [0.5]
    );
    let joined = format!("mtllib 1.mtl\n{SQUARE}usemtl m\n{FACE}mtllib 2.mtl\nusemtl m\n{FACE}");
    assert_eq!(import(joined), [0.5, 0.25]);
}

#[test]
fn names_of_materials_are_forgiven_quotes_comments_case_and_spaces() {
    let import = |newmtl: &str, usemtl: &str| {
        let obj = format!("mtllib a.mtl\n{SQUARE}usemtl {usemtl}\n{FACE}");
        let mtl = format!("newmtl other\nKd 0 0 0\nnewmtl {newmtl}\nKd 0.5 0 0\n");
        try_import(&[("a.obj", obj), ("a.mtl", mtl)]).unwrap()
    };
    for (newmtl, usemtl, is_silent) in [
        ("red tray", "red tray", true),
        ("\"red tray\"", "red tray", true),
        ("red", "\"red\"", true),
        ("red # warm", "red", true),
        ("red", "red # warm", true),
        ("red \t", "red", true),
        ("Material #25", "Material #25", true),
        ("red#1", "red#1", true),
        ("Red", "red", false),
        ("red  tray", "red tray", false),
    ] {
        let scene = import(newmtl, usemtl);
        assert_eq!(colors(&scene), [[0.5, 0.0, 0.0]], "{newmtl} {usemtl}");
        assert_eq!(
            scene.warnings.is_empty(),
            is_silent,
            "{newmtl} {usemtl}: {:?}",
            scene.warnings
        );
    }
    // A number that looks like a comment tells materials apart.
    let obj = format!(
        "mtllib a.mtl\n{SQUARE}usemtl Material #25\n{FACE}usemtl Material #26\n{FACE}usemtl Material\n{FACE}"
    );
    let mtl = "newmtl Material #25\nKd 0.5 0 0\nnewmtl Material #26\nKd 0.25 0 0\nnewmtl Material\nKd 0 0 0\n";
    let scene = try_import(&[("a.obj", &*obj), ("a.mtl", mtl)]).unwrap();
    assert_eq!(
        colors(&scene),
        [[0.5, 0.0, 0.0], [0.25, 0.0, 0.0], [0.0; 3]]
    );
}

#[test]
fn textures_are_found_beside_the_library_and_by_the_end_of_their_path() {
    for (name, file, is_silent) in [
        ("wood grain.png", "wood grain.png", true),
        ("\"wood grain.png\"", "wood grain.png", true),
        ("wood.png # the floor", "wood.png", true),
        ("wood #2.png", "wood #2.png", true),
        ("-s 1 1 1 maps\\WOOD.png", "maps/wood.png", true),
        (
            "C:\\Users\\somebody\\kitchen job\\maps\\wood.png",
            "wood.png",
            false,
        ),
        (
            "C:\\Users\\somebody\\kitchen job\\maps\\wood.png",
            "maps/Wood.png",
            false,
        ),
        ("C:/Users/somebody/wood.png", "wood.PNG", false),
        ("/Users/somebody/maps/wood.png", "wood.png", false),
        ("\\\\server\\share\\wood.png", "wood.png", false),
        ("..\\..\\wood.png", "wood.png", false),
        ("wood.png", "textures/wood.png", false),
        ("wood.png", "Textures/wood.png", false),
    ] {
        for below in ["", "sub/"] {
            let mtl = format!("newmtl m\nmap_Kd {name}\n");
            let obj = TRIANGLE.replace("a.mtl", &format!("{below}b.mtl"));
            let folder = folder(&[("a.obj", obj), (&*format!("{below}b.mtl"), mtl)]);
            write(
                folder.path(),
                format!("{below}{file}"),
                &png([7, 0, 0, 255]),
            );
            let scene = import(&folder.path().join("a.obj"), &ImportOptions::default()).unwrap();
            assert_eq!(
                red(&scene, 0),
                7,
                "{name} {below}{file}: {:?}",
                scene.warnings
            );
            assert_eq!(
                scene.warnings.is_empty(),
                is_silent,
                "{name} {file}: {:?}",
                scene.warnings
            );
        }
    }
    // The library's folder comes first, the scene's second.
    let obj = TRIANGLE.replace("a.mtl", "sub/b.mtl");
    let mtl = "newmtl m\nmap_Kd 1.png\nmap_Ks 2.png\nKs 0.1 0.1 0.1\nNs 9";
    let folder = folder(&[("a.obj", &*obj), ("sub/b.mtl", mtl)]);
    for (name, red) in [("1.png", 1), ("sub/1.png", 2), ("2.png", 3)] {
        write(folder.path(), name, &png([red, 0, 0, 255]));
    }
    let scene = import(&folder.path().join("a.obj"), &ImportOptions::default()).unwrap();
    assert_eq!((red(&scene, 0), red(&scene, 1)), (2, 3));
}

#[test]
fn backslashes_spaces_and_other_case_find_the_file() {
    let (found, scene) = material("map_Kd TEX\\deep one.png");
    assert_eq!(
        red(
            &scene,
            phong(&found).diffuse.texture.as_ref().unwrap().texture
        ),
        2
    );
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn missing_files_and_materials_are_warnings() {
    let scene = try_import(&[("a.obj", TRIANGLE)]).unwrap();
    assert!(warns(&scene, "line 1", "a.mtl"), "{:?}", scene.warnings);
    assert!(warns(&scene, "line 8", "\"m\""), "{:?}", scene.warnings);
    assert_eq!(phong(&scene.materials[0]).diffuse.factor, [0.8; 3]);
    let (white, scene) = material("map_Kd nowhere.png");
    assert!(phong(&white).diffuse.texture.is_some());
    assert!(
        warns(&scene, "nowhere.png", "is not there"),
        "{:?}",
        scene.warnings
    );
}
