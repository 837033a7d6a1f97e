//! Checks that other programs make. They write what is wrong themselves.

use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result};

use crate::problem::Problem;
use crate::workspace::cargo;

/// Packages whose build scripts import a scene. Before it could look at their few lines, cargo would compile the generator and all that
/// it stands on once more: as dependencies of scripts alone, they have other features than as parts of programs.
const BUILT_BY_THE_GENERATOR: [&str; 2] = ["residual-example-embed", "residual-example-embed-wgpu"];

pub(crate) fn format(root: &Path) -> Result<Vec<Problem>> {
    let mut command = cargo(root);
    command.args(["fmt", "--all", "--check"]);
    run(command, "files are not formatted", "cargo fmt --all")
}

pub(crate) fn lints(root: &Path) -> Result<Vec<Problem>> {
    let mut command = cargo_of_workspace(root, "clippy");
    command.args(["--all-targets", "--", "-D", "warnings"]);
    run(command, "there are warnings", "follow them")
}

pub(crate) fn documentation(root: &Path) -> Result<Vec<Problem>> {
    let mut command = cargo_of_workspace(root, "doc");
    command.arg("--no-deps").env("RUSTDOCFLAGS", "-D warnings");
    run(
        command,
        "there are warnings in documentation",
        "follow them",
    )
}

pub(crate) fn freshness(root: &Path) -> Result<Vec<Problem>> {
    let mut command = Command::new("python3");
    command
        .args(["scenes/generate.py", "--check"])
        .current_dir(root);
    run(
        command,
        "scenes are not those that their generator writes",
        "python3 scenes/generate.py",
    )
}

/// One of cargo's commands, for all packages but those.
fn cargo_of_workspace(root: &Path, name: &str) -> Command {
    let mut command = cargo(root);
    command
        .args([name, "--release", "--workspace", "--quiet"])
        .args(BUILT_BY_THE_GENERATOR.map(|package| format!("--exclude={package}")));
    command
}

fn run(mut command: Command, what: &str, remedy: &str) -> Result<Vec<Problem>> {
    let program = command.get_program().to_owned();
    let status = command
        .status()
        .with_context(|| format!("starting {}", program.display()))?;
    if status.success() {
        return Ok(Vec::new());
    }
    Ok(vec![Problem::new(None, what, remedy)])
}
