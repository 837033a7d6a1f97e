//! The command line: `cargo xtask bench` has cargo build and run it.

mod args;
mod compile;
mod coverage;
mod error;
mod render;
mod scenes;
mod shading;
mod traversal;

use std::process::ExitCode;

use clap::Parser;

use self::args::{Cli, Command};

/// The command line: status 0, 1 for a failed job, 2 for bad usage.
pub fn main() -> ExitCode {
    // Bad usage ends in clap, with status 2.
    let result = match Cli::parse().command {
        Command::Traversal(args) => traversal::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Shading(args) => shading::run(&args),
        Command::Compile(args) => compile::run(&args),
        Command::Coverage(args) => coverage::run(&args),
        Command::Error(args) => error::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
