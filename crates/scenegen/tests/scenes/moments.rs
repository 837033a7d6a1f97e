//! The poses of animated glTF files at the moments while a shutter is open.

use crate::common;
use crate::common::gltf_text::{F32, Gltf, f32_bytes, warns};
use glam::Vec3;
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::{ImportError, ImportOptions};
use serde_json::json;

fn open(gltf: &Gltf, moments: &[f64]) -> Result<SceneDesc, ImportError> {
    gltf.import_with(&ImportOptions {
        moments: moments.to_vec(),
        ..ImportOptions::default()
    })
}

/// Animates a property of a node, with a key at each second.
pub(crate) fn animate(gltf: &mut Gltf, node: usize, path: &str, how: &str, keys: &[[f32; 3]]) {
    let times: Vec<f32> = (0..keys.len()).map(|k| k as f32).collect();
    let input = gltf.accessor("SCALAR", F32, &f32_bytes(&times), times.len());
    let output = gltf.accessor("VEC3", F32, &f32_bytes(keys.as_flattened()), keys.len());
    gltf.json["animations"] = json!([{
        "samplers": [{ "input": input, "output": output, "interpolation": how }],
        "channels": [{ "sampler": 0, "target": { "node": node, "path": path } }],
    }]);
}

#[test]
fn each_moment_has_its_pose_and_all_share_the_mesh() {
    let mut gltf = Gltf::square();
    gltf.json["nodes"] = json!([{ "name": "moving", "mesh": 0 }, { "name": "still", "mesh": 0 }]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1]);
    animate(
        &mut gltf,
        0,
        "translation",
        "LINEAR",
        &[[0.0; 3], [8.0, 0.0, 0.0]],
    );
    let scene = open(&gltf, &[0.125, 0.25, 0.5, 1.5]).unwrap();
    assert_eq!(
        (scene.meshes.len(), scene.moments.as_slice()),
        (1, &[0, 1, 2, 3][..])
    );
    let places: Vec<f32> = scene
        .poses()
        .map(|pose| {
            assert_eq!(pose.instances[1].transform.translation.x, 0.0);
            pose.instances[0].transform.translation.x
        })
        .collect();
    assert_eq!(places, [1.0, 2.0, 4.0, 8.0]);
}

/// Without the shutter, and with it where nothing moves, a scene is the same.
#[test]
fn still_scenes_have_one_pose() {
    let mut gltf = Gltf::square();
    animate(
        &mut gltf,
        0,
        "translation",
        "LINEAR",
        &[[0.0; 3], [8.0, 0.0, 0.0]],
    );
    let scene = open(&gltf, &[2.0, 3.0, 4.0, 5.0]).unwrap();
    assert!(scene.later.is_empty() && scene.moments.is_empty());
    assert_eq!(scene.instances[0].transform.translation.x, 8.0);
    let reasons: Vec<_> = scene.dismissed.iter().map(|d| &d.reason).collect();
    assert!(
        reasons.iter().any(|reason| reason.contains("moves")),
        "{reasons:?}"
    );
    let bare = open(&Gltf::square(), &[0.0, 1.0]).unwrap();
    assert!(bare.later.is_empty() && warns(&bare, "animations", "none"));
}

/// What a moment leaves no extent stays in the list, and is a point then.
#[test]
fn what_vanishes_is_there_without_size() {
    let mut gltf = Gltf::square();
    gltf.json["nodes"][0]["translation"] = json!([1, 2, 3]);
    animate(&mut gltf, 0, "scale", "STEP", &[[0.0; 3], [2.0; 3]]);
    let scene = open(&gltf, &[0.5, 1.5]).unwrap();
    let [before, after] = [0, 1].map(|pose| &scene.pose(pose).instances[0]);
    // A scene that is a point at its first moment has its origin there.
    let origin = scene.origin.as_vec3();
    let corner = |transform: glam::Affine3A| origin + transform.transform_point3(Vec3::ONE);
    assert_eq!(corner(before.transform), Vec3::new(1.0, 2.0, 3.0));
    assert_eq!(corner(after.transform), Vec3::new(3.0, 4.0, 5.0));
    assert_eq!((before.mesh, &before.name), (after.mesh, &after.name));

    // What is never there is left out.
    animate(&mut gltf, 0, "scale", "STEP", &[[0.0; 3], [0.0; 3]]);
    assert!(open(&gltf, &[0.5, 1.5]).unwrap().instances.is_empty());
}

/// Two morph targets; the second is not finite, so that a triangle is there at one moment only.
#[test]
fn meshes_that_lose_triangles_are_refused() {
    let mut gltf = Gltf::square();
    gltf.indices(common::gltf_text::U8, &[0, 1, 2, 0, 2, 3], 6);
    let mut deltas = [[0.0_f32; 3]; 4];
    deltas[3] = [f32::NAN; 3];
    let target = gltf.accessor("VEC3", F32, &f32_bytes(deltas.as_flattened()), 4);
    gltf.primitive()["targets"] = json!([{ "POSITION": target }]);
    let input = gltf.accessor("SCALAR", F32, &f32_bytes(&[0.0, 1.0]), 2);
    let output = gltf.accessor("SCALAR", F32, &f32_bytes(&[0.0, 1.0]), 2);
    gltf.json["animations"] = json!([{
        "samplers": [{ "input": input, "output": output, "interpolation": "STEP" }],
        "channels": [{ "sampler": 0, "target": { "node": 0, "path": "weights" } }],
    }]);
    assert_eq!(open(&gltf, &[0.0, 0.5]).unwrap().moments.len(), 0);
    let message = open(&gltf, &[0.5, 1.5]).expect_err("an error").to_string();
    for text in ["mesh \"m\"", "close the shutter"] {
        assert!(message.contains(text), "{message}");
    }
}

/// Deformed meshes are kept once for as long as they stay the same.
#[test]
fn equal_deformations_share_a_mesh() {
    let mut gltf = Gltf::square();
    let target = gltf.accessor("VEC3", F32, &f32_bytes(&[1.0; 12]), 4);
    gltf.primitive()["targets"] = json!([{ "POSITION": target }]);
    gltf.json["nodes"][0]["weights"] = json!([0.5]);
    animate(&mut gltf, 0, "translation", "LINEAR", &[[0.0; 3], [1.0; 3]]);
    let scene = open(&gltf, &[0.1, 0.2, 0.3, 0.4]).unwrap();
    assert_eq!((scene.meshes.len(), scene.later.len()), (1, 3));
}
