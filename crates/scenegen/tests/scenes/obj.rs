//! The geometry of OBJ files, statement by statement.

use glam::{Vec2, Vec3, Vec4};
use residual_scenegen::desc::{MeshDesc, SceneDesc};
use residual_scenegen::import::{ImportOptions, import};

use crate::common;
use crate::common::gltf_text::warns;
use crate::common::obj_text::{geometry, material, phong, try_import};

/// The only mesh of a file that needs no warning.
fn faultless(text: &str) -> MeshDesc {
    let scene = geometry(text);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let [mesh] = &scene.meshes[..] else {
        panic!("{}", scene.meshes.len())
    };
    mesh.clone()
}

/// Twice the area of a mesh, along its normals.
fn area(mesh: &MeshDesc) -> f32 {
    let twice = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| mesh.positions[corner as usize]);
        (b - a).cross(c - a).dot(mesh.normals[corners[0] as usize])
    };
    0.5 * mesh.triangles.iter().map(twice).sum::<f32>()
}

#[test]
fn geometry_has_flat_normals_and_v_downwards() {
    let (_, scene) = material("Kd 1 0 0");
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.normals, [Vec3::Z; 3]);
    assert_eq!(
        mesh.uvs[0].as_ref().unwrap()[..],
        [Vec2::new(0., 1.), Vec2::new(1., 1.), Vec2::new(0., 0.25)]
    );
    assert_eq!(scene.instances.len(), 1);
    assert!(scene.materials[0].double_sided);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn polygons_colours_negative_indices_and_comments() {
    let text = "v 0 0 0 1 0 0 # red\nv 1 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 1 0 0.5 0.5 0.5\n\
                p 1\nl 1 2 3\nf -4 -3 \\\n-2 -1 # a square\n";
    let scene = try_import(&[("a.obj", text)]).unwrap();
    let mesh = &scene.meshes[0];
    assert_eq!(mesh.triangles.len(), 2);
    assert_eq!(mesh.normals, [Vec3::Z; 6]);
    assert_eq!(mesh.colors.as_ref().unwrap()[1], Vec4::new(0., 1., 0., 1.));
    assert!(warns(&scene, "p, l", "2 points and lines"));
}

#[test]
fn corners_with_and_without_normals_share_a_mesh() {
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\nf 2 4 3\n";
    let mesh = faultless(text);
    assert_eq!(
        mesh.normals,
        [Vec3::X, Vec3::X, Vec3::X, Vec3::Z, Vec3::Z, Vec3::Z]
    );
    // In one face.
    let mesh = faultless("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2 3//1\n");
    assert_eq!(mesh.normals, [Vec3::X, Vec3::Z, Vec3::X]);
}

#[test]
fn corners_without_texture_coordinates_cost_only_themselves() {
    let positions = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0.5 0.5\nvt 1 0\n";
    let faces = "f 1/1 2/2 3\nf 2/2 4/ 3/2\n";
    let plain = faultless(&format!("{positions}{faces}"));
    let uvs = [[0.5, 0.5], [1., 1.], [0., 0.], [1., 1.], [0., 0.], [1., 1.]].map(Vec2::from);
    assert_eq!(plain.uvs[0].as_ref().unwrap()[..], uvs);
    // Where a texture is read with them, that is said.
    let textured = format!("mtllib a.mtl\nusemtl m\n{positions}{faces}");
    let scene = try_import(&[("a.obj", &*textured), ("a.mtl", "newmtl m\nmap_Kd kd.png")]).unwrap();
    assert!(
        warns(
            &scene,
            "unnamed_object",
            "2 corners lack texture coordinates"
        ),
        "{:?}",
        scene.warnings
    );
    assert_eq!(scene.meshes[0].uvs[0].as_ref().unwrap()[..], uvs);
}

#[test]
fn a_weight_moves_no_vertex() {
    let mesh = faultless("v 0 0 0 1\nv 2 0 0 1.0\nv 0 2 0\nf 1 2 3\n");
    assert_eq!(mesh.positions[1], Vec3::new(2.0, 0.0, 0.0));
    let scene = geometry("v 0 0 0 0\nv 2 0 0 0.5\nv 0 2 0 2\nf 1 2 3\n");
    assert_eq!(
        scene.meshes[0].positions[1..],
        [Vec3::new(2., 0., 0.), Vec3::new(0., 2., 0.)]
    );
    assert!(warns(
        &scene,
        "line 1 and others",
        "3 vertices have a weight"
    ));
}

