//! `cargo xtask render` on the processor.

use std::convert::Infallible;

use anyhow::{Context, Result, ensure};
use residual_device_cpu::{CpuDevice, LaneCount, Width};
use residual_driver::poses::Poses;
use residual_driver::tiers::{Ledger, Tiers};
use residual_frontend::note;
use residual_frontend::options::EvenOnly;
use residual_frontend::session::Session;
use residual_frontend::stats::{DeviceReport, Preparation, Statistics};

use crate::args::RenderArgs;
use crate::choices::{SpecializeArg, TierArg};
use crate::scene;
use crate::time::Exposure;

pub(crate) fn run(args: &RenderArgs) -> Result<()> {
    let even_only = EvenOnly::of_processor(args.scene.tracer().has_light_paths());
    let sampling = args.render.sampling(even_only)?;
    let session = Session::new(
        &args.render,
        args.scene.scene.file_stem().unwrap_or_default(),
        args.scene.layers(),
    )?;
    let (plan, load) = scene::load(&args.scene, Exposure::of(&args.render))?;
    let lanes = args.lanes.unwrap_or_else(LaneCount::native);
    let device = CpuDevice::new(args.render.threads).context("starting threads")?;
    let options = args
        .render
        .render_options(args.scene.size.0, scene::defaults(&plan), sampling);
    let tier = match args.scene.specialize {
        SpecializeArg::None => TierArg::Interpreted,
        SpecializeArg::Structure | SpecializeArg::Constants => args.tier,
    };
    ensure!(
        args.lanes.is_none() || tier != TierArg::Interpreted,
        "--lanes: an interpreted render has as many as suit the machine; leave it out, or have the renderer compiled"
    );

    let manifests = scene::manifests(&plan);
    let tiers = Tiers::new(&plan, lanes);
    let ledger = Ledger::default();
    let poses = Poses::new(&plan, Width::Native, options.seed);
    let rendered = std::thread::scope(|scope| {
        // Compilation runs beside the building of the hierarchy and, with `auto`, beside rendering.
        let compilation = (tier != TierArg::Interpreted).then(|| scope.spawn(|| tiers.compile()));
        poses.hierarchy(poses.pose_of(0));
        if tier == TierArg::Specialized
            && let Some(compilation) = compilation
        {
            compilation.join().expect("compilation does not panic");
            tiers
                .expect_compiled()
                .context("--tier interpreted renders without a compiler")?;
        }
        if plan.motion.is_some() {
            scope.spawn(|| poses.build_ahead());
        }
        let rendered = session.render(
            scene::subject(&plan, &manifests),
            &options,
            |film, pass| {
                let renderer = tiers.choose(&ledger);
                Ok::<_, Infallible>(poses.pass(&device, renderer, &options, film, pass))
            },
            |progress| ledger.add(progress),
        );
        tiers.end();
        poses.end();
        rendered
    })?;

    if let Some(error) = tiers.failure() {
        note!("warning: the renderer could not be compiled; it was interpreted instead: {error:#}");
    }
    let (bvh_time, bvh_bytes) = poses.built();
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
    scene::note_motion(&plan, &args.render);
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
