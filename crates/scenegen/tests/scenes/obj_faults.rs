//! Faults of OBJ files, which cost what they are in and not the file.

use glam::Vec3;
use residual_scenegen::import::{ImportOptions, import};

use crate::common::gltf_text::warns;
use crate::common::obj_text::{folder, geometry, try_import};

#[test]
fn references_to_an_attribute_that_is_nowhere_are_ignored() {
    let scene =
        try_import(&[("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/2/1 3/3/1\n")]).unwrap();
    assert_eq!(scene.meshes[0].normals, [Vec3::Z; 3]);
    assert_eq!(scene.meshes[0].uvs, [None, None]);
    assert!(
        warns(&scene, "line 4", "vn, of which there are none"),
        "{:?}",
        scene.warnings
    );
}

/// What makes no sense costs itself, and with `--strict` the file.
#[test]
fn malformed_lines_are_warnings_with_their_line() {
    let good = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    for (line, message) in [
        ("v 1 x 0\nf 1 2 4", "line 5: 1 vertices lack a number"),
        ("v 1 1.#IND 0", "line 5: 1 vertices lack a number"),
        ("v 1 0", "line 5: 1 vertices lack a number"),
        (
            "v 1 nan 0\nv inf 0 0",
            "line 5 and others: 2 vertices lack a number",
        ),
        ("f 1 a 1", "line 5: 1 faces have a word that is no index"),
        (
            "f 1 2 3/1/1/1",
            "line 5: 1 faces have a word that is no index",
        ),
        ("f 1 2", "line 5: 1 faces have fewer than three corners"),
        ("f", "line 5: 1 faces have fewer than three corners"),
        (
            "f 1 2 4",
            "line 5: 1 faces refer to a v that is none of the 3",
        ),
        ("f 0 1 2", "line 5: 1 faces refer to a v"),
        ("f -1 -2 -4", "line 5: 1 faces refer to a v"),
        ("f 1 2 4294967296", "line 5: 1 faces refer to a v"),
        (
            "vt 0 0\nf 1/-9223372036854775808 2/9 3",
            "line 6 and others: 2 corners refer to a vt that is none of the 1",
        ),
        (
            "vn 0 0 1\nf 1//0 2//1 3//1",
            "line 6: 1 corners refer to a vn that is none of the 1",
        ),
        (
            "vt nan 0\nf 1/1 2/1 3/1",
            "line 5: 1 texture coordinates lack a number",
        ),
        (
            "vn 0 0\nf 1//1 2//1 3//1",
            "line 5: 1 normals lack a number",
        ),
        (
            "curv2 1 2\nend",
            "line 5 and others: 2 statements of free-form curves",
        ),
        ("s wide", "line 5: s \"wide\" is no smoothing group"),
        ("usemtl", "line 5: usemtl without a name"),
        ("mtllib", "line 5: mtllib without a name"),
        (
            "bogus 1\nfoo",
            "line 5 and others: 2 statements such as \"bogus\"",
        ),
        ("v 1 1 0 0.5", "line 5: 1 vertices have a weight"),
        ("v 1 1 0 0", "line 5: 1 vertices have a weight"),
        (
            "v 1 1 0 1 0",
            "line 5: 1 vertices have numbers that are neither",
        ),
        (
            "v 1 1 0 1 0 0 1",
            "line 5: 1 vertices have numbers that are neither",
        ),
        ("v 1,5 1 0", "line 5: 1 numbers have a comma"),
    ] {
        let text = format!("{good}{line}\n");
        let scene = geometry(&text);
        assert_eq!(scene.meshes[0].triangles[0], [0, 1, 2], "{line}");
        let folder = folder(&[("a.obj", &text)]);
        let options = ImportOptions {
            strict: true,
            ..ImportOptions::default()
        };
        let error = import(&folder.path().join("a.obj"), &options)
            .expect_err(line)
            .to_string();
        assert!(
            error.contains(message) && error.contains("a.obj"),
            "{line}: {error}"
        );
    }
}

