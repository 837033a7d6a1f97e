//! glTF files that break the specification's rules, as exporters write them, and what is rendered of them all the same.

use std::path::Path;

use crate::common::gltf_text::{F32, Gltf, f32_bytes, warns};
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::{ImportError, ImportOptions, import};
use serde_json::json;

/// A triangle whose buffer is in the JSON.
fn triangle() -> Gltf {
    let mut gltf = Gltf::new();
    let positions = f32_bytes(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    gltf.attribute("POSITION", "VEC3", F32, &positions, 3);
    let data = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
    let uri = format!("data:application/octet-stream;base64,{data}");
    gltf.json["buffers"] = json!([{ "uri": uri, "byteLength": 36 }]);
    gltf
}

fn import_bytes(bytes: &[u8]) -> Result<SceneDesc, ImportError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.gltf");
    std::fs::write(&path, bytes).unwrap();
    import(Path::new(&path), &ImportOptions::default())
}

fn refused(bytes: &[u8], texts: &[&str]) {
    let message = import_bytes(bytes).unwrap_err().to_string();
    for text in texts {
        assert!(message.contains(text), "{message:?} does not say {text:?}");
    }
}

/// Imports text that has this instead of that, and expects the triangle.
fn with(old: &str, new: &str) -> SceneDesc {
    let json = triangle().json.to_string();
    assert!(json.contains(old), "{json} has no {old}");
    let scene = import_bytes(json.replacen(old, new, 1).as_bytes());
    let scene = scene.unwrap_or_else(|error| panic!("{new}: {error}"));
    assert_eq!(scene.meshes.len(), 1, "{new}: {:?}", scene.warnings);
    assert_eq!(scene.meshes[0].triangles.len(), 1, "{new}");
    scene
}

#[test]
fn text_is_read_in_any_encoding() {
    let json = triangle().json.to_string();
    let utf16: Vec<u8> = json.encode_utf16().flat_map(u16::to_le_bytes).collect();
    let files: [(Vec<u8>, &str); 4] = [
        (utf16.clone(), "UTF-16"),
        ([&[0xff, 0xfe], &utf16[..]].concat(), "UTF-16"),
        (format!("{json}\0\0").into(), ""),
        (
            json.replace("\"m\"", "\"m\u{1}\"")
                .replace('\u{1}', "ü")
                .into(),
            "",
        ),
    ];
    for (bytes, warning) in files {
        let scene = import_bytes(&bytes).unwrap();
        assert_eq!(scene.meshes.len(), 1);
        assert_eq!(
            scene.warnings.iter().any(|w| w.place == "JSON"),
            !warning.is_empty()
        );
        assert!(warning.is_empty() || warns(&scene, "JSON", warning));
    }
    let mut legacy = json.into_bytes();
    let name = legacy
        .windows(3)
        .position(|bytes| bytes == b"\"m\"")
        .unwrap();
    legacy[name + 1] = 0xfc;
    let scene = import_bytes(&legacy).unwrap();
    assert_eq!(scene.meshes[0].name, "ü");
    assert!(warns(&scene, "JSON", "Windows-1252"));
}

