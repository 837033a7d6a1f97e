//! A program that renders one scene: its renderer and its data in one file.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use anyhow::{Context, Result};
use residual_device_cpu::LaneCount;
use residual_scenegen::effects::Effects;
use residual_scenegen::emit::rust;
use residual_scenegen::plan::Plan;
use tempfile::NamedTempFile;

use crate::cargo::{Build, Builder};
use crate::compile::lanes_name;
use crate::workspace;

/// How a program is built.
#[derive(Clone, Debug)]
pub struct StandaloneOptions {
    /// Width and height of its image in pixels, unless it is told otherwise.
    pub size: [u32; 2],
    /// Paths shaded at once; without it what suits the machine, or 8 with `target_cpu`.
    pub lanes: Option<LaneCount>,
    /// Built for this processor instead of the machine's, in the compiler's words (`x86-64-v3`); the first time all crates
    /// are built for it.
    pub target_cpu: Option<String>,
}

/// A program.
pub struct Standalone {
    /// The contents of its file.
    pub executable: Vec<u8>,
    /// How many bytes of it are the scene's data.
    pub data_bytes: usize,
}

/// Builds the program of a plan.
///
/// # Errors
/// If there is no cargo, or it fails.
pub fn build(plan: &Plan, options: &StandaloneOptions) -> Result<Standalone> {
    let native = match options.target_cpu {
        Some(_) => LaneCount::Eight,
        None => LaneCount::native(),
    };
    let lanes = options.lanes.unwrap_or(native);
    let data = plan.data.to_bytes();
    let data_file = keep_for_now(&data)?;
    let source = source(plan, &options.size, &lanes_name(lanes), data_file.path());
    // As .cargo/config.toml, which these stand in for.
    let flags = options.target_cpu.as_ref().map(|cpu| {
        format!("-Ctarget-cpu={cpu} -Cllvm-args=-enable-noalias-to-md-conversion=false")
    });
    let target_directory = match &options.target_cpu {
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
    let executable = Builder::default()
        .build(&build, |made| {
            fs::read(made).with_context(|| format!("reading {}", made.display()))
        })
        .with_context(|| format!("building the program of {:?}", plan.name))?;
    Ok(Standalone {
        executable,
        data_bytes: data.len(),
    })
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
fn source(plan: &Plan, size: &[u32; 2], lanes: &str, data: &Path) -> String {
    let effects: Vec<_> = Effects::of(plan).iter().map(|e| e.to_string()).collect();
    let manifests: String = plan
        .structure
        .layers
        .iter()
        .filter_map(|layer| {
            let names: Vec<_> = plan.names(layer)?.into_iter().collect();
            Some(format!("({:?}, &{names:?}), ", layer.name()))
        })
        .collect();
    format!(
        "{}\npub(crate) const SCENE: Option<crate::StandaloneScene> = Some(crate::StandaloneScene {{\n    \
         name: {:?},\n    size: {size:?},\n    defaults: residual_frontend::options::SceneDefaults {{ max_depth: {}, reach: {:?} }},\n    programs: {},\n    is_bounded: {},\n    effects: &{effects:?},\n    manifests: &[{manifests}],\n    \
         data: include_bytes!({data:?}),\n    renderer: &Compiled,\n    lanes: Compiled::LANES,\n}});\n",
        rust::module(plan, lanes),
        plan.name,
        plan.default_max_depth(),
        plan.default_reach(),
        plan.structure.programs.len(),
        plan.structure.tracer.is_bounded(),
    )
}
