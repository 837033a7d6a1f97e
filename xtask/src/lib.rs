//! The command line of Residual: `cargo xtask render scene.gltf`.
//!
//! A library, so that tests can build the command line for themselves. It reads arguments, calls the driver, and prints.

mod args;
mod build;
mod cache;
mod choices;
mod compare;
mod delegate;
mod emit;
mod inspect;
mod numbers;
mod prices;
mod render;
#[cfg(feature = "wgpu")]
mod render_wgpu;
mod scene;
mod time;

use std::process::ExitCode;

use clap::Parser;
use residual_frontend::note;

use crate::args::{Cli, Command};
use crate::choices::{DeviceArg, TargetArg};

/// The command line: status 0, 1 for a failed job, 2 for bad usage and for images that cannot be compared.
pub fn main() -> ExitCode {
    // Bad usage ends in clap, with status 2.
    run(Cli::parse().command).unwrap_or_else(|error| {
        note!("error: {error:#}");
        ExitCode::FAILURE
    })
}

fn run(command: Command) -> anyhow::Result<ExitCode> {
    match command {
        Command::Render(args) => match args.device {
            DeviceArg::Cpu => render::run(&args)?,
            #[cfg(feature = "wgpu")]
            DeviceArg::Wgpu => render_wgpu::run(&args)?,
            #[cfg(not(feature = "wgpu"))]
            DeviceArg::Wgpu => return delegate::all_to_package("xtask-wgpu"),
        },
        Command::Inspect(args) => inspect::run(&args)?,
        Command::Emit(args) => match args.target {
            TargetArg::Rust => emit::rust(&args)?,
            #[cfg(feature = "wgpu")]
            TargetArg::Wgsl => emit::wgsl(&args)?,
            #[cfg(not(feature = "wgpu"))]
            TargetArg::Wgsl => return delegate::all_to_package("xtask-wgpu"),
        },
        Command::Build(args) => build::run(&args)?,
        Command::Cache(command) => cache::run(command)?,
        Command::Compare(args) => return Ok(compare::run(&args)),
        #[cfg(feature = "wgpu")]
        Command::Adapters => render_wgpu::adapters()?,
        #[cfg(not(feature = "wgpu"))]
        Command::Adapters => return delegate::all_to_package("xtask-wgpu"),
        Command::Accuracy(passed_on) => return delegate::to_package("residual-study", &passed_on),
        Command::Bench(passed_on) => return delegate::to_package("residual-benches", &passed_on),
        Command::Check(passed_on) => return delegate::to_package("residual-check", &passed_on),
    }
    Ok(ExitCode::SUCCESS)
}