#[test]
fn numbers_in_other_notation_are_read() {
    for (old, new) in [
        (r#""version":"2.0""#, r#""version":2.0"#),
        (r#""version":"2.0""#, r#""version":2"#),
        (r#""count":3"#, r#""count":3.0"#),
        (r#""byteLength":36"#, r#""byteLength":36.0"#),
        (r#""mesh":0"#, r#""mesh":0,"camera":-1,"skin":null"#),
        (r#""attributes""#, r#""material":-1,"attributes""#),
        (r#""count":3"#, r#""count":3,"min":[NaN,0,-Infinity]"#),
        (r#"{"mesh":0}"#, r#"{"mesh":0,}"#),
        (r#""nodes":[0]"#, r#""nodes":[0,]"#),
    ] {
        let scene = with(old, new);
        assert!(
            scene.warnings.iter().any(|warning| warning.place == "JSON"),
            "{new}"
        );
    }
    // A stride of zero is none.
    with(r#""byteOffset":0"#, r#""byteOffset":0,"byteStride":0"#);
}

#[test]
fn what_cannot_be_found_costs_itself_alone() {
    for (old, new, place) in [
        (r#""scene":0"#, r#""scene":7"#, "scene"),
        (r#""mesh":0"#, r#""mesh":0,"camera":3"#, "nodes/0"),
        (r#""mesh":0"#, r#""mesh":0,"skin":3"#, "nodes/0"),
        (
            r#""mesh":0"#,
            r#""mesh":0,"extensions":{"KHR_lights_punctual":{"light":1}}"#,
            "nodes/0",
        ),
        (
            r#""attributes":{"#,
            r#""material":5,"attributes":{"#,
            "primitives/0",
        ),
        (r#""POSITION":0"#, r#""POSITION":0,"TANGENT":8"#, "TANGENT"),
        (r#""POSITION":0"#, r#""POSITION":0,"COLOR_0":8"#, "COLOR_0"),
        (
            r#""attributes":{"#,
            r#""material":0,"attributes":{"#,
            "materials/0",
        ),
    ] {
        let json = triangle().json.to_string().replacen(old, new, 1);
        let material =
            r#"{"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":2}}}],"#;
        let scene = import_bytes(json.replacen('{', material, 1).as_bytes());
        let scene = scene.unwrap_or_else(|error| panic!("{new}: {error}"));
        assert_eq!(scene.meshes.len(), 1, "{new}");
        assert!(
            warns(&scene, place, "refers to"),
            "{new}: {:?}",
            scene.warnings
        );
    }
    let mut gltf = triangle();
    gltf.json["textures"] = json!([{ "source": 4 }]);
    gltf.json["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    gltf.primitive()["material"] = json!(0);
    let scene = import_bytes(gltf.json.to_string().as_bytes()).unwrap();
    assert!(warns(&scene, "textures/0", "refers to images/4"));
    assert!(scene.textures.is_empty());

    gltf.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 6 }]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1]);
    let scene = import_bytes(gltf.json.to_string().as_bytes()).unwrap();
    assert_eq!(scene.instances.len(), 1);
    assert!(warns(&scene, "nodes/1", "refers to meshes/6"));
}

#[test]
fn a_child_that_is_named_twice_is_shown_once() {
    let mut gltf = triangle();
    gltf.json["nodes"] = json!([{ "children": [1, 2, 1] }, { "mesh": 0 }, { "mesh": 0 }]);
    let scene = import_bytes(gltf.json.to_string().as_bytes()).unwrap();
    assert_eq!(scene.instances.len(), 2);
    assert!(warns(&scene, "nodes/0", "nodes/1 twice"));
}

#[test]
fn files_that_are_something_else_are_named() {
    refused(b"", &["scene.gltf", "empty"]);
    refused(b"PK\x03\x04....", &["archive", "unpack"]);
    refused(
        b"version https://git-lfs.github.com/spec/v1\noid sha256:0\n",
        &["Git LFS", "git lfs pull"],
    );
    refused(b"<!DOCTYPE html>\n<html></html>", &["web page", "Raw"]);
    refused(
        br#"{"asset":{"version":"1.0"},"meshes":{}}"#,
        &["glTF 1.0", "gltf-pipeline"],
    );
    // The error says where, though reading went on after it.
    refused(
        b"{\"asset\": {\"version\": \"2.0\"},\n \"scene\": x}",
        &["line 2"],
    );
    refused(
        br#"{"asset":{"version":"2.0"},"nodes":[{"mesh":"a"}]}"#,
        &["line 1"],
    );
}

#[test]
fn data_with_escapes_is_read() {
    let mut gltf = triangle();
    let uri = gltf.json["buffers"][0]["uri"].as_str().unwrap();
    let escaped = uri.replace("gD8", "gD%38");
    gltf.json["buffers"][0]["uri"] = json!(format!("{escaped}%3D%3D"));
    let scene = import_bytes(gltf.json.to_string().as_bytes()).unwrap();
    assert_eq!(scene.meshes[0].triangles.len(), 1);
}
