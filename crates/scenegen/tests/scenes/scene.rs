//! glTF lights, cameras and nodes, feature by feature.

use std::f32::consts::FRAC_PI_4;

use crate::common::gltf_text::{F32, Gltf, U8, f32_bytes, warns};
use glam::{Vec3, Vec3A};
use residual_scenegen::desc::{Projection, PunctualKind};
use serde_json::{Value, json};

#[test]
fn lights_stand_in_the_world() {
    let mut gltf = Gltf::square();
    gltf.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [
        { "type": "point", "color": [1, 0.5, 0], "intensity": 10 },
        { "type": "spot", "spot": { "innerConeAngle": 0.2, "outerConeAngle": 0.1 } },
        { "type": "directional", "intensity": -1 },
    ] } });
    let light = |i: usize| json!({ "KHR_lights_punctual": { "light": i } });
    gltf.json["nodes"] = json!([
        { "children": [1, 2, 3], "translation": [1, 2, 3], "scale": [2, 2, 2] },
        { "extensions": light(0), "translation": [1, 0, 0] },
        // Turned about +Y by 90°: −Z becomes −X.
        { "extensions": light(1), "rotation": [0, 0.707_106_77, 0, 0.707_106_77] },
        { "extensions": light(2), "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1] },
    ]);
    let scene = gltf.import().unwrap();
    assert_eq!(
        scene.lights[0].kind,
        PunctualKind::Point {
            position: Vec3::new(3., 2., 3.)
        }
    );
    assert_eq!(scene.lights[0].intensity, [10., 5., 0.]);
    let PunctualKind::Spot {
        position,
        direction,
        inner,
        outer,
    } = scene.lights[1].kind
    else {
        panic!("spot")
    };
    assert_eq!(position, Vec3::new(1., 2., 3.));
    assert!((direction + Vec3::X).length() < 1e-6);
    assert_eq!([inner, outer], [0.1, 0.1], "a hard edge");
    assert!(warns(&scene, "lights/1", "innerConeAngle"));
    assert_eq!(
        scene.lights[2].kind,
        PunctualKind::Directional { direction: Vec3::Z }
    );
    assert_eq!(scene.lights[2].intensity, [0.0; 3]);
    assert!(warns(&scene, "lights/2", "negative"));
}

#[test]
fn cameras_forget_scale_and_impossible_lenses() {
    let mut gltf = Gltf::square();
    gltf.json["cameras"] = json!([
        { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } },
        { "type": "orthographic", "orthographic": { "xmag": 1, "ymag": 2, "znear": 0, "zfar": 1 } },
        { "type": "perspective", "perspective": { "yfov": 4, "znear": 0.1, "aspectRatio": -1 } },
    ]);
    gltf.json["nodes"] = json!([
        { "camera": 0, "name": "eye", "translation": [0, 0, 5], "scale": [3, 1, 2] },
        { "camera": 1, "rotation": [0, 1, 0, 0] },
        { "camera": 2 },
        { "camera": 0, "scale": [0, 0, 0] },
    ]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.cameras.len(), 3);
    assert_eq!(
        (scene.cameras[0].name.as_str(), scene.cameras[0].position),
        ("eye", Vec3::new(0., 0., 5.))
    );
    assert_eq!(
        scene.cameras[0].projection,
        Projection::Perspective { yfov: 0.5 }
    );
    assert!((scene.cameras[0].rotation * Vec3::NEG_Z - Vec3::NEG_Z).length() < 1e-6);
    assert_eq!(
        scene.cameras[1].projection,
        Projection::Orthographic { ymag: 2.0 }
    );
    assert!((scene.cameras[1].rotation * Vec3::NEG_Z - Vec3::Z).length() < 1e-6);
    assert_eq!(
        scene.cameras[2].projection,
        Projection::Perspective { yfov: FRAC_PI_4 }
    );
    assert!(warns(&scene, "cameras/2", "yfov"));
    assert!(warns(&scene, "cameras/2", "aspectRatio -1"));
    let frames: Vec<_> = scene.cameras.iter().map(|eye| eye.frame_aspect).collect();
    assert_eq!(frames, [None, Some(0.5), None]);
    assert!(warns(&scene, "nodes/3", "orientation"));
}