#[test]
fn vertex_colours_are_display_values_of_those_that_have_them() {
    let corners = "v 0 0 0 0.5 0.5 1\nv 1 0 0 0 0 0\nv 0 1 0\n";
    let mesh = faultless(&format!("{corners}f 1 2 3\n"));
    let colors = mesh.colors.unwrap();
    let expected = [[0.214_041, 0.214_041, 1., 1.], [0., 0., 0., 1.], [1.; 4]];
    for (color, expected) in colors.iter().zip(expected) {
        assert!(color.abs_diff_eq(Vec4::from(expected), 1e-5), "{color}");
    }
    // An object without any has none, before and after one that has some.
    let plain = "v 0 0 1\nv 1 0 1\nv 0 1 1\n";
    let scene = geometry(&format!(
        "{plain}{corners}{plain}o a\nf 1 2 3\no b\nf 4 5 6\no c\nf 7 8 9\n"
    ));
    let has_colors: Vec<bool> = scene
        .meshes
        .iter()
        .map(|mesh| mesh.colors.is_some())
        .collect();
    assert_eq!(has_colors, [false, true, false]);
    assert!(scene.warnings.is_empty());
}

#[test]
fn vertex_colours_without_a_material_are_left_as_they_are() {
    let scene = geometry(
        "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\no plain\nf 4 5 6\n",
    );
    let diffuse = |mesh: usize| {
        phong(&scene.materials[scene.meshes[mesh].material])
            .diffuse
            .factor
    };
    assert_eq!((diffuse(0), diffuse(1)), ([1.0; 3], [0.8; 3]));
    assert!(scene.warnings.is_empty());
}

#[test]
fn vertex_colours_may_be_bytes_out_of_range_or_broken() {
    let colors = |numbers: [&str; 3]| {
        let [a, b, c] = numbers;
        let scene = geometry(&format!("v 0 0 0 {a}\nv 1 0 0 {b}\nv 0 1 0 {c}\nf 1 2 3\n"));
        (scene.meshes[0].colors.clone().unwrap(), scene)
    };
    let (bytes, scene) = colors(["255 0 0", "0 255 0", "0 0 128"]);
    assert_eq!(bytes[0], Vec4::new(1., 0., 0., 1.));
    assert!((bytes[2].z - 0.215_861).abs() < 1e-5);
    assert!(warns(&scene, "v", "read as bytes"));
    let (clamped, scene) = colors(["1.5 0 0", "-0.5 0 0", "0 0 0"]);
    assert_eq!((clamped[0].x, clamped[1].x), (1.0, 0.0));
    assert!(warns(&scene, "v", "2 vertex colours are outside of 0 to 1"));
    let (broken, scene) = colors(["red 0 0", "0 0 0", "0 0 0"]);
    assert_eq!(broken[0], Vec4::ONE);
    assert!(warns(&scene, "v", "1 vertex colours lack a number"));
}

#[test]
fn concave_polygons_keep_their_outline() {
    let ell = "v 1 -1 0\nv 1 0 0\nv 0 0 0\nv 0 1 0\nv -1 1 0\nv -1 -1 0\n";
    let mesh = faultless(&format!("{ell}f 1 2 3 4 5 6\n"));
    assert_eq!((mesh.triangles.len(), area(&mesh)), (4, 3.0));
    let mesh = faultless(&format!("{ell}f 6 5 4 3 2 1\n"));
    assert_eq!((area(&mesh), mesh.normals[0]), (3.0, Vec3::NEG_Z));
    let arrow = faultless("v -1 -1 0\nv 0 -0.2 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3 4\n");
    assert!((area(&arrow) - 1.2).abs() < 1e-6);
    // Texture coordinates and normals go with their corners.
    let full = faultless(
        "v -1 -1 0\nv 0 -0.2 0\nv 1 -1 0\nv 0 1 0\nvt 0 1\nvt 1 1\nvt 2 1\nvt 3 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1 4/4/1\n",
    );
    for (position, uv) in full.positions.iter().zip(full.uvs[0].as_ref().unwrap()) {
        let expected = [[-1., -1.], [0., -0.2], [1., -1.], [0., 1.]][uv.x as usize];
        assert_eq!(position.truncate().to_array(), expected);
    }
    let crossed = geometry("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n");
    assert!(
        warns(&crossed, "line 5", "polygons cross themselves"),
        "{:?}",
        crossed.warnings
    );
}

