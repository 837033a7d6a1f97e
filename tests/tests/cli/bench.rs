//! `bench` and `accuracy` hand over to programs of their own, which cargo builds first. Neither is run here: scripts take their places.

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::Path;
use std::process::{Command, Output};

use tempfile::TempDir;

use super::{fails, stderr};

fn script(path: &Path, text: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, format!("#!/bin/sh\n{text}\n")).unwrap();
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
}

/// Runs the command line in `folder/here` with a cargo that says what it is asked for and ends with this status, and with
/// benchmarks that say where they are and what they are asked for, and end with status 7.
fn bench(folder: &TempDir, cargo_status: u8, args: &[&str]) -> Output {
    handed_over(
        folder,
        cargo_status,
        "residual-benches",
        &[&["bench"], args].concat(),
    )
}

/// The same of any command whose program is of this package.
fn handed_over(folder: &TempDir, cargo_status: u8, package: &str, args: &[&str]) -> Output {
    let (folder, here) = (folder.path(), folder.path().join("here"));
    fs::create_dir_all(&here).unwrap();
    let cargo = format!("echo \"cargo $* in $PWD\"; exit {cargo_status}");
    script(&folder.join("cargo"), &cargo);
    let program = folder.join("target/release").join(package);
    script(&program, "printf '<%s> ' \"$@\"; pwd; exit 7");
    Command::new(env!("CARGO_BIN_EXE_residual-tests"))
        .current_dir(&here)
        .env("CARGO", folder.join("cargo"))
        .env("CARGO_TARGET_DIR", "../target")
        .args(args)
        .output()
        .unwrap()
}

#[test]
fn arguments_and_status_are_passed_on() {
    let folder = tempfile::tempdir().unwrap();
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let cases: [&[&str]; 4] = [
        &["traversal", "--scene", "a b.obj", "--quick"],
        &["traversal", "--help"],
        &["--help"],
        &["-h"],
    ];
    for args in cases {
        let output = bench(&folder, 0, args);
        assert_eq!(output.status.code(), Some(7), "{}", stderr(&output));
        let text = String::from_utf8(output.stdout).unwrap();
        let [cargo, program] = text.lines().collect::<Vec<_>>()[..] else {
            panic!("{text}")
        };
        assert!(cargo.contains("--release") && cargo.contains("--package residual-benches"));
        assert!(
            cargo.ends_with(&format!(" in {}", workspace.display())),
            "{cargo}"
        );
        let expected: String = args.iter().map(|arg| format!("<{arg}> ")).collect();
        assert!(
            program.starts_with(&expected) && program.ends_with("/here"),
            "{program}"
        );
    }
}

#[test]
fn nothing_is_measured_if_cargo_fails() {
    let folder = tempfile::tempdir().unwrap();
    let output = bench(&folder, 101, &["traversal"]);
    fails(&output, &["residual-benches could not be built"]);
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 1);
}

#[test]
fn accuracy_is_handed_over_too() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["accuracy", "a b.glb", "--quick", "-o", "out"];
    let output = handed_over(&folder, 0, "residual-study", &args);
    assert_eq!(output.status.code(), Some(7), "{}", stderr(&output));
    let text = String::from_utf8(output.stdout).unwrap();
    let [cargo, program] = text.lines().collect::<Vec<_>>()[..] else {
        panic!("{text}")
    };
    assert!(cargo.contains("--package residual-study"), "{cargo}");
    assert!(
        program.starts_with("<a b.glb> <--quick> <-o> <out> "),
        "{program}"
    );
}
