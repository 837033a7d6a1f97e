//! Every model of the shared scenes is imported, and its counts agree with an independent reading.

use std::path::{Path, PathBuf};

use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::{ImportOptions, import};
use serde_json::Value;

use crate::common;

fn models(folder: &Path) -> Vec<PathBuf> {
    common::files_under(folder)
        .into_iter()
        .filter(|path| matches!(common::extension(path).as_str(), "gltf" | "glb" | "obj"))
        .collect()
}

#[test]
fn all_good_models_are_imported() {
    let Some(scenes) = common::scenes() else {
        return;
    };
    for folder in ["materials", "interiors", "bench"] {
        for path in models(&scenes.join(folder)) {
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let started = std::time::Instant::now();
            let result = import(&path, &ImportOptions::default());
            let scene = result.unwrap_or_else(|error| panic!("{name}: {error}"));
            let milliseconds = started.elapsed().as_millis();
            println!("{name}: {milliseconds} ms, {}", summary(&scene));
            check_counts(&path, &scene);
        }
    }
}

fn summary(scene: &SceneDesc) -> String {
    let warnings: String = scene
        .warnings
        .iter()
        .map(|w| format!("\n    {}: {}", w.place, w.message))
        .collect();
    format!(
        "{} triangles, {} meshes, {} instances, {} materials, {} textures, {} images, {} lights, {} cameras{warnings}",
        scene
            .meshes
            .iter()
            .map(|mesh| mesh.triangles.len())
            .sum::<usize>(),
        scene.meshes.len(),
        scene.instances.len(),
        scene.materials.len(),
        scene.textures.len(),
        scene.images.len(),
        scene.lights.len(),
        scene.cameras.len(),
    )
}

/// Compares with counts taken from the JSON alone, for files whose meshes are all in the scene.
fn check_counts(path: &Path, scene: &SceneDesc) {
    let Some(json) = common::read_json(path) else {
        return;
    };
    let empty = Vec::new();
    let array = |name: &str| json[name].as_array().unwrap_or(&empty);
    let mut triangles = 0;
    let mut primitives = 0;
    let mut materials = std::collections::BTreeSet::new();
    for mesh in array("meshes") {
        for primitive in mesh["primitives"].as_array().unwrap() {
            let accessor = match &primitive["indices"] {
                Value::Null => &primitive["attributes"]["POSITION"],
                indices => indices,
            };
            let count = array("accessors")[accessor.as_u64().unwrap() as usize]["count"]
                .as_u64()
                .unwrap();
            triangles += match primitive["mode"].as_u64().unwrap_or(4) {
                4 => count / 3,
                5 | 6 => count - 2,
                _ => continue,
            };
            primitives += 1;
            materials.insert(primitive["material"].as_u64());
        }
    }
    let mut used = std::collections::BTreeSet::new();
    used.extend(
        array("nodes")
            .iter()
            .filter_map(|node| node["mesh"].as_u64()),
    );
    if used.len() != array("meshes").len() {
        println!(
            "skipped: the counts of {}, which has meshes outside the scene",
            path.display()
        );
        return;
    }
    let imported: usize = scene.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    assert_eq!(
        imported as u64,
        triangles,
        "triangles of {}",
        path.display()
    );
    assert_eq!(
        scene.meshes.len(),
        primitives,
        "meshes of {}",
        path.display()
    );
    assert_eq!(
        scene.materials.len(),
        materials.len(),
        "materials of {}",
        path.display()
    );
}

/// The Khronos model brings MikkTSpace tangents; those computed without them must agree.
#[test]
fn computed_tangents_agree_with_those_of_the_khronos_test_model() {
    let Some(scenes) = common::scenes() else {
        return;
    };
    let folder = scenes.join("materials/NormalTangentMirrorTest");
    let copy = tempfile::tempdir().unwrap();
    for path in common::files_under(&folder) {
        std::fs::copy(&path, copy.path().join(path.file_name().unwrap())).unwrap();
    }
    let mut json = common::read_json(&folder.join("NormalTangentMirrorTest.gltf")).unwrap();
    let given = import(
        &folder.join("NormalTangentMirrorTest.gltf"),
        &ImportOptions::default(),
    )
    .unwrap();
    json["meshes"][0]["primitives"][0]["attributes"]
        .as_object_mut()
        .unwrap()
        .remove("TANGENT")
        .unwrap();
    let path = copy.path().join("without.gltf");
    std::fs::write(&path, json.to_string()).unwrap();
    let computed = import(&path, &ImportOptions::default()).unwrap();

    let corners = |scene: &SceneDesc| -> Vec<glam::Vec4> {
        let mesh = &scene.meshes[0];
        let tangents = mesh.tangents.as_ref().unwrap();
        mesh.triangles
            .iter()
            .flatten()
            .map(|&corner| tangents[corner as usize])
            .collect()
    };
    let (given, computed) = (corners(&given), corners(&computed));
    let agree = given
        .iter()
        .zip(&computed)
        .filter(|(given, computed)| {
            given.w == computed.w && given.truncate().dot(computed.truncate()) > 0.99
        })
        .count();
    println!("{agree} of {} corners agree", given.len());
    assert!(
        agree * 100 >= given.len() * 98,
        "{agree} of {}",
        given.len()
    );
}
