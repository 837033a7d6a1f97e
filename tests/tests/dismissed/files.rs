//! What a file says in vain.

use std::fs;
use std::path::Path;

use residual_scenegen::desc::SceneDesc;
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::Binding;
use residual_tests::read_scene;
use serde_json::{Value, json};

use crate::sheets::planned;

/// A triangle of each of the materials, in a folder with `white.png`.
fn gltf(folder: &Path, materials: &[Value], more: &Value) -> std::path::PathBuf {
    let corners: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = corners.iter().flat_map(|c| c.to_le_bytes()).collect();
    fs::write(folder.join("corners.bin"), bytes).unwrap();
    image::RgbaImage::from_pixel(2, 2, image::Rgba([255; 4]))
        .save(folder.join("white.png"))
        .unwrap();
    let primitive = |material| json!({ "attributes": { "POSITION": 0 }, "material": material });
    let primitives: Vec<_> = (0..materials.len()).map(primitive).collect();
    let mut document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": primitives }],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]
        }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "uri": "corners.bin", "byteLength": 36 }],
        "materials": materials,
        "textures": [{ "source": 0 }],
        "images": [{ "uri": "white.png", "name": "white" }],
    });
    for (key, values) in more.as_object().unwrap() {
        match &mut document[key] {
            Value::Array(list) => list.extend(values.as_array().unwrap().iter().cloned()),
            absent => *absent = values.clone(),
        }
    }
    let file = folder.join("scene.gltf");
    fs::write(&file, document.to_string()).unwrap();
    file
}

/// What the scene of a file dismisses, places and reasons.
fn dismissed(scene: &SceneDesc) -> Vec<(String, String)> {
    let plan = planned(scene, Binding::Structure);
    let pair = |d: residual_scenegen::desc::Dismissed| (d.place, d.reason);
    plan.dismissed.into_iter().map(pair).collect()
}

fn assert_named(list: &[(String, String)], place: &str, reason: &str) {
    let is_it = |(p, r): &&(String, String)| p.contains(place) && r.contains(reason);
    assert_eq!(
        list.iter().filter(is_it).count(),
        1,
        "{place}: {reason}: {list:?}"
    );
}

/// Extensions do nothing where their factor is 0, be it by default.
#[test]
fn extensions_by_factor_0_are_dismissed_without_a_warning() {
    let switches = [
        (
            "KHR_materials_anisotropy",
            "anisotropyStrength",
            json!(0.0),
            json!(0.1),
        ),
        (
            "KHR_materials_clearcoat",
            "clearcoatFactor",
            json!(0),
            json!(1),
        ),
        (
            "KHR_materials_diffuse_roughness",
            "diffuseRoughnessFactor",
            json!(0.0),
            json!(0.7),
        ),
        (
            "KHR_materials_diffuse_transmission",
            "diffuseTransmissionFactor",
            json!(0.0),
            json!(0.5),
        ),
        (
            "KHR_materials_dispersion",
            "dispersion",
            json!(0.0),
            json!(0.3),
        ),
        (
            "KHR_materials_iridescence",
            "iridescenceFactor",
            json!(0.0),
            json!(1e-3),
        ),
        (
            "KHR_materials_sheen",
            "sheenColorFactor",
            json!([0, 0.0, 0]),
            json!([0, 0.1, 0]),
        ),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (extension, member, zero, other) in switches {
        let material = |name: &str, content: Value| json!({ "name": name, "extensions": { extension: content } });
        let materials = [
            material("zero", json!({ member: zero })),
            material("default", json!({})),
            material("other", json!({ member: other })),
        ];
        let file = gltf(
            folder.path(),
            &materials,
            &json!({ "extensionsUsed": [extension] }),
        );
        let scene = read_scene(&file, None).unwrap();
        let list = dismissed(&scene);
        for name in ["zero", "default"] {
            assert_named(
                &list,
                &format!("\"{name}\""),
                &format!("{extension} is there, and its factor is 0"),
            );
            let warned = scene.warnings.iter().any(|w| w.place.contains(name));
            assert!(!warned, "{:?}", scene.warnings);
        }
        assert!(
            !list.iter().any(|(place, _)| place.contains("other")),
            "{list:?}"
        );
        // Of a draft that is read, no more is said than that it is one.
        let is_about = |w: &residual_scenegen::desc::Warning| {
            w.message.contains(extension) && !w.message.contains("is a draft")
        };
        assert!(!scene.warnings.iter().any(is_about), "{:?}", scene.warnings);
    }
}

#[test]
fn what_a_gltf_file_does_not_use_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let strength = |strength: f32| json!({ "KHR_materials_emissive_strength": { "emissiveStrength": strength } });
    let materials = [
        json!({ "name": "dark", "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 0 }, "extensions": strength(0.0) }),
        json!({ "name": "plain" }),
    ];
    let more = json!({
        "materials": [{ "name": "spare" }],
        "meshes": [{ "name": "ghost", "primitives": [{ "attributes": { "POSITION": 0 }, "material": 2 }] }],
        "images": [{ "uri": "missing.png", "name": "unread" }],
    });
    let scene = read_scene(&gltf(folder.path(), &materials, &more), None).unwrap();
    let list = dismissed(&scene);
    assert_named(&list, "materials/0 \"dark\"", "emissiveStrength is 0");
    assert_named(
        &list,
        "materials/2 \"spare\"",
        "no mesh of the scene uses it",
    );
    assert_named(&list, "meshes/1 \"ghost\"", "no node of the scene shows it");
    for image in ["images/0 \"white\"", "images/1 \"unread\""] {
        assert_named(&list, image, "no material in use reads it");
    }
    // Both materials have the same triangle.
    assert_named(&list, "meshes", "lie exactly on others");
    assert_eq!(list.len(), 6, "{list:?}");
    let effects = Effects::of(&planned(&scene, Binding::Structure));
    assert_eq!(effects.dismissed(Effect::EmittingSurfaces).len(), 1);
    assert!(!effects.has(Effect::EmittingSurfaces) && !effects.has(Effect::Textures));
    assert!(
        scene.images.is_empty() && scene.warnings.is_empty(),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn what_an_obj_file_does_not_use_is_named() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("scene.mtl"),
        "newmtl used\nKd 0.5 0.5 0.5\nKe 0 0 0\nnewmtl spare\nKd 1 1 1\nmap_Kd missing.png\n",
    )
    .unwrap();
    let file = folder.path().join("scene.obj");
    fs::write(
        &file,
        "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl used\nf 1 2 3\n",
    )
    .unwrap();
    let scene = read_scene(&file, None).unwrap();
    let list = dismissed(&scene);
    assert_named(&list, "\"spare\"", "no face uses it");
    assert_eq!(list.len(), 1, "{list:?}");
    assert_eq!((scene.materials.len(), scene.images.len()), (1, 0));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}