#[test]
fn chains_of_a_thousand_nodes_compose_exactly_and_cycles_are_refused() {
    let mut gltf = Gltf::square();
    let mut nodes: Vec<Value> = (1..5000)
        .map(|child| json!({ "children": [child], "translation": [0.1, 0, 0] }))
        .collect();
    nodes.push(json!({ "mesh": 0 }));
    gltf.json["nodes"] = json!(nodes);
    let scene = gltf.import().unwrap();
    let expected = f64::from(0.1_f32) * 4999.0;
    let found = scene.origin + Vec3::from(scene.instances[0].transform.translation).as_dvec3();
    assert!(found.distance(glam::DVec3::new(expected, 0.0, 0.0)) < 1e-6);

    gltf.json["nodes"] = json!([{ "children": [1] }, { "children": [0], "name": "loop" }]);
    gltf.refused(&["nodes/0", "its own children"]);
}

#[test]
fn children_of_several_parents_are_shown_below_each() {
    let mut gltf = Gltf::square();
    gltf.json["nodes"] = json!([
        { "children": [1, 2] },
        { "children": [3], "translation": [1, 0, 0] },
        { "children": [3], "translation": [2, 0, 0] },
        { "mesh": 0, "name": "shared" },
    ]);
    // Roots that are named twice are one.
    gltf.json["scenes"][0]["nodes"] = json!([0, 0]);
    let scene = gltf.import().unwrap();
    let places: Vec<f32> = scene
        .instances
        .iter()
        .map(|instance| instance.transform.translation.x)
        .collect();
    assert_eq!(places, [1.0, 2.0]);
    assert_eq!(scene.meshes.len(), 1, "read once");
    assert!(warns(&scene, "nodes/3 \"shared\"", "several parents"));

    // Level by level, of two nodes each, they would be 2⁶⁴.
    let levels = (0..128).map(|k| json!({ "children": [k / 2 * 2 + 2, k / 2 * 2 + 3] }));
    let mut nodes: Vec<Value> = levels.collect();
    nodes.extend([json!({ "mesh": 0 }), json!({ "mesh": 0 })]);
    gltf.json["nodes"] = json!(nodes);
    gltf.refused(&["more than 1048576 nodes"]);
}

#[test]
fn hidden_nodes_hide_meshes_and_lights_below_them_but_no_cameras() {
    let mut gltf = Gltf::square();
    gltf.primitive()["mode"] = json!(5);
    gltf.json["extensionsRequired"] = json!(["KHR_node_visibility"]);
    gltf.json["cameras"] =
        json!([{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } }]);
    gltf.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
    let visible = |is: bool| json!({ "KHR_node_visibility": { "visible": is } });
    gltf.json["nodes"] = json!([
        { "children": [1, 2, 3], "extensions": visible(false) },
        { "mesh": 0, "extensions": visible(true), "name": "below" },
        { "camera": 0 },
        { "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "mesh": 0, "extensions": visible(true) },
        { "mesh": 0, "extensions": { "KHR_node_visibility": {} } },
    ]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 4, 5]);
    let scene = gltf.import().unwrap();
    let names: Vec<&str> = scene.instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["node 4", "node 5"]);
    assert_eq!((scene.lights.len(), scene.cameras.len()), (0, 1));
    let reasons = scene.dismissed.iter();
    assert!(
        reasons
            .clone()
            .any(|d| d.place.contains("below") && d.reason.contains("hides"))
    );
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn other_versions_are_told_apart() {
    let mut gltf = Gltf::square();
    gltf.json["asset"] = json!({ "version": "2.0", "minVersion": "2.1" });
    gltf.refused(&["asset/minVersion", "glTF 2.1"]);
    gltf.json["asset"] = json!({ "version": "2.7", "minVersion": "2.0" });
    assert!(gltf.import().is_ok());
    gltf.json["asset"] = json!({ "version": "3.0" });
    gltf.refused(&["asset/version", "\"3.0\" is not 2.0"]);
    // glTF 1.0, with and without a version.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("old.gltf");
    let files = [
        json!({ "asset": { "version": "1.0" }, "meshes": { "m": { "primitives": [] } }, "nodes": {} }),
        json!({ "asset": { "version": 1.0 }, "nodes": {} }),
        json!({ "buffers": { "b": { "uri": "b.bin" } }, "nodes": {}, "scene": "main" }),
        json!({ "asset": { "version": "1.1" } }),
    ];
    for file in files {
        std::fs::write(&path, file.to_string()).unwrap();
        let options = residual_scenegen::import::ImportOptions::default();
        let message = residual_scenegen::import::import(&path, &options)
            .unwrap_err()
            .to_string();
        let is_told = message.contains("glTF 1.0") || message.contains("\"1.1\" is not 2.0");
        assert!(is_told, "{file}: {message}");
    }
    std::fs::write(&path, b"glTF\x01\0\0\0\x20\0\0\0").unwrap();
    let options = residual_scenegen::import::ImportOptions::default();
    let message = residual_scenegen::import::import(&path, &options).unwrap_err();
    assert!(
        message.to_string().contains("version 1, not 2"),
        "{message}"
    );
}

