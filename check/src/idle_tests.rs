//! Tests that cargo would not run. Crates without tests say so in their manifests, since a crate is compiled once more to look for
//! them.

use std::path::Path;

use anyhow::Result;

use crate::problem::{Place, Problem};
use crate::sources;
use crate::workspace::{Package, Workspace};

/// Tests in packages of which cargo runs none.
///
/// # Errors
/// If a file cannot be read.
pub fn problems(workspace: &Workspace) -> Result<Vec<Problem>> {
    let mut problems = Vec::new();
    for package in &workspace.packages {
        for source in sources::of_package(&package.directory)? {
            if is_idle(package, &source.path) {
                problems.extend(in_file(workspace.relative(&source.path), &source.text));
            }
        }
    }
    Ok(problems)
}

/// Whether cargo runs no tests of a file: it is the first of a crate that is not tested, or lies in no folder of one that is.
fn is_idle(package: &Package, file: &Path) -> bool {
    let first = package.targets.iter().find(|target| target.source == file);
    match first {
        Some(target) => !target.is_tested,
        None => {
            let mut tested = package.targets.iter().filter(|target| target.is_tested);
            !tested.any(|target| {
                target
                    .source
                    .parent()
                    .is_some_and(|at| file.starts_with(at))
            })
        }
    }
}

/// Tests of a file, in which there may be none.
fn in_file(file: &Path, text: &str) -> Vec<Problem> {
    let lines = text.lines().enumerate();
    let tests = lines.filter(|(_, line)| line.trim() == "#[test]");
    let problem = |(index, _)| {
        Problem::new(
            Some(Place::line(file, index + 1)),
            "a test that cargo does not run",
            "move it to the package's folder tests, or remove `test = false` from Cargo.toml",
        )
    };
    tests.map(problem).collect()
}
