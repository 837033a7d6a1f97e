//! `cargo xtask emit`: the generated renderer as text.

use std::fs;

use anyhow::{Context, Result};
use residual_device_cpu::LaneCount;
use residual_driver::compile::lanes_name;
use residual_frontend::{note, out};
use residual_scenegen::emit::rust;
use residual_scenegen::plan::Plan;

use crate::args::EmitArgs;
use crate::scene;
use crate::time::Exposure;

/// The renderer for the processor.
pub(crate) fn rust(args: &EmitArgs) -> Result<()> {
    let lanes = args.lanes.unwrap_or_else(LaneCount::native);
    emit(args, "rs", |plan| rust::module(plan, &lanes_name(lanes)))
}

/// The functions that run on a GPU.
#[cfg(feature = "wgpu")]
pub(crate) fn wgsl(args: &EmitArgs) -> Result<()> {
    let text = |plan: &Plan| residual_wgsl::scene_module(&plan.structure);
    emit(args, "wgsl", text)
}

fn emit(args: &EmitArgs, extension: &str, text: impl FnOnce(&Plan) -> String) -> Result<()> {
    let (plan, _) = scene::load(&args.scene, Exposure::default())?;
    let text = text(&plan);
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
