//! The command line: runs the checks, says what is wrong and how long they took.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use anyhow::Result;
use clap::{Parser, ValueEnum};

use crate::figures;
use crate::step::Step;
use crate::workspace::Workspace;

/// Checks the workspace as continuous integration does, but for the tests.
#[derive(Parser)]
#[command(name = "cargo xtask check")]
struct Cli {
    /// Only this check; may be given more than once
    #[arg(long, value_enum, value_name = "STEP", value_delimiter = ',')]
    only: Vec<Step>,
    /// List the checks
    #[arg(long)]
    list: bool,
}

/// The command line: status 0, 1 if something is wrong, 2 for bad usage.
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    if cli.list {
        for step in Step::value_variants() {
            println!("{:<14} {}", step.name(), step.description());
        }
        return ExitCode::SUCCESS;
    }
    match run(&cli) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

/// How a check ended.
struct Outcome {
    step: Step,
    problems: usize,
    time: Duration,
}

/// Whether all is well.
fn run(cli: &Cli) -> Result<bool> {
    let workspace = Workspace::own()?;
    let steps = match &cli.only[..] {
        [] => Step::value_variants(),
        only => only,
    };
    let outcomes: Vec<_> = steps.iter().map(|step| check(*step, &workspace)).collect();
    if cli.only.is_empty() || cli.only.contains(&Step::Files) {
        println!("\n{}", figures::table(&workspace)?);
    }
    println!();
    for outcome in &outcomes {
        let result = match outcome.problems {
            0 => "ok".to_owned(),
            1 => "FAILED, 1 problem".to_owned(),
            problems => format!("FAILED, {problems} problems"),
        };
        let seconds = outcome.time.as_secs_f64();
        println!("{:<14} {result:<20} {seconds:>7.1} s", outcome.step.name());
    }
    Ok(outcomes.iter().all(|outcome| outcome.problems == 0))
}

/// Makes a check and prints what is wrong. One that could not be made is one problem.
fn check(step: Step, workspace: &Workspace) -> Outcome {
    println!("== {}", step.name());
    let start = Instant::now();
    let problems = match step.problems(workspace) {
        Ok(problems) => {
            for problem in &problems {
                println!("{problem}");
            }
            problems.len()
        }
        Err(error) => {
            println!("error: {error:#}");
            1
        }
    };
    Outcome {
        step,
        problems,
        time: start.elapsed(),
    }
}