/// A roof of two slopes at right angles.
fn roof(faces: &str) -> SceneDesc {
    geometry(&format!(
        "v -1 -1 -1\nv 0 -1 0\nv 0 1 0\nv -1 1 -1\nv 1 -1 -1\nv 1 1 -1\n{faces}\n"
    ))
}

#[test]
fn faces_of_a_smoothing_group_share_normals() {
    let [left, right] = [
        Vec3::new(-0.5, 0.0, 0.5).normalize(),
        Vec3::new(0.5, 0.0, 0.5).normalize(),
    ];
    let normals_at_ridge = |faces: &str| -> Vec<Vec3> {
        let scene = roof(faces);
        let meshes = scene.meshes.iter();
        meshes
            .flat_map(|mesh| mesh.positions.iter().zip(&mesh.normals))
            .filter(|(position, _)| position.x == 0.0)
            .map(|(_, normal)| *normal)
            .collect()
    };
    let is_smooth = |faces: &str| {
        let normals = normals_at_ridge(faces);
        if normals
            .iter()
            .all(|normal| normal.abs_diff_eq(Vec3::Z, 1e-6))
        {
            return true;
        }
        let is_flat =
            |normal: &Vec3| normal.abs_diff_eq(left, 1e-6) || normal.abs_diff_eq(right, 1e-6);
        assert!(normals.iter().all(is_flat), "{normals:?}");
        false
    };
    for smooth in [
        "s 1\nf 1 2 3 4\nf 2 5 6 3",
        "s on\nf 1 2 3 4\nf 2 5 6 3",
        "s 7\nf 1 2 3 4\ng other\nf 2 5 6 3",
        "s 7\nusemtl a\nf 1 2 3 4\nusemtl b\nf 2 5 6 3",
        "s 1\nf 1 2 3 4\ns 2\ns 1\nf 2 5 6 3",
        // However the slopes are cut.
        "s 1\nf 1 2 3\nf 1 3 4\nf 2 5 6\nf 2 6 3",
        "s 1\nf 1 2 3\nf 1 3 4\nf 2 5 6 3",
    ] {
        assert!(is_smooth(smooth), "{smooth}");
    }
    for flat in [
        "f 1 2 3 4\nf 2 5 6 3",
        "s off\nf 1 2 3 4\nf 2 5 6 3",
        "s 1\ns 0\nf 1 2 3 4\nf 2 5 6 3",
        "s 1\nf 1 2 3 4\ns 2\nf 2 5 6 3",
    ] {
        assert!(!is_smooth(flat), "{flat}");
    }
    // Normals that are given win.
    let scene = roof("vn 0 1 0\ns 1\nf 1//1 2//1 3//1 4//1\nf 2 5 6 3");
    assert_eq!(scene.meshes[0].normals[..4], [Vec3::Y; 4]);
    assert!(
        scene.meshes[0].normals[4].abs_diff_eq(right, 1e-6),
        "the other face has normals of its own"
    );
}

