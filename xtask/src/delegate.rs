//! Commands that are programs of their own: what only they need is not built for the others.

use std::ffi::OsString;
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, ensure};
use residual_driver::{cargo, workspace};

use crate::args::PassedOn;

/// Has cargo build the program of a package of the workspace, which has the package's name, runs it with the arguments, and
/// gives its exit status.
///
/// # Errors
/// If cargo cannot build the program, or the program cannot be started.
pub(crate) fn to_package(package: &str, passed_on: &PassedOn) -> Result<ExitCode> {
    run(package, &passed_on.args)
}

/// As [`to_package`], with all arguments of this program.
///
/// # Errors
/// As there.
#[cfg(not(feature = "wgpu"))]
pub(crate) fn all_to_package(package: &str) -> Result<ExitCode> {
    let args: Vec<_> = std::env::args_os().skip(1).collect();
    run(package, &args)
}

fn run(package: &str, args: &[OsString]) -> Result<ExitCode> {
    let target = workspace::target_directory();
    // Built in the workspace, for its settings, and run where we are, for the paths among the arguments: `cargo run` would
    // do both in one place.
    let built = cargo::command()
        .args(["build", "--release", "--quiet", "--package", package])
        .arg("--target-dir")
        .arg(&target)
        .status()
        .context("running cargo")?;
    ensure!(built.success(), "{package} could not be built");
    let program = format!("{package}{}", std::env::consts::EXE_SUFFIX);
    let program = target.join("release").join(program);
    let status = Command::new(&program)
        .args(args)
        .status()
        .with_context(|| format!("running {}", program.display()))?;
    // A program that was killed has no status.
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