#[test]
fn files_of_several_scenes_without_a_default_say_which_is_shown() {
    let mut gltf = Gltf::square();
    gltf.json.as_object_mut().unwrap().remove("scene");
    gltf.json["scenes"] = json!([{ "nodes": [0] }, { "nodes": [] }]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.instances.len(), 1);
    assert!(warns(&scene, "scene", "the first is shown"));
}

#[test]
fn mirrored_transforms_stay_and_collapsed_ones_go() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf.json["nodes"] = json!([
        { "mesh": 0, "scale": [-1, 1, 1] },
        { "mesh": 0, "scale": [1, 1, 0] },
        { "mesh": 0, "scale": [1, 0, 1] },
        { "mesh": 0, "scale": [1e38, 1e38, 1e38], "children": [4] },
        { "mesh": 0, "scale": [1e38, 1e38, 1e38] },
    ]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.instances.len(), 3, "{:?}", scene.warnings);
    assert!(scene.instances[0].transform.matrix3.determinant() < 0.0);
    assert!(warns(&scene, "nodes/1", "flat"));
    assert!(warns(&scene, "nodes/2", "no area"));
    assert!(warns(&scene, "nodes/4", "not finite"));
}

#[test]
fn gpu_instances_are_placed_one_by_one() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    let translations = gltf.accessor("VEC3", F32, &f32_bytes(&[1., 0., 0., 0., 2., 0.]), 2);
    let scales = gltf.accessor("VEC3", F32, &f32_bytes(&[1., 1., 1., 3., 3., 3.]), 2);
    gltf.json["nodes"] = json!([{ "mesh": 0, "translation": [10, 0, 0], "extensions": {
        "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations, "SCALE": scales } },
    } }]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.instances.len(), 2);
    assert_eq!(
        scene.instances[0].transform.translation,
        Vec3A::new(11., 0., 0.)
    );
    assert_eq!(
        scene.instances[1].transform.transform_point3(Vec3::ONE),
        Vec3::new(13., 5., 3.)
    );
}

#[test]
fn without_a_scene_all_roots_are_shown() {
    let mut gltf = Gltf::square();
    gltf.json["nodes"] = json!([{ "mesh": 0, "children": [2] }, { "mesh": 0 }, { "mesh": 0 }]);
    gltf.json
        .as_object_mut()
        .unwrap()
        .retain(|key, _| !key.starts_with("scene"));
    assert_eq!(gltf.import().unwrap().instances.len(), 3);
}

#[test]
fn products_of_primitives_and_nodes_are_bounded() {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    let primitive = gltf.primitive().clone();
    gltf.json["meshes"][0]["primitives"] = json!(vec![primitive; 4000]);
    gltf.json["nodes"] = json!(vec![json!({ "mesh": 0 }); 4000]);
    gltf.json["scenes"][0]["nodes"] = json!((0..4000).collect::<Vec<_>>());
    gltf.refused(&["nodes/", "1 GiB"]);
}

