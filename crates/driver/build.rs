//! Tells the driver what compiled scenes share with it, compiler and instruction set, and which crates of the workspace they
//! are compiled from.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    let rustc = output(Command::new(variable("RUSTC")).arg("-vV"));
    println!(
        "cargo::rustc-env=RESIDUAL_RUSTC={}",
        rustc.replace('\n', "; ")
    );
    let features = env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default();
    println!("cargo::rustc-env=RESIDUAL_TARGET_FEATURES={features}");

    let package = PathBuf::from(variable("CARGO_MANIFEST_DIR"));
    let root = package.ancestors().nth(2).expect("it lies in crates/");
    let crates = crates_of_compiled_scenes(root);
    println!("cargo::rustc-env=RESIDUAL_CRATES={}", crates.join(";"));

    println!("cargo::rerun-if-changed=build.rs");
    let manifests = crates.iter().map(|folder| format!("{folder}/Cargo.toml"));
    for file in manifests.chain(["Cargo.toml", "Cargo.lock"].map(str::to_owned)) {
        println!("cargo::rerun-if-changed={}", root.join(file).display());
    }
}

/// The folders of the workspace's crates that `residual-compiled-scene` is built from, itself included, as cargo resolves
/// them.
fn crates_of_compiled_scenes(root: &Path) -> Vec<String> {
    let mut cargo = Command::new(variable("CARGO"));
    cargo.current_dir(root).args(["tree", "--offline"]);
    cargo.args(["--package", "residual-compiled-scene"]);
    cargo.args(["--edges", "normal,build", "--prefix", "none"]);
    // Crates of the workspace are followed by their path: `residual-bvh v0.1.0 (/path/to/crates/bvh)`.
    let inside = format!("({}{}", root.display(), std::path::MAIN_SEPARATOR);
    let mut crates: Vec<_> = output(&mut cargo)
        .lines()
        .filter_map(|line| line.split_once(&inside)?.1.split_once(')'))
        .map(|(folder, _)| folder.to_owned())
        .collect();
    crates.sort();
    crates.dedup();
    assert!(!crates.is_empty(), "cargo tree shows no crate of ours");
    crates
}

fn variable(name: &str) -> std::ffi::OsString {
    env::var_os(name).expect("cargo sets it")
}

/// What a command prints.
fn output(command: &mut Command) -> String {
    let output = command.output().expect("what builds this crate runs");
    assert!(
        output.status.success(),
        "{command:?}: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8_lossy(&output.stdout).into_owned()
}
