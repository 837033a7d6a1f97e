//! OBJ files as some programs write them, with what the format does not have.

use glam::{Vec3, Vec4};
use residual_render::texture::srgb_decoded;
use residual_scenegen::desc::SceneDesc;

use crate::common::gltf_text::warns;
use crate::common::obj_text::geometry;

const SQUARE: &str =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n";

/// A square is there, with texture coordinates if the face has them.
fn check_square(statements: &str) -> SceneDesc {
    let scene = geometry(&format!("{SQUARE}{statements}\nv 9 9 9\n"));
    assert_eq!(scene.meshes.len(), 1, "{statements}: {:?}", scene.warnings);
    let mesh = &scene.meshes[0];
    let corners = mesh.triangles.as_flattened().iter();
    let positions: Vec<Vec3> = corners
        .map(|&corner| mesh.positions[corner as usize])
        .collect();
    let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::X + Vec3::Y, Vec3::Y];
    assert_eq!(positions, [a, b, c, a, c, d], "{statements}");
    assert_eq!(mesh.uvs[0].is_some(), statements.contains('/'));
    scene
}

#[test]
fn indices_may_be_written_as_numbers_with_a_fraction() {
    for face in [
        "f 1.0 2.0 3.0 4.0",
        "f 1.000000/1.000000 2.000000/2.000000 3.000000/3.000000 4.000000/4.000000",
        "f 1. 2. 3. 4.",
        "f 1.0/1/1.0 2/2.0/1 3.0//1 4.0//1.0",
        "f -4.0 -3.0 -2.0 -1.0",
        "f 1,0 2,0 3,0 4,0",
    ] {
        let scene = check_square(face);
        assert!(scene.warnings.len() <= 1, "{face}: {:?}", scene.warnings);
    }
    let scene = geometry(&format!("{SQUARE}f 1.5 2 3\nf 1 2 3\n"));
    assert!(warns(
        &scene,
        "line 10",
        "1 faces have a word that is no index"
    ));
    assert_eq!(scene.meshes[0].triangles.len(), 1);
}

#[test]
fn punctuation_separates_no_more_than_a_space() {
    for face in [
        "f 1 2 3 4;",
        "f 1 2 3 4 ;",
        "f 1, 2, 3, 4",
        "f 1,2,3,4",
        "f 1, 2, 3, 4,",
        "f 1/1, 2/2, 3/3, 4/4;",
        "f 1/1,2/2,3/3,4/4",
        "f 1;2;3;4;",
    ] {
        let scene = check_square(face);
        assert!(
            warns(&scene, "line 10", "lines have commas or semicolons"),
            "{face}: {:?}",
            scene.warnings
        );
        assert_eq!(scene.warnings.len(), 1, "{face}: {:?}", scene.warnings);
    }
    let scene =
        geometry("v 0.0, 0.0, 0.0\nv 1.5, 0, 0;\nv 0 1 0 ;\nvt 0.5, 0.25;\nf 1/1 2/1 3/1\n");
    assert_eq!(
        scene.meshes[0].positions,
        [Vec3::ZERO, 1.5 * Vec3::X, Vec3::Y]
    );
    assert_eq!(
        scene.meshes[0].uvs[0].as_ref().unwrap()[0],
        glam::Vec2::new(0.5, 0.75)
    );
    assert!(warns(&scene, "line 1 and others", "4 lines have commas"));
    assert_eq!(scene.warnings.len(), 1, "{:?}", scene.warnings);
    // Colours behind them as well.
    let scene = geometry("v 0 0 0, 1, 0, 0;\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n");
    assert_eq!(
        scene.meshes[0].colors.as_ref().unwrap()[0],
        Vec4::new(1.0, 0.0, 0.0, 1.0)
    );
}

#[test]
fn faces_go_on_over_comments_and_end_with_the_file() {
    for face in [
        "f 1 2 \\\n# a comment\n3 4",
        "f 1 2 \\\n# one\n# two\n 3 \\\n# three\n 4",
        "f 1 2 # a comment \\\n3 4",
        "f 1 2 \\\n3 4 # a comment",
        "f 1/1 2/2 \\\n# a comment \\\n3/3 4/4",
    ] {
        let scene = check_square(face);
        assert!(scene.warnings.is_empty(), "{face}: {:?}", scene.warnings);
    }
    for end in ["\\", " \\", " \\\n", "\\\r\n", " \\\n\n"] {
        let scene = geometry(&format!("{SQUARE}f 1 2 3 4{end}"));
        assert_eq!(scene.meshes[0].triangles.len(), 2, "{end:?}");
        assert!(scene.warnings.is_empty(), "{end:?}: {:?}", scene.warnings);
    }
}

#[test]
fn vertices_have_the_colours_of_zbrush() {
    let linear = |code: u8| srgb_decoded(f64::from(f32::from(code) / 255.0)) as f32;
    let color = |[r, g, b]: [u8; 3]| Vec4::new(linear(r), linear(g), linear(b), 1.0);
    let [red, green, blue] = [[255, 0, 0], [0, 128, 0], [0, 0, 64]].map(color);
    let triangle = |z: u32| format!("v 0 0 {z}\nv 1 0 {z}\nv 0 1 {z}\n");
    let block = "#The following MRGB block contains ZBrush Vertex Color (Polypaint)\n#MRGB 00ff0000ff008000ff000040\n# End of MRGB block\n";
    let scene = geometry(&format!("{}{block}f 1 2 3\n", triangle(0)));
    assert_eq!(scene.meshes[0].colors, Some(vec![red, green, blue]));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    // On several lines, for the last of several objects, behind the faces.
    let scene = geometry(&format!(
        "o a\n{}f 1 2 3\no b\n{}f 4 5 6\n#MRGB ffff0000\n#MRGB ff008000ff000040\n",
        triangle(0),
        triangle(1)
    ));
    let colors: Vec<_> = scene
        .meshes
        .iter()
        .map(|mesh| mesh.colors.clone())
        .collect();
    assert_eq!(colors, [None, Some(vec![red, green, blue])]);
    // For each of several objects.
    let scene = geometry(&format!(
        "o a\n{}{block}f 1 2 3\no b\n{}#MRGB ff000040ff000040ff000040\nf 4 5 6\n",
        triangle(0),
        triangle(1)
    ));
    let firsts: Vec<Vec4> = scene
        .meshes
        .iter()
        .map(|mesh| mesh.colors.as_ref().unwrap()[0])
        .collect();
    assert_eq!(firsts, [red, blue]);
}

#[test]
fn broken_colours_of_zbrush_cost_themselves() {
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (lines, place, message) in [
        ("#MRGB ff00ff00fg\n", "line 4", "1 lines of #MRGB"),
        (
            "#MRGB xyz\n#MRGB ff\n",
            "line 4 and others",
            "2 lines of #MRGB",
        ),
        (
            "#MRGB ff000000ff000000ff000000ff000000\n",
            "#MRGB",
            "1 colours are for no vertex",
        ),
    ] {
        let scene = geometry(&format!("{triangle}{lines}f 1 2 3\n"));
        assert!(
            warns(&scene, place, message),
            "{lines}: {:?}",
            scene.warnings
        );
        assert_eq!(scene.meshes[0].triangles.len(), 1);
    }
    let scene = geometry(&format!("#MRGB ff000000\n{triangle}f 1 2 3\n"));
    assert_eq!(scene.meshes[0].colors, None);
    assert!(warns(&scene, "#MRGB", "1 colours are for no vertex"));
}