#[test]
fn numbers_that_are_none_cost_the_faces_at_their_vertex() {
    for word in ["nan", "-1.#IND", "1.#QNAN0", "1e99", "zero"] {
        let scene = geometry(&format!(
            "v 0 0 0\nv {word} 0 0\nv 0 1 0\nv 1 0 0\nf 1 4 3\nf 1 2 3\n"
        ));
        assert_eq!(scene.meshes[0].triangles, [[0, 1, 2]], "{word}");
        assert_eq!(scene.meshes[0].positions[1], Vec3::X);
    }
}

#[test]
fn polygons_that_cross_themselves_are_said_to_be_fans() {
    for face in ["1 3 2 4", "1 2 4 3", "1 3 2 4 5", "1 3 5 2 4"] {
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -0.5 0.5 0\n";
        let scene = geometry(&format!("{corners}f {face}\n"));
        let message = "1 polygons cross themselves or have too many corners; they are fans";
        assert!(
            warns(&scene, "line 6", message),
            "{face}: {:?}",
            scene.warnings
        );
        let count = face.split(' ').count() - 2;
        assert_eq!(scene.meshes[0].triangles.len(), count, "{face}");
    }
}

#[test]
fn clouds_of_points_are_said_not_to_be_rendered() {
    let scene = geometry("v 0 0 0\nv 1 0 0\n");
    assert!(
        warns(&scene, "v", "2 vertices and no face"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn decimal_commas_are_decimal_points() {
    let scene = geometry("v 0,0 0,5 0\nv 1,25 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_eq!(
        scene.meshes[0].positions[..2],
        [Vec3::new(0.0, 0.5, 0.0), Vec3::new(1.25, 0.0, 0.0)]
    );
    assert!(
        warns(&scene, "line 1 and others", "3 numbers have a comma"),
        "{:?}",
        scene.warnings
    );
}

/// Whatever a byte becomes, the end is a scene or an error.
#[test]
fn mutated_files_end_in_a_scene_or_an_error() {
    let obj = "mtllib \"a.mtl\" b.mtl\n\u{feff}v 0 0 0 1 0.5 0\nv 1 0 0\nv 1,5 1 0 1\nv 0 1 0\nvt 0 0\nvt 1 0 0\nvn 0 0 1\n\
               s 1\nusemtl m # x\nf 1/1/1 2/2 3//1 \\\n-1\ng a b\ns off\nusemtl n\nf -4 -3 -2\nl 1 2\n";
    let mtl = "newmtl m\nKd 0 0 0\nmap_Kd -s 2 2 2 -o 0 1 \"kd.png\" -bm 1\nTr 1\nnewmtl n\nKs 1 1 1\nNs 5\nillum 7\nd -halo 0.5\n\
               Tf xyz 1 1 1\nmap_Bump directions.png\nPr 0.5\n";
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let folder = folder(&[("a.obj", obj), ("a.mtl", mtl)]);
    let (mut scenes, mut triangles) = (0, 0);
    for _ in 0..500 {
        for (name, text) in [("a.obj", obj), ("a.mtl", mtl)] {
            let mut bytes = text.as_bytes().to_vec();
            for _ in 0..random(4) {
                let index = random(bytes.len());
                match random(3) {
                    0 => bytes[index] = random(256) as u8,
                    1 => drop(bytes.remove(index)),
                    _ => bytes.insert(index, b"\\\r\n#/-. \"9\0"[random(10)]),
                }
            }
            std::fs::write(folder.path().join(name), bytes).unwrap();
        }
        if let Ok(scene) = import(&folder.path().join("a.obj"), &ImportOptions::default()) {
            scenes += 1;
            triangles += scene
                .meshes
                .iter()
                .map(|mesh| mesh.triangles.len())
                .sum::<usize>();
        }
    }
    assert!(
        scenes > 475 && triangles > 500,
        "{scenes} scenes of {triangles} triangles"
    );
}
