//! `cargo xtask bench render`: whole renders, specialised and interpreted, with our traversal and with Embree's.

use std::path::Path;

use crate::embree::{Embree, EmbreeScene, EmbreeTraversal, Quality};
use crate::isa::Isa;
use crate::mesh::Mesh;
use crate::render::{RenderContender, RenderRow, render_table, renders};
use anyhow::{Context, Result};
use residual_device_cpu::plugin::LoadedRenderer;
use residual_device_cpu::{AnyBvh, CpuDevice, LaneCount, SceneView, Traversal, Width};
use residual_driver::compile;
use residual_frontend::hierarchy_quality;
use residual_render::passes::RenderOptions;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{Binding, CameraChoice, CullingRule, Plan, PlanOptions, plan};
use residual_variants::AnyLanes;

use super::args::RenderBenchArgs;
use super::scenes::scenes_or_own;

pub(super) fn run(args: &RenderBenchArgs) -> Result<()> {
    let embree = match Embree::load(Isa::preferred()) {
        Ok(embree) => Some(embree),
        Err(missing) => {
            eprintln!("without Embree: {missing}");
            None
        }
    };
    for scene in scenes_or_own(&args.scene)? {
        let plan = load(&scene, args)?;
        let has_alpha = plan
            .structure
            .programs
            .iter()
            .any(|program| program.alpha_test.is_some());
        if has_alpha && embree.is_some() {
            eprintln!(
                "{}: it has alpha, which Embree is measured without",
                plan.name
            );
        }
        let built = embree.as_ref().filter(|_| !has_alpha).map(|embree| {
            let mesh = Mesh {
                positions: plan.data.positions(),
                triangles: plan.data.triangles(),
            };
            embree.build(&mesh, Quality::High, true)
        });
        let rows = measure(&plan, built.as_deref(), args)?;
        if args.json {
            rows.iter().for_each(|row| println!("{}", row.to_json()));
        } else {
            println!(
                "{}, {} triangles, {} programs, {} threads\n\n{}",
                plan.name,
                plan.data.triangle_count(),
                plan.structure.programs.len(),
                args.threads,
                render_table(&rows)
            );
        }
    }
    Ok(())
}

/// Reads and plans a scene, both sides of everything visible: so Embree needs no callback.
fn load(path: &Path, args: &RenderBenchArgs) -> Result<Plan> {
    let scene = import(path, &ImportOptions::default())?;
    let options = PlanOptions {
        binding: Binding::Structure,
        camera: CameraChoice::Default,
        size: args.size.0,
        culling: CullingRule::None,
        ..PlanOptions::default()
    };
    plan(&scene, &options).with_context(|| path.display().to_string())
}

/// One lane count's renderers.
struct Renderers {
    lanes: LaneCount,
    interpreter: AnyLanes,
    compiled: LoadedRenderer,
}

fn measure(
    plan: &Plan,
    embree: Option<&EmbreeScene>,
    args: &RenderBenchArgs,
) -> Result<Vec<RenderRow>> {
    let native = [LaneCount::native()];
    let lanes = if args.lanes.is_empty() {
        &native[..]
    } else {
        &args.lanes
    };
    let renderers = lanes
        .iter()
        .map(|&lanes| {
            Ok(Renderers {
                lanes,
                interpreter: AnyLanes::new(plan.structure.clone(), lanes),
                compiled: compile(plan, lanes)?,
            })
        })
        .collect::<Result<Vec<_>>>()?;
    let triangles = plan.data.triangle_count();
    let bvh = AnyBvh::build(&plan.data, Width::Native, hierarchy_quality(triangles));
    let (single, packets) = (
        embree.map(EmbreeTraversal::single),
        embree.map(EmbreeTraversal::packets),
    );
    let mut contenders = Vec::new();
    let traversals: Vec<(&'static str, &(dyn Traversal + Sync))> = [
        Some(("residual", &bvh as _)),
        single.as_ref().map(|tracer| ("embree1", tracer as _)),
        packets.as_ref().map(|tracer| ("embree16", tracer as _)),
    ]
    .into_iter()
    .flatten()
    .collect();
    for Renderers {
        lanes,
        interpreter,
        compiled,
    } in &renderers
    {
        for &(traversal, tracer) in &traversals {
            let contender = |tier, renderer| RenderContender {
                tier,
                traversal,
                lanes: lanes.count(),
                renderer,
                view: SceneView {
                    buffers: plan.data.buffers(),
                    traversal: tracer,
                },
            };
            contenders.push(contender("specialized", compiled as _));
            if traversal == "residual" {
                contenders.push(contender("interpreted", interpreter as _));
            }
        }
    }
    let options = RenderOptions {
        size: args.size.0,
        samples: Some(args.spp),
        time: None,
        max_depth: args.max_depth,
        seed: 0,
        ..RenderOptions::default()
    };
    let device = CpuDevice::new(args.threads).context("starting threads")?;
    Ok(renders(
        &plan.name,
        &device,
        &contenders,
        &options,
        args.rounds as usize,
    ))
}
