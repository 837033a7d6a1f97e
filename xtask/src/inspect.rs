//! `cargo xtask inspect`: effects in and out with the reason for each, what the plan decided, programs.

use anyhow::{Context, Result};
use residual_device_cpu::LaneCount;
use residual_driver::price::{self, Price, PriceOptions, PricedTier};
use residual_frontend::hierarchy_quality;
use residual_frontend::out;
use residual_frontend::stats::mib;
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{BindingTimes, Decision, Plan, PlanOptions};
use serde_json::{Map, Value, json};

use crate::args::InspectArgs;
use crate::choices::TierArg;
use crate::time::Exposure;
use crate::{prices, scene};

pub(crate) fn run(args: &InspectArgs) -> Result<()> {
    let (plan, description, options) =
        scene::load_with_description(&args.scene, Exposure::default())?;
    let effects = Effects::of(&plan);
    let prices = match args.measure {
        true => Some(measure(&plan, &description, &options, args)?),
        false => None,
    };
    if args.json {
        let mut report = report(&plan, &effects);
        if let Some(prices) = prices {
            report["prices"] = prices.iter().map(prices::json).collect();
        }
        out!("{report}");
    } else {
        print(&plan, &effects);
        if let Some(prices) = prices {
            out!(
                "\nprices, in parts of the time of rendering:\n{}",
                prices::table(&prices)
            );
        }
    }
    Ok(())
}

fn measure(
    plan: &Plan,
    scene: &SceneDesc,
    options: &PlanOptions,
    args: &InspectArgs,
) -> Result<Vec<Price>> {
    let measurement = PriceOptions {
        rounds: args.rounds,
        samples: args.spp,
        tier: match args.tier {
            TierArg::Interpreted => PricedTier::Interpreted,
            TierArg::Auto | TierArg::Specialized => PricedTier::Specialized,
        },
    };
    let prices = price::prices(plan, scene, options, &measurement, prices::say);
    prices.with_context(|| match measurement.tier {
        PricedTier::Interpreted => "measuring prices",
        PricedTier::Specialized => "--tier interpreted measures without a compiler",
    })
}

/// What the plan decided, and what this machine adds.
fn decisions(plan: &Plan) -> Vec<Decision> {
    let mut decisions = plan.decisions();
    let lanes = LaneCount::native();
    decisions.push(Decision {
        about: "lanes",
        text: format!("{lanes}, which suit this machine"),
    });
    decisions.push(Decision {
        about: "hierarchy",
        text: format!(
            "{} children a node, as many as there are lanes; quality {:?}, by the number of triangles",
            lanes.count().max(4),
            hierarchy_quality(plan.data.triangle_count())
        ),
    });
    decisions
}

fn report(plan: &Plan, effects: &Effects) -> Value {
    let table: Map<_, _> = Effect::ALL
        .iter()
        .map(|&effect| {
            let row = json!({
                "in": effects.has(effect),
                "called_for_by": effects.reasons(effect),
                "changes_nothing": effects.dismissed(effect),
            });
            (effect.to_string(), row)
        })
        .collect();
    let programs: Vec<_> = plan
        .structure
        .programs
        .iter()
        .zip(&plan.materials)
        .map(|(program, materials)| {
            let names: Vec<_> = materials.iter().map(|material| &material.name).collect();
            let times = BindingTimes::of(program);
            json!({
                "materials": names,
                "inputs": program.inputs.iter().map(|input| input.name).collect::<Vec<_>>(),
                "constants": times.constants,
                "parameters": times.parameters,
                "images": times.images,
                "vertices": times.vertices,
            })
        })
        .collect();
    let dismissed: Vec<_> = plan
        .dismissed
        .iter()
        .map(|dismissed| json!({ "place": dismissed.place, "reason": dismissed.reason }))
        .collect();
    let plan_table: Map<_, _> = decisions(plan)
        .into_iter()
        .map(|Decision { about, text }| (about.to_owned(), text.into()))
        .collect();
    json!({
        "scene": plan.name,
        "triangles": plan.data.triangle_count(),
        "camera": plan.camera_name,
        "effects": table,
        "changes_nothing": dismissed,
        "plan": plan_table,
        "programs": programs,
        "lights": light_count(plan),
        "memory_mib": memory_mib(plan),
    })
}

fn light_count(plan: &Plan) -> usize {
    plan.lights.iter().map(|kind| kind.count).sum()
}

fn memory_mib(plan: &Plan) -> f64 {
    mib(plan.memory_bytes())
}

fn print(plan: &Plan, effects: &Effects) {
    out!(
        "{}: {} triangles, {} lights, camera {:?}, {:.1} MiB of data",
        plan.name,
        plan.data.triangle_count(),
        light_count(plan),
        plan.camera_name,
        memory_mib(plan)
    );
    out!("\neffects in:");
    for effect in effects.iter() {
        let reasons = shortened(effects.reasons(effect));
        out!("  {:<22} {reasons}", effect.to_string());
    }
    let out: Vec<_> = Effect::ALL
        .iter()
        .filter(|&&effect| !effects.has(effect))
        .map(ToString::to_string)
        .collect();
    out!("\neffects out: {}", out.join(", "));
    if !plan.dismissed.is_empty() {
        out!("\nin the file, without effect:");
        for dismissed in &plan.dismissed {
            out!("  {}: {}", dismissed.place, dismissed.reason);
        }
    }
    out!("\nplan:");
    for Decision { about, text } in decisions(plan) {
        out!("  {about:<14} {text}");
    }
    out!("\nprograms (constants, parameters, images, vertex attributes):");
    let programs = plan.structure.programs.iter().zip(&plan.materials);
    for (number, (program, materials)) in programs.enumerate() {
        let times = BindingTimes::of(program);
        let names: Vec<_> = materials
            .iter()
            .map(|material| format!("{:?}", material.name))
            .collect();
        out!(
            "  {number:>3} ({}, {}, {}, {}) {}",
            times.constants,
            times.parameters,
            times.images,
            times.vertices,
            shortened(&names)
        );
    }
}

/// The first few of a list.
fn shortened(list: &[String]) -> String {
    const SHOWN: usize = 4;
    let first = list[..list.len().min(SHOWN)].join("; ");
    match list.len().saturating_sub(SHOWN) {
        0 => first,
        more => format!("{first}; and {more} more"),
    }
}
