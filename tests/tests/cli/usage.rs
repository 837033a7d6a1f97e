//! Exit statuses and messages.

use std::fs;

use serde_json::json;

use super::{fails, good, render, run, stderr, workplace};

#[test]
fn bad_usage_ends_in_status_2() {
    let folder = workplace();
    let cases: &[&[&str]] = &[
        &[],
        &["paint"],
        &["render"],
        &["render", "triangle.obj", "--bogus"],
        &["render", "triangle.obj", "--spp", "0"],
        &["render", "triangle.obj", "--spp", "many"],
        &["render", "triangle.obj", "--size", "0x10"],
        &["render", "triangle.obj", "--size", "640"],
        &["render", "triangle.obj", "--fov", "180"],
        &["render", "triangle.obj", "--eye", "1,2"],
        &["render", "triangle.obj", "--dir", "nan,0,1"],
        &["render", "triangle.obj", "--dir", "0,0,0"],
        &["render", "triangle.obj", "--up", "0,-0,0"],
        &["render", "triangle.obj", "--threads", "100000"],
        &["render", "cameras.gltf", "--animation", "walk"],
        &["render", "cameras.gltf", "--fps", "30"],
        &["render", "cameras.gltf", "--frame", "1", "--time-code", "1"],
        &["render", "cameras.gltf", "--shutter", "0.5"],
        &["render", "cameras.gltf", "--frame", "1", "--shutter", "-1"],
        &["render", "cameras.gltf", "--frame", "1", "--shutter", "nan"],
        &[
            "render",
            "cameras.gltf",
            "--frame",
            "1",
            "--shutter-moments",
            "8",
        ],
        &[
            "render",
            "cameras.gltf",
            "--frame",
            "1",
            "--shutter",
            "0.5",
            "--shutter-moments",
            "12",
        ],
        &["render", "triangle.obj", "--time", "-3s"],
        &["render", "triangle.obj", "--lanes", "3"],
        &["render", "triangle.obj", "--max-depth", "0"],
        &["render", "triangle.obj", "--camera", "0", "--fov", "40"],
        &["render", "triangle.obj", "--focus", "2"],
        &["render", "triangle.obj", "--aperture", "f/0"],
        &[
            "render",
            "triangle.obj",
            "--aperture",
            "f/2",
            "--focus",
            "-1",
        ],
        &["render", "triangle.obj", "--aperture", "f/2", "--panorama"],
        &["render", "triangle.obj", "--panorama", "--fov", "40"],
        &["render", "triangle.obj", "--sun-angle", "181"],
        &["render", "triangle.obj", "--light-radius", "-1"],
        &["render", "triangle.obj", "--env-strength", "2"],
        &["render", "triangle.obj", "--tier", "fastest"],
        &["inspect"],
        &["emit", "triangle.obj"],
        &["compare"],
        &["compare", "a.exr"],
        &["compare", "a.exr", "b.exr", "--max-relmse", "-1"],
        &["compare", "a.exr", "b.exr", "--max-flip", "nan"],
        &["compare", "a.exr", "b.exr", "--crop", "0,0,0,4"],
    ];
    for args in cases {
        let output = run(&folder, args);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{args:?}: {}",
            stderr(&output)
        );
        assert!(!stderr(&output).is_empty(), "{args:?}");
    }
    assert!(!folder.path().join("triangle.png").exists());
}

#[test]
fn failed_jobs_end_in_status_1_and_say_why() {
    let folder = workplace();
    fails(
        &render(&folder, &["missing.glb"]),
        &["missing.glb", "exists"],
    );
    fs::write(folder.path().join("scene.fbx"), "x").unwrap();
    fails(
        &render(&folder, &["scene.fbx"]),
        &["scene.fbx", ".gltf, .glb or .obj"],
    );
    fs::write(folder.path().join("broken.gltf"), "{").unwrap();
    fails(&render(&folder, &["broken.gltf"]), &["broken.gltf"]);
    fails(
        &render(&folder, &["cameras.gltf", "--camera", "middle"]),
        &["cameras.gltf", "\"middle\"", "\"left\"", "\"right\""],
    );
    fails(
        &render(&folder, &["cameras.gltf", "--camera", "2"]),
        &["\"2\"", "\"left\""],
    );
    fails(
        &render(&folder, &["triangle.obj", "--camera", "0"]),
        &["no cameras"],
    );
    let lanes = ["triangle.obj", "--lanes", "4"];
    fails(&render(&folder, &lanes), &["--lanes", "leave it out"]);
    fails(
        &render(&folder, &["triangle.obj", "--env", "missing.hdr"]),
        &["missing.hdr"],
    );
    let sideways = ["triangle.obj", "--dir", "0,-2,0", "--up", "0,1,0"];
    fails(&render(&folder, &sideways), &["to be up", "give another"]);
    good(render(&folder, &sideways[..3]));
    fails(&run(&folder, &["inspect", "missing.glb"]), &["missing.glb"]);
    for camera in ["right", "1"] {
        good(render(&folder, &["cameras.gltf", "--camera", camera]));
    }
}

#[test]
fn quiet_is_quiet() {
    let folder = workplace();
    let output = good(render(&folder, &["cameras.gltf", "--quiet"]));
    assert!(output.stdout.is_empty());
    assert!(
        stderr(&output)
            .lines()
            .all(|line| line.starts_with("warning: ")),
        "{}",
        stderr(&output)
    );
}

#[test]
fn what_the_scene_lacks_is_said() {
    let folder = workplace();
    let message = stderr(&good(render(&folder, &["triangle.obj"])));
    assert!(
        message.contains("no camera") && message.contains("no light"),
        "{message}"
    );
    let strict = render(&folder, &["missing.glb", "--strict"]);
    fails(&strict, &["missing.glb"]);
    let view = stderr(&good(render(
        &folder,
        &["cameras.gltf", "--eye", "0,0,3", "--dir", "0,0,-1"],
    )));
    assert!(!view.contains("no camera"), "{view}");
}

/// `--strict` is about what the file says, not about what it lacks.
#[test]
fn strict_refuses_what_is_not_rendered_faithfully() {
    let folder = workplace();
    good(render(&folder, &["triangle.obj", "--strict"]));
    let glass = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["KHR_materials_transmission"],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "material": 0 }] }],
        "materials": [{
            "name": "lights",
            "pbrMetallicRoughness": { "metallicFactor": 0, "roughnessFactor": 0.5 },
            "extensions": { "ACME_glitter": {} },
        }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0] }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }],
        "scenes": [{ "nodes": [0] }],
        "scene": 0,
    });
    fs::write(folder.path().join("glass.gltf"), glass.to_string()).unwrap();
    let lenient = stderr(&good(render(&folder, &["glass.gltf"])));
    assert!(lenient.contains("ACME_glitter"), "{lenient}");
    fails(
        &render(&folder, &["glass.gltf", "--strict"]),
        &["glass.gltf", "--strict"],
    );
}
