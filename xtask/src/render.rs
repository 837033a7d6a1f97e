//! `cargo xtask render` on the processor.

use std::convert::Infallible;
use std::time::{Duration, Instant};

use anyhow::{Context, Result, ensure};
use residual_device_cpu::{AnyBvh, CpuDevice, LaneCount, SceneView};
use residual_driver::tiers::{Ledger, Tiers};
use residual_frontend::hierarchy_quality;
use residual_frontend::note;
use residual_frontend::session::Session;
use residual_frontend::stats::{DeviceReport, Preparation, Statistics};

use crate::args::RenderArgs;
use crate::choices::{SpecializeArg, TierArg};
use crate::scene;

pub(crate) fn run(args: &RenderArgs) -> Result<()> {
    ensure!(
        !(args.render.adaptive && args.scene.has_light_paths()),
        "--adaptive: paths from lights add to any pixel, so that no pixel can have more of them; render with --tracer path"
    );
    let session = Session::new(
        &args.render,
        args.scene.scene.file_stem().unwrap_or_default(),
        args.scene.layers(),
    )?;
    let (plan, load) = scene::load(&args.scene)?;
    let lanes = args.lanes.unwrap_or_else(LaneCount::native);
    let device = CpuDevice::new(args.render.threads).context("starting threads")?;
    let options = args
        .render
        .render_options(args.scene.size.0, scene::defaults(&plan));
    let tier = match args.scene.specialize {
        SpecializeArg::None => TierArg::Interpreted,
        SpecializeArg::Structure | SpecializeArg::Constants => args.tier,
    };

    let manifests = scene::manifests(&plan);
    let tiers = Tiers::new(&plan, lanes);
    let ledger = Ledger::default();
    let mut bvh_time = Duration::ZERO;
    let (rendered, bvh_bytes) = std::thread::scope(|scope| {
        // Compilation runs beside the building of the hierarchy and, with `auto`, beside rendering.
        let compilation = (tier != TierArg::Interpreted).then(|| scope.spawn(|| tiers.compile()));
        let bvh_start = Instant::now();
        let quality = hierarchy_quality(plan.data.triangle_count());
        let bvh = AnyBvh::build(&plan.data, LaneCount::native(), quality);
        bvh_time = bvh_start.elapsed();
        if tier == TierArg::Specialized
            && let Some(compilation) = compilation
        {
            compilation.join().expect("compilation does not panic");
            tiers
                .expect_compiled()
                .context("--tier interpreted renders without a compiler")?;
        }
        let view = SceneView {
            buffers: plan.data.buffers(),
            traversal: &bvh,
        };
        let rendered = session.render(
            scene::subject(&plan, &manifests),
            &options,
            |film, pass| {
                let renderer = tiers.choose(&ledger);
                Ok::<_, Infallible>(device.pass(renderer, &view, &options, film, pass))
            },
            |progress| ledger.add(progress),
        );
        tiers.end();
        Ok::<_, anyhow::Error>((rendered?, bvh.memory_bytes()))
    })?;

    if let Some(error) = tiers.failure() {
        note!("warning: the renderer could not be compiled; it was interpreted instead: {error:#}");
    }
    let statistics = Statistics {
        scene: &scene::summary(&plan),
        preparation: Preparation {
            load,
            bvh: bvh_time,
            compile: tiers.compile_time(),
        },
        total: session.start.elapsed(),
        tiers: tiers.report(&ledger, device.threads()),
        device: DeviceReport::Cpu,
        threads: device.threads(),
        lanes: lanes.count(),
        bvh_bytes,
        rendered: &rendered,
    };
    session.finish(&statistics);
    if !args.render.quiet
        && args.tier == TierArg::Auto
        && let Some(samples) = statistics.tiers.compiled_from
    {
        let paid = match statistics.tiers.break_even {
            Some(samples) => format!("; it pays for itself after {samples:.0}"),
            None => String::new(),
        };
        note!("compiled renderer used after {samples} samples per pixel{paid}");
    }
    Ok(())
}
