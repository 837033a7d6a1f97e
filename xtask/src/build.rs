//! `cargo xtask build`: a program that renders one scene, with the scene's data in it.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use residual_device_cpu::LaneCount;
use residual_frontend::output::{write_atomically, write_executable};
use residual_scenegen::effects::Effects;
use residual_scenegen::emit::rust;
use residual_scenegen::plan::Plan;

use crate::args::BuildArgs;
use crate::compile::{Build, Compiler, lanes_name};
use crate::scene;
use crate::workspace;

pub(crate) fn run(args: &BuildArgs) -> Result<()> {
    let (plan, _) = scene::load(&args.scene)?;
    let native = match args.target_cpu {
        Some(_) => LaneCount::Eight,
        None => LaneCount::native(),
    };
    let lanes = args.lanes.unwrap_or(native);
    let data = plan.data.to_bytes();
    let own = workspace::own_directory();
    fs::create_dir_all(&own).with_context(|| format!("creating {}", own.display()))?;
    let data_file = own.join(format!("standalone-{}.data", std::process::id()));
    write_atomically(&data_file, &data)?;
    let source = program(&plan, &args.scene.size.0, &lanes_name(lanes), &data_file);
    let flags = args
        .target_cpu
        .as_ref()
        .map(|cpu| format!("-Ctarget-cpu={cpu}"));
    let target_directory = match &args.target_cpu {
        Some(cpu) => workspace::own_directory().join("targets").join(cpu),
        None => workspace::target_directory(),
    };
    let build = Build {
        package: "residual-standalone",
        source: &source,
        file: &format!("residual-standalone{}", std::env::consts::EXE_SUFFIX),
        flags: &["-Cstrip=symbols"],
        rustflags: flags.as_deref(),
        target_directory: &target_directory,
    };
    let program = Compiler::default()
        .build(&build, |made| {
            fs::read(made).with_context(|| format!("reading {}", made.display()))
        })
        .with_context(|| format!("building the program of {:?}", plan.name))?;
    fs::remove_file(&data_file).with_context(|| format!("removing {}", data_file.display()))?;
    write_executable(&args.output, &program)?;
    eprintln!(
        "{}: {:.1} MiB, of which {:.1} MiB are the scene's data",
        args.output.display(),
        mib(program.len()),
        mib(data.len())
    );
    Ok(())
}

fn mib(bytes: usize) -> f64 {
    bytes as f64 / f64::from(1 << 20)
}

/// The emitted code: the scene, and its renderer.
fn program(plan: &Plan, size: &[u32; 2], lanes: &str, data: &Path) -> String {
    let effects: Vec<_> = Effects::of(plan).iter().map(|e| e.to_string()).collect();
    format!(
        "{}\npub(crate) const SCENE: Option<crate::StandaloneScene> = Some(crate::StandaloneScene {{\n    \
         name: {:?},\n    size: {size:?},\n    programs: {},\n    effects: &{effects:?},\n    \
         data: include_bytes!({data:?}),\n    renderer: &Compiled,\n    lanes: Compiled::LANES,\n}});\n",
        rust::module(plan, lanes),
        plan.name,
        plan.structure.programs.len(),
    )
}
