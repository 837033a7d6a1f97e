//! `cargo xtask build`: a program that renders one scene, with the scene's data in it.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use residual_device_cpu::LaneCount;
use residual_frontend::output::{check_place, write_executable};
use residual_frontend::stats::mib;
use residual_scenegen::effects::Effects;
use residual_scenegen::emit::rust;
use residual_scenegen::plan::Plan;
use tempfile::NamedTempFile;

use crate::args::BuildArgs;
use crate::compile::{Build, Compiler, lanes_name};
use crate::scene;
use crate::workspace;

pub(crate) fn run(args: &BuildArgs) -> Result<()> {
    check_place(&args.output)?;
    let (plan, _) = scene::load(&args.scene)?;
    let native = match args.target_cpu {
        Some(_) => LaneCount::Eight,
        None => LaneCount::native(),
    };
    let lanes = args.lanes.unwrap_or(native);
    let data = plan.data.to_bytes();
    let data_file = keep_for_now(&data)?;
    let source = program(
        &plan,
        &args.scene.size.0,
        &lanes_name(lanes),
        data_file.path(),
    );
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
    write_executable(&args.output, &program)?;
    eprintln!(
        "{}: {:.1} MiB, of which {:.1} MiB are the scene's data",
        args.output.display(),
        mib(program.len()),
        mib(data.len())
    );
    Ok(())
}

/// A file for the compiler to include, which goes when it is dropped.
fn keep_for_now(data: &[u8]) -> Result<NamedTempFile> {
    let own = workspace::own_directory();
    let write = || {
        fs::create_dir_all(&own)?;
        let mut file = NamedTempFile::with_suffix_in(".data", &own)?;
        file.write_all(data)?;
        Ok::<_, std::io::Error>(file)
    };
    write().with_context(|| format!("writing to {}", own.display()))
}

/// The emitted code: the scene, and its renderer.
fn program(plan: &Plan, size: &[u32; 2], lanes: &str, data: &Path) -> String {
    let effects: Vec<_> = Effects::of(plan).iter().map(|e| e.to_string()).collect();
    format!(
        "{}\npub(crate) const SCENE: Option<crate::StandaloneScene> = Some(crate::StandaloneScene {{\n    \
         name: {:?},\n    size: {size:?},\n    reach: {:?},\n    programs: {},\n    effects: &{effects:?},\n    \
         data: include_bytes!({data:?}),\n    renderer: &Compiled,\n    lanes: Compiled::LANES,\n}});\n",
        rust::module(plan, lanes),
        plan.name,
        plan.default_reach(),
        plan.structure.programs.len(),
    )
}
