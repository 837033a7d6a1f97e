//! Faults of OBJ files, which cost what they are in and not the file.

use glam::Vec3;
use residual_scenegen::import::{ImportOptions, import};

mod common;

use common::gltf_text::warns;
use common::obj_text::{folder, geometry, try_import};

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
