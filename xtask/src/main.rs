//! The command line of Residual: `cargo xtask render scene.gltf`.

mod args;
mod compile;
mod emit;
mod inspect;
mod output;
mod render;
mod scene;
mod stats;

use std::process::ExitCode;

use clap::Parser;

use crate::args::{Cli, Command};

fn main() -> ExitCode {
    // Bad usage ends in clap, with status 2.
    let result = match Cli::parse().command {
        Command::Render(args) => render::run(&args),
        Command::Inspect(args) => inspect::run(&args),
        Command::Emit(args) => emit::run(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
