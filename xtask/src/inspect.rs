//! `cargo xtask inspect`: effects in and out with the reason for each, programs, parameters.

use anyhow::Result;
use residual_render::domain::Buffer;
use residual_scenegen::effects::{Effect, Effects};
use serde_json::json;

use crate::args::InspectArgs;
use crate::scene;

pub(crate) fn run(args: &InspectArgs) -> Result<()> {
    let (plan, _) = scene::load(&args.scene)?;
    let effects = Effects::of(&plan);
    if args.json {
        let table: serde_json::Map<_, _> = Effect::ALL
            .iter()
            .map(|&effect| {
                let reasons = effects.reasons(effect);
                (
                    effect.to_string(),
                    json!({ "in": !reasons.is_empty(), "called_for_by": reasons }),
                )
            })
            .collect();
        let programs: Vec<_> = plan
            .structure
            .programs
            .iter()
            .zip(&plan.materials)
            .map(|(program, materials)| json!({ "materials": materials, "inputs": program.inputs.len() }))
            .collect();
        let report = json!({
            "scene": plan.name,
            "triangles": plan.data.triangle_count(),
            "camera": plan.camera_name,
            "effects": table,
            "programs": programs,
            "lights": plan.light_counts.iter().sum::<usize>(),
            "parameter_words": plan.data.buffer(Buffer::Params).len(),
            "memory_mib": plan.data.memory_bytes() as f64 / (1 << 20) as f64,
        });
        println!("{report}");
        return Ok(());
    }
    println!(
        "{}: {} triangles, {} lights, camera {:?}, {:.1} MiB of data",
        plan.name,
        plan.data.triangle_count(),
        plan.light_counts.iter().sum::<usize>(),
        plan.camera_name,
        plan.data.memory_bytes() as f64 / (1 << 20) as f64
    );
    println!("\neffects in:");
    for effect in effects.iter() {
        println!(
            "  {:<22} {}",
            effect.to_string(),
            shortened(effects.reasons(effect))
        );
    }
    let out: Vec<_> = Effect::ALL
        .iter()
        .filter(|&&effect| effects.reasons(effect).is_empty())
        .map(ToString::to_string)
        .collect();
    println!("\neffects out: {}", out.join(", "));
    println!("\nprograms:");
    for (number, materials) in plan.materials.iter().enumerate() {
        println!("  {number:>3}  {}", materials.join(", "));
    }
    Ok(())
}

/// The first few reasons.
fn shortened(reasons: &[String]) -> String {
    const SHOWN: usize = 3;
    let first = reasons
        .iter()
        .take(SHOWN)
        .cloned()
        .collect::<Vec<_>>()
        .join("; ");
    match reasons.len().saturating_sub(SHOWN) {
        0 => first,
        more => format!("{first}; and {more} more"),
    }
}
