//! `cargo xtask bench traversal`: ray queries beside Embree's and obvhs'.

use anyhow::Result;

use super::args::TraversalArgs;
use super::scenes::scenes_or_own;
use crate::isa::Isa;
use crate::report::{build_table, trace_table};
use crate::run::{Options, SceneReport, traversal};

pub(super) fn run(args: &TraversalArgs) -> Result<()> {
    traversal(&options(args)?, |report| {
        if args.json {
            print_json(&report);
        } else {
            print_tables(&report);
        }
    })
}

fn options(args: &TraversalArgs) -> Result<Options> {
    let (rounds, side) = if args.quick { (3, 256) } else { (11, 512) };
    let is_tuning = args.quick || !args.kernel.is_empty() || !args.width.is_empty();
    Ok(Options {
        scenes: scenes_or_own(&args.scene)?,
        rounds: args.rounds.map_or(rounds, |rounds| rounds as usize),
        size: args.size.map_or([side; 2], |size| size.0),
        kernels: args.kernel.clone(),
        widths: args.width.clone(),
        precisions: args.precision.clone(),
        rays: args.rays.clone(),
        isa: args.isa.unwrap_or_else(Isa::preferred),
        obvhs: !is_tuning,
        builds: !is_tuning,
    })
}

fn print_json(report: &SceneReport) {
    for row in &report.traces {
        println!("{}", row.to_json());
    }
    for row in &report.builds {
        println!("{}", row.to_json());
    }
}

fn print_tables(report: &SceneReport) {
    println!(
        "{}, {} triangles, compiled for {}\n",
        report.scene,
        report.triangles,
        Isa::compiled_for()
    );
    println!("{}", trace_table(&report.traces));
    if !report.builds.is_empty() {
        println!("{}", build_table(&report.builds));
    }
}
