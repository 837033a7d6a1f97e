//! Ray queries in programs that are compiled for any x86-64, and choose their instruction set when they run.
//!
//! A function that is not inlined into a kernel is compiled for the program's instruction set, and cannot have the kernel's inlined into it:
//! each of its operations on lanes becomes a call. Such operations are functions in the program, then, which they are not otherwise.
#![cfg(all(target_os = "linux", target_arch = "x86_64"))]

use std::fs;

use object::{Object as _, ObjectSymbol as _};
use residual_driver::cargo;
use residual_driver::workspace::target_directory;

/// `cargo test --release --test any_machine -- --ignored`
#[test]
#[ignore = "compiles ray queries for all instruction sets, two minutes of two cores"]
fn every_operation_on_lanes_is_inlined() {
    let folder = target_directory().join("any-machine");
    let status = cargo::command()
        .env("RUSTFLAGS", "-C target-cpu=x86-64")
        .args(["build", "--release", "--package", "residual-bvh"])
        .args(["--example", "trace", "--target-dir"])
        .arg(&folder)
        .status()
        .unwrap();
    assert!(status.success());
    let program = fs::read(folder.join("release/examples/trace")).unwrap();
    let program = object::File::parse(&program[..]).unwrap();
    let names = program.symbols().filter_map(|symbol| symbol.name().ok());
    let names: Vec<_> = names.collect();
    let is_operation = |name: &&&str| name.contains("__fearless_simd_kernel");
    let apart: Vec<_> = names.iter().filter(is_operation).collect();
    assert!(
        apart.is_empty(),
        "{} functions, such as {}",
        apart.len(),
        apart[0]
    );
    assert!(names.iter().any(|name| name.contains("residual_bvh")));
}
