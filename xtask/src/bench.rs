//! `cargo xtask bench`: cargo builds the benchmarks, which nothing else needs, and they get the arguments.

use std::process::{Command, ExitCode};

use anyhow::{Context, Result, ensure};
use residual_driver::{cargo, workspace};

use crate::args::BenchArgs;

pub(crate) fn run(args: &BenchArgs) -> Result<ExitCode> {
    let target = workspace::target_directory();
    // Built in the workspace, for its settings, and run where we are, for the paths among the arguments: `cargo run` would
    // do both in one place.
    let built = cargo::command()
        .args(["build", "--release", "--quiet"])
        .args(["--package", "residual-benches", "--target-dir"])
        .arg(&target)
        .status()
        .context("running cargo")?;
    ensure!(built.success(), "the benchmarks could not be built");
    let program = format!("residual-benches{}", std::env::consts::EXE_SUFFIX);
    let program = target.join("release").join(program);
    let status = Command::new(&program)
        .args(&args.args)
        .status()
        .with_context(|| format!("running {}", program.display()))?;
    // A program that was killed has no status.
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(code.map_or(ExitCode::FAILURE, ExitCode::from))
}
