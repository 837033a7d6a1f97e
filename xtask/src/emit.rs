//! `cargo xtask emit`: the generated renderer as text.

use std::fs;

use anyhow::{Context, Result};
use residual_device_cpu::LaneCount;
use residual_driver::compile::lanes_name;
use residual_frontend::{note, out};
use residual_scenegen::emit::rust;

use crate::args::EmitArgs;
use crate::choices::TargetArg;
use crate::scene;
use crate::time::Exposure;

pub(crate) fn run(args: &EmitArgs) -> Result<()> {
    let (plan, _) = scene::load(&args.scene, Exposure::default())?;
    let lanes = args.lanes.unwrap_or_else(LaneCount::native);
    let (text, extension) = match args.target {
        TargetArg::Rust => (rust::module(&plan, &lanes_name(lanes)), "rs"),
        TargetArg::Wgsl => (residual_wgsl::scene_module(&plan.structure), "wgsl"),
    };
    match &args.output {
        None => out!("{}", text.trim_end()),
        Some(directory) => {
            fs::create_dir_all(directory)
                .with_context(|| format!("creating {}", directory.display()))?;
            let path = directory.join(format!("{}.{extension}", plan.name));
            residual_frontend::output::write_atomically(&path, text.as_bytes())?;
            note!("{}", path.display());
        }
    }
    Ok(())
}
