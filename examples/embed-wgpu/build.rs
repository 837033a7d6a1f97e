//! Emits the kernels of the scene, in WGSL.

use std::path::PathBuf;

use residual_scenegen::build_script;
use residual_wgsl::{Arithmetic, KernelSet, Mapping};

#[path = "src/settings.rs"]
mod settings;

fn main() {
    if let Err(error) = emit() {
        println!("cargo::error={error}");
    }
}

fn emit() -> Result<(), Box<dyn std::error::Error>> {
    let plan = build_script::plan_scene(settings::SCENE, &settings::plan_options())?;
    let sided = plan.data.single_sided.contains(&true);
    // Without `f64`, which not every GPU has.
    let arithmetic = Arithmetic::default();
    let kernels = KernelSet::new(
        &plan.structure,
        Mapping::Wavefront,
        sided,
        false,
        arithmetic,
    );
    let file = PathBuf::from(std::env::var("OUT_DIR")?).join("kernels.wgsl");
    std::fs::write(file, kernels.to_string())?;
    let structure = residual_scenegen::fingerprint(&plan.structure);
    println!("cargo::rustc-env=STRUCTURE={structure}");
    Ok(())
}
