//! `--shutter`.

use std::fs;

use serde_json::json;
use tempfile::TempDir;

use super::{fails, good, render, run, statistics, stderr, workplace};

/// A folder with `moving.gltf`: a triangle that moves to the right within a second.
pub(crate) fn moving() -> TempDir {
    let folder = workplace();
    let corners = [[-1.0_f32, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let keys = [[0.0_f32; 3], [1.0, 0.0, 0.0]];
    let numbers = [corners.as_flattened(), &[0.0, 1.0], keys.as_flattened()].concat();
    let bytes: Vec<u8> = numbers.iter().flat_map(|x| x.to_le_bytes()).collect();
    fs::write(folder.path().join("moving.bin"), &bytes).unwrap();
    let view = |start: usize, length: usize| json!({ "buffer": 0, "byteOffset": 4 * start, "byteLength": 4 * length });
    let accessor = |view: usize, kind: &str, count: usize| json!({ "bufferView": view, "componentType": 5126, "type": kind, "count": count });
    let scene = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "name": "wing", "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "animations": [{
            "samplers": [{ "input": 1, "output": 2 }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }],
        }],
        "buffers": [{ "uri": "moving.bin", "byteLength": bytes.len() }],
        "bufferViews": [view(0, 9), view(9, 2), view(11, 6)],
        "accessors": [accessor(0, "VEC3", 3), accessor(1, "SCALAR", 2), accessor(2, "VEC3", 2)],
    });
    fs::write(folder.path().join("moving.gltf"), scene.to_string()).unwrap();
    folder
}

#[test]
fn an_open_shutter_is_an_effect_with_its_callers() {
    let folder = moving();
    let inspect = |more: &[&str]| {
        let args = [&["inspect", "moving.gltf", "--json"], more].concat();
        let report = statistics(&good(run(&folder, &args)));
        report["effects"]["motion blur"].clone()
    };
    let row = inspect(&["--frame", "12", "--shutter", "180deg"]);
    assert_eq!(row["called_for_by"], json!(["node \"wing\""]));
    for closed in [&["--frame", "12"][..], &["--frame", "12", "--shutter", "0"]] {
        let row = inspect(closed);
        assert_eq!(
            (&row["in"], &row["changes_nothing"]),
            (&json!(false), &json!([]))
        );
    }
    let row = inspect(&["--time-code", "5", "--shutter", "0.1s"]);
    assert_eq!(
        (&row["in"], row["changes_nothing"].as_array().map(Vec::len)),
        (&json!(false), Some(1))
    );
}

#[test]
fn a_closed_shutter_changes_no_bit_and_an_open_one_does() {
    let folder = moving();
    let picture = |name: &str, more: &[&str]| {
        let args = [&["moving.gltf", "--frame", "12", "-o", name], more].concat();
        stderr(&good(render(&folder, &args)))
    };
    picture("plain.png", &[]);
    picture("closed.png", &["--shutter", "0"]);
    let message = picture(
        "open.png",
        &["--shutter", "24", "--adaptive", "--spp", "32"],
    );
    assert!(message.contains("16 moments"), "{message}");
    let same = |other: &str| {
        let args = ["compare", "plain.png", other, "--max-relmse", "0"];
        run(&folder, &args).status.code()
    };
    assert_eq!((same("closed.png"), same("open.png")), (Some(0), Some(1)));
}

#[test]
fn where_nothing_moves_it_is_said() {
    let folder = moving();
    let message = stderr(&good(render(
        &folder,
        &["moving.gltf", "--time-code", "5", "--shutter", "0.1s"],
    )));
    assert!(
        message.contains("--shutter: nothing that is seen moves"),
        "{message}"
    );
    assert!(!message.contains("motion blur"), "{message}");
    let message = stderr(&good(render(
        &folder,
        &["triangle.obj", "--frame", "1", "--shutter", "0.5"],
    )));
    for text in ["OBJ files have no animations", "nothing that is seen moves"] {
        assert!(message.contains(text), "{message}");
    }
}

#[test]
fn programs_have_one_pose() {
    let folder = moving();
    let args = [
        "build",
        "moving.gltf",
        "--frame",
        "12",
        "--shutter",
        "0.5",
        "-o",
        "program",
    ];
    fails(&run(&folder, &args), &["--shutter", "cargo xtask render"]);
}
