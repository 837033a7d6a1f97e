//! Tells the command line which compiler and instruction set it was built with: compiled scenes share its crates.

use std::env;
use std::process::Command;

fn main() {
    let rustc = env::var_os("RUSTC").expect("cargo sets it");
    let version = Command::new(rustc)
        .arg("-vV")
        .output()
        .expect("the compiler that is about to be used runs");
    let version = String::from_utf8_lossy(&version.stdout).replace('\n', "; ");
    println!("cargo::rustc-env=RESIDUAL_RUSTC={version}");
    let features = env::var("CARGO_CFG_TARGET_FEATURE").unwrap_or_default();
    println!("cargo::rustc-env=RESIDUAL_TARGET_FEATURES={features}");
    println!("cargo::rerun-if-changed=build.rs");
}
