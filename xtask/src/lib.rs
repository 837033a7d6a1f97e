//! The command line of Residual: `cargo xtask render scene.gltf`.
//!
//! A library, so that tests can build the command line for themselves. It reads arguments, calls the driver, and prints.

mod args;
mod build;
mod cache;
mod delegate;
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
    run(Cli::parse().command).unwrap_or_else(|error| {
        eprintln!("error: {error:#}");
        ExitCode::FAILURE
    })
}

fn run(command: Command) -> anyhow::Result<ExitCode> {
    match command {
        Command::Render(args) => render::run(&args)?,
        Command::Inspect(args) => inspect::run(&args)?,
        Command::Emit(args) => emit::run(&args)?,
        Command::Build(args) => build::run(&args)?,
        Command::Cache(command) => cache::run(command)?,
        Command::Bench(passed_on) => return delegate::to_package("residual-benches", &passed_on),
        Command::Check(passed_on) => return delegate::to_package("residual-check", &passed_on),
    }
    Ok(ExitCode::SUCCESS)
}