#[test]
fn floods_of_warnings_are_cut() {
    let mut gltf = Gltf::square();
    let node = json!({ "extensions": { "ACME_x": {} } });
    gltf.json["nodes"] = json!(vec![node; 5000]);
    gltf.json["scenes"][0]["nodes"] = json!((0..5000).collect::<Vec<_>>());
    let scene = gltf.import().unwrap();
    assert_eq!(scene.warnings.len(), 1001);
    assert!(warns(&scene, "warnings", "more warnings"));
}

/// What is near one another in a survey stays so, however the file writes where it is.
#[test]
fn scenes_far_away_are_relative_to_a_place_among_them() {
    let place = [431_200.503, 120.25, -4_649_776.127_f64];
    let beside = |x: f64, y: f64, z: f64| [place[0] + x, place[1] + y, place[2] + z];
    let light = json!({ "KHR_lights_punctual": { "light": 0 } });
    let matrix = |t: [f64; 3]| json!([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, t[0], t[1], t[2], 1]);
    let layouts = [
        // All below one node.
        json!([
            { "children": [1, 2, 3, 4], "translation": place },
            { "mesh": 0 },
            { "mesh": 0, "translation": [0.01, 0, 0] },
            { "camera": 0, "translation": [0, 0, 0.75] },
            { "extensions": light, "translation": [0, 2.5, 0] },
        ]),
        // Each by itself.
        json!([
            { "children": [1, 2, 3, 4] },
            { "mesh": 0, "translation": place },
            { "mesh": 0, "matrix": matrix(beside(0.01, 0.0, 0.0)) },
            { "camera": 0, "translation": beside(0.0, 0.0, 0.75) },
            { "extensions": light, "matrix": matrix(beside(0.0, 2.5, 0.0)) },
        ]),
    ];
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf.json["cameras"] = json!([{ "type": "perspective",
        "perspective": { "yfov": 0.5, "znear": 0.1 } }]);
    gltf.json["extensions"] = json!({ "KHR_lights_punctual": { "lights": [{ "type": "point" }] } });
    for nodes in layouts {
        gltf.json["nodes"] = nodes;
        let scene = gltf.import().unwrap();
        let near = |found: Vec3, offset: [f64; 3]| {
            let found = scene.origin + found.as_dvec3();
            let expected = glam::DVec3::from(beside(offset[0], offset[1], offset[2]));
            // The parent's translation is read in 64 bits as well.
            assert!(found.distance(expected) < 1e-6, "{found} {expected}");
        };
        assert!(scene.origin.distance(glam::DVec3::from(place)) < 2.0);
        near(scene.instances[0].transform.translation.into(), [0.0; 3]);
        near(
            scene.instances[1].transform.translation.into(),
            [0.01, 0.0, 0.0],
        );
        near(scene.cameras[0].position, [0.0, 0.0, 0.75]);
        let PunctualKind::Point { position } = scene.lights[0].kind else {
            panic!("point")
        };
        near(position, [0.0, 2.5, 0.0]);
    }
    // A helper at the origin of the world is no reason to lose what lies far away.
    gltf.json["nodes"] = json!([
        { "children": [1, 2, 3] },
        { "mesh": 0 },
        { "mesh": 0, "translation": place },
        { "mesh": 0, "translation": beside(0.01, 0.0, 0.0) },
    ]);
    let scene = gltf.import().unwrap();
    let [_, first, second] = &scene.instances[..] else {
        panic!("three")
    };
    let between = Vec3::from(second.transform.translation - first.transform.translation);
    assert!(between.distance(Vec3::new(0.01, 0.0, 0.0)) < 1e-6);
    // Near scenes stay where they are, to the bit.
    gltf.json["nodes"] = json!([{ "mesh": 0, "translation": [20, 0.1, 0] }]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.origin, glam::DVec3::ZERO);
    assert_eq!(
        scene.instances[0].transform.translation,
        Vec3A::new(20.0, 0.1, 0.0)
    );
}
