//! `cargo xtask bench traversal`: ray queries beside Embree's and obvhs'.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use residual_benches::isa::Isa;
use residual_benches::ours::{Kernel, Precision};
use residual_benches::rays::RayKind;
use residual_benches::report::{build_table, trace_table};
use residual_benches::run::{Options, SceneReport, traversal};

use crate::args::{BenchCommand, IsaArg, KernelArg, PrecisionArg, RaysArg, TraversalArgs};
use crate::{bench_compile, bench_render, bench_shading};

pub(crate) fn run(command: &BenchCommand) -> Result<()> {
    match command {
        BenchCommand::Traversal(args) => run_traversal(args),
        BenchCommand::Render(args) => bench_render::run(args),
        BenchCommand::Shading(args) => bench_shading::run(args),
        BenchCommand::Compile(args) => bench_compile::run(args),
    }
}

fn run_traversal(args: &TraversalArgs) -> Result<()> {
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
        kernels: args.kernel.iter().map(kernel).collect(),
        widths: args.width.clone(),
        precisions: args.precision.iter().map(precision).collect(),
        rays: args.rays.iter().map(rays).collect(),
        isa: match args.isa {
            None => Isa::preferred(),
            Some(IsaArg::Avx512) => Isa::Avx512,
            Some(IsaArg::Avx2) => Isa::Avx2,
        },
        obvhs: !is_tuning,
        builds: !is_tuning,
    })
}

fn kernel(arg: &KernelArg) -> Kernel {
    match arg {
        KernelArg::Single => Kernel::Single,
        KernelArg::Packet => Kernel::Packet,
        KernelArg::Hybrid => Kernel::Hybrid,
        KernelArg::Scalar => Kernel::Scalar,
    }
}

fn precision(arg: &PrecisionArg) -> Precision {
    match arg {
        PrecisionArg::Fast => Precision::Fast,
        PrecisionArg::Watertight => Precision::Watertight,
        PrecisionArg::Exact => Precision::Exact,
    }
}

fn rays(arg: &RaysArg) -> RayKind {
    match arg {
        RaysArg::Primary => RayKind::Primary,
        RaysArg::Ao => RayKind::Ao,
        RaysArg::Diffuse => RayKind::Diffuse,
        RaysArg::Miss => RayKind::Miss,
    }
}

/// The scenes that were asked for; where none were, the glTF files that come with the repository.
pub(crate) fn scenes_or_own(asked_for: &[PathBuf]) -> Result<Vec<PathBuf>> {
    if !asked_for.is_empty() {
        return Ok(asked_for.to_vec());
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let entries = std::fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
    let mut scenes = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>>>()?;
    scenes.retain(|path| {
        path.extension()
            .is_some_and(|extension| extension == "gltf")
    });
    scenes.sort();
    Ok(scenes)
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
