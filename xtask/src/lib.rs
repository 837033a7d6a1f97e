//! The command line of Residual: `cargo xtask render scene.gltf`.
//!
//! A library, so that tests can build the command line for themselves. It reads arguments, calls the driver, and prints.

mod args;
mod bench;
mod build;
mod cache;
mod emit;
mod inspect;
mod prices;
mod render;
mod scene;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Cli, Command};

/// The command line: status 0, 1 for a failed job, 2 for bad usage.
pub fn main() -> ExitCode {
    // Bad usage ends in clap, with status 2.
    let result = match Cli::parse().command {
        Command::Render(args) => render::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Emit(args) => emit::run(&args),
        Command::Build(args) => build::run(&args),
        Command::Cache(command) => cache::run(command),
        Command::Bench(args) => return or_fail(bench::run(&args)),
    };
    or_fail(result.map(|()| ExitCode::SUCCESS))
}

fn or_fail(result: anyhow::Result<ExitCode>) -> ExitCode {
    result.unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}