/// Surveys are millions of metres from the origin, and have details of millimetres.
#[test]
fn models_far_from_the_origin_keep_their_details() {
    let scene = geometry(
        "v 4543210.001 5432100.002 0\nv 4543210.002 5432100.002 0\nv 4543210.001 5432100.003 0\nf 1 2 3\n",
    );
    let mesh = &scene.meshes[0];
    let [a, b, c] = [0, 1, 2].map(|corner| mesh.positions[corner]);
    assert!(((b - a).length() - 0.001).abs() < 1e-6 && ((c - a).length() - 0.001).abs() < 1e-6);
    assert_eq!(scene.origin.to_array(), [4_543_210.0, 5_432_100.0, 0.0]);
    assert_eq!(scene.instances[0].transform, glam::Affine3A::IDENTITY);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

/// A helper at the origin, or vertices that nothing uses, do not cost what lies far away its details.
#[test]
fn few_vertices_near_the_origin_change_nothing_for_those_far_away() {
    let survey = "v 4543210.001 5432100.002 0\nv 4543210.002 5432100.002 0\nv 4543210.001 5432100.003 0\nv 4543210.002 5432100.003 0\n";
    for (before, after, first) in [
        ("v 0 0 0\n", "f 2 3 4\n", 0),
        (
            "",
            "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\n",
            0,
        ),
        ("", "v 0 0 0\nf 1 2 3\nf 2 3 4\nf 1 2 5\n", 0),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\ng helper\nf 1 2 3\ng model\n",
            "f 4 5 6\nf 5 6 7\n",
            1,
        ),
    ] {
        let scene = geometry(&format!("{before}{survey}{after}"));
        let [a, b, c] = [0, 1, 2].map(|corner| scene.meshes[first].positions[corner]);
        assert!(
            ((b - a).length() - 0.001).abs() < 1e-6 && ((c - a).length() - 0.001).abs() < 1e-6,
            "{before}{after}: {a} {b} {c}"
        );
    }
}

/// One place only can have its details.
#[test]
fn details_that_are_lost_are_said() {
    let near = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\no far\n";
    for (corners, is_lost) in [
        (
            "v 4543210 5432100 0\nv 4543211 5432100 0\nv 4543210 5432101 0\n",
            true,
        ),
        (
            "v 4543210 5432100 0\nv 4553210 5432100 0\nv 4543210 5442100 0\n",
            false,
        ),
        ("v 100 100 0\nv 101 100 0\nv 100 101 0\n", false),
        ("v 0 0 0\nv 4543210 5432100 0\nv 4543211 5432100 0\n", false),
    ] {
        let scene = geometry(&format!("{near}{corners}f 5 6 7\n"));
        let message = "1 objects are so small and so far from most others";
        assert_eq!(
            warns(&scene, "\"far\"", message),
            is_lost,
            "{corners}: {:?}",
            scene.warnings
        );
    }
}

#[test]
fn statements_come_in_any_order_and_case() {
    let mesh =
        faultless("g first\nF 1/1 2/2 3/3\nvt 0 0\nV 0 0 0\nv 1 0 0\nVT 1 0\nvt 0 1\nv 0 1 0\n");
    assert_eq!(mesh.positions, [Vec3::ZERO, Vec3::X, Vec3::Y]);
    assert_eq!(mesh.name, "first");
    assert_eq!(
        faultless("v 0 0 0\nv 1 0 0\nv 0 1 0\nfo 1 2 3\n")
            .triangles
            .len(),
        1
    );
}

/// Where a crate for the format reads a file, it reads the same.
#[test]
fn well_formed_files_are_read_as_by_another_reader() {
    let Some(scenes) = common::scenes() else {
        return;
    };
    for file in [
        "bench/suzanne.obj",
        "bench/teapot.obj",
        "bench/legocar.obj",
        "bench/dragon-decimated.obj",
    ] {
        let path = scenes.join(file);
        let ours = import(&path, &ImportOptions::default()).unwrap();
        let options = tobj::LoadOptions {
            ignore_points: true,
            ignore_lines: true,
            ..tobj::GPU_LOAD_OPTIONS
        };
        let (models, materials) = tobj::load_obj(&path, &options).unwrap();
        let names = materials.unwrap_or_default();
        let models: Vec<_> = models
            .iter()
            .filter(|model| !model.mesh.indices.is_empty())
            .collect();
        assert_eq!(ours.meshes.len(), models.len(), "{file}");
        for (ours, theirs) in ours.meshes.iter().zip(models) {
            assert_eq!(ours.name, theirs.name);
            let corner = |index: usize| Vec3::from_slice(&theirs.mesh.positions[3 * index..]);
            let expected: Vec<Vec3> = theirs
                .mesh
                .indices
                .iter()
                .map(|&index| corner(index as usize))
                .collect();
            let corners = ours.triangles.iter().flatten();
            let found: Vec<Vec3> = corners
                .map(|&index| ours.positions[index as usize])
                .collect();
            assert!(found == expected, "{file}: {}", ours.name);
        }
        let used = ours
            .materials
            .iter()
            .filter(|material| material.name != "default");
        assert!(
            used.into_iter()
                .all(|material| names.iter().any(|known| known.name == material.name))
        );
    }
}
