//! The command line as a process: exit statuses, messages, files, statistics.

#[cfg(unix)]
mod bench;
mod build;
mod cache;
mod compare;
mod emit;
mod gpu;
mod inspect;
#[cfg(target_os = "linux")]
mod interrupt;
mod looks;
mod motion;
mod outputs;
mod render;
mod tiers;
mod tracers;
mod usage;

use std::fs;
use std::process::{Command, Output};

use serde_json::{Value, json};
use tempfile::TempDir;

const TRIANGLE: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

/// A folder to work in, with `triangle.obj`, `cameras.gltf` (two cameras, no mesh) and `empty.gltf`.
fn workplace() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("triangle.obj"), TRIANGLE).unwrap();
    let lens = json!({ "type": "perspective", "perspective": { "yfov": 0.8, "znear": 0.1 } });
    let cameras = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1] }],
        "nodes": [{ "name": "left", "camera": 0 }, { "name": "right", "camera": 1 }],
        "cameras": [lens, lens],
    });
    fs::write(folder.path().join("cameras.gltf"), cameras.to_string()).unwrap();
    fs::write(
        folder.path().join("empty.gltf"),
        r#"{ "asset": { "version": "2.0" } }"#,
    )
    .unwrap();
    folder
}

/// Runs the command line in a folder.
fn run(folder: &TempDir, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_residual-tests"))
        .current_dir(folder)
        .args(args)
        .output()
        .unwrap()
}

/// Renders quickly: `--tier interpreted`, 16 × 12 pixels, 2 samples, unless `args` say otherwise.
fn render(folder: &TempDir, args: &[&str]) -> Output {
    let mut all = vec!["render", "--tier", "interpreted", "--threads", "1"];
    for (name, value) in [("--size", "16x12"), ("--spp", "2")] {
        let timed = name == "--spp" && args.contains(&"--time");
        if !timed && !args.contains(&name) {
            all.extend([name, value]);
        }
    }
    all.extend(args);
    run(folder, &all)
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Fails unless the command ended well.
fn good(output: Output) -> Output {
    assert!(
        output.status.success(),
        "{}: {}",
        output.status,
        stderr(&output)
    );
    output
}

/// Fails unless the command failed with status 1 and says all the texts.
fn fails(output: &Output, texts: &[&str]) {
    let message = stderr(output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(message.contains("error: "), "{message}");
    for text in texts {
        assert!(message.contains(text), "{message:?} does not say {text:?}");
    }
}

/// The last line of standard output as JSON.
fn statistics(output: &Output) -> Value {
    let text = String::from_utf8(output.stdout.clone()).unwrap();
    serde_json::from_str(text.lines().last().expect("a line")).expect("JSON")
}
