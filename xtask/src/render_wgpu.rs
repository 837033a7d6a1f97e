//! `cargo xtask render --device wgpu`, and `cargo xtask adapters`.

use std::time::Duration;

use anyhow::{Context, Result, bail, ensure};
use residual_device_cpu::{CpuDevice, LaneCount, Width};
use residual_device_wgpu::{Arithmetic, Dialect, Gpu, Mapping, Mode, Question, list_adapters};
use residual_driver::gpu::{GpuDriver, GpuPasses, arithmetic};
use residual_driver::poses::Poses;
use residual_frontend::options::EvenOnly;
use residual_frontend::session::Session;
use residual_frontend::stats::{DeviceReport, Preparation, Statistics, TierReport};
use residual_frontend::{note, out};

use crate::args::RenderArgs;
use crate::choices::{MappingArg, TierArg};
use crate::scene;
use crate::time::Exposure;

/// Renders on a GPU.
pub(crate) fn run(args: &RenderArgs) -> Result<()> {
    ensure!(
        args.tier != TierArg::Interpreted,
        "--tier interpreted: a GPU runs what is made for the scene; render with --device cpu"
    );
    let sampling = args.render.sampling(Some(EvenOnly::Gpu))?;
    let session = Session::new(
        &args.render,
        args.scene.scene.file_stem().unwrap_or_default(),
        args.scene.layers(),
    )?;
    let gpu = Gpu::open(args.adapter.as_deref())?;
    let probe = gpu.probe()?;
    if !probe.is_exact() && !args.render.quiet {
        note!(
            "note: {}: images may differ from the processor's in their last bits ({})",
            gpu.adapter.name,
            probe.answers
        );
    }
    if gpu.adapter.is_software() && !args.render.quiet {
        note!(
            "note: {} is a driver that uses the processor; --device cpu is faster",
            gpu.adapter.name
        );
    }
    let (plan, load) = scene::load(&args.scene, Exposure::of(&args.render))?;
    let cpu = CpuDevice::new(args.render.threads).context("starting threads")?;
    let options = args
        .render
        .render_options(args.scene.size.0, scene::defaults(&plan), sampling);
    let poses = Poses::new(&plan, Width::Four, options.seed);
    poses.hierarchy(0);
    let mapping = match args.mapping {
        MappingArg::Wavefront => Mapping::Wavefront,
        MappingArg::Megakernel => Mapping::Megakernel,
    };
    let manifests = scene::manifests(&plan);
    let driver = GpuDriver::new(&gpu, probe, &plan, &poses, mapping);
    let (rendered, report) = std::thread::scope(|scope| {
        let compilation = scope.spawn(|| driver.compile(options.size));
        if args.tier == TierArg::Specialized && compilation.join().is_err() {
            bail!("compiling kernels ended early");
        }
        if plan.motion.is_some() {
            scope.spawn(|| poses.build_ahead());
        }
        let mut passes = GpuPasses::new(&driver, &cpu, &options);
        let rendered = session.render(
            scene::subject(&plan, &manifests),
            &options,
            |film, pass| passes.pass(film, pass),
            |_| (),
        );
        poses.end();
        Ok((rendered?, passes.report()))
    })?;
    let (bvh_time, bvh_bytes) = poses.built();
    let statistics = Statistics {
        scene: &scene::summary(&plan),
        preparation: Preparation {
            load,
            bvh: bvh_time,
            compile: Duration::ZERO,
        },
        total: session.start.elapsed(),
        tiers: TierReport {
            tier: match report.from {
                Some(_) => "specialized",
                None => "interpreted",
            },
            compiled_from: report.from,
            break_even: None,
        },
        device: DeviceReport::Wgpu(report),
        threads: cpu.threads(),
        lanes: LaneCount::native().count(),
        bvh_bytes,
        rendered: &rendered,
    };
    session.finish(&statistics);
    scene::note_motion(&plan, &args.render);
    Ok(())
}

/// Lists the adapters, and what each makes of arithmetic.
pub(crate) fn adapters() -> Result<()> {
    let adapters = list_adapters();
    if adapters.is_empty() {
        bail!(residual_device_wgpu::Error::NoAdapter);
    }
    for (index, adapter) in adapters.iter().enumerate() {
        out!("{index}: {adapter}");
        if let Err(error) = measure(&index.to_string()) {
            out!("    {error}");
        }
    }
    Ok(())
}

/// Prints what an adapter makes of the whole suite of operations.
fn measure(adapter: &str) -> Result<(), residual_device_wgpu::Error> {
    let gpu = Gpu::open(Some(adapter))?;
    let plain = Dialect {
        mode: Mode::Plain,
        arithmetic: Arithmetic::default(),
    };
    let chosen = gpu.probe()?.dialect;
    for dialect in [plain, chosen] {
        let answers = gpu.ask(&Question::all(), dialect)?;
        out!("    {}: {answers}", arithmetic(&dialect));
    }
    Ok(())
}
