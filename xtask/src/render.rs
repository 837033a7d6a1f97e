//! `cargo xtask render`.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use indicatif::{ProgressBar, ProgressStyle};
use residual_bvh::BuildQuality;
use residual_device_cpu::plugin::LoadedRenderer;
use residual_device_cpu::{
    AnyBvh, CpuDevice, Interpreter, LaneCount, RenderOptions, SceneView, TileRenderer,
};
use residual_render::film::Film;
use residual_scenegen::plan::Plan;

use crate::args::{RenderArgs, StatsArg, TierArg};
use crate::compile::Compiler;
use crate::output::{self, Metadata};
use crate::scene;
use crate::stats::{Stages, Statistics, cpu_seconds};

const DEFAULT_SAMPLES: u32 = 64;

pub(crate) fn run(args: &RenderArgs) -> Result<()> {
    let start = Instant::now();
    let outputs = outputs(args)?;
    let (plan, load) = scene::load(&args.scene)?;
    let lanes = args.lanes.unwrap_or_else(LaneCount::native);
    let device = CpuDevice::new(args.threads).context("starting threads")?;
    let options = RenderOptions {
        size: args.scene.size.0,
        samples: args.spp.or(args.time.is_none().then_some(DEFAULT_SAMPLES)),
        time: args.time,
        max_depth: args.max_depth,
        seed: args.seed,
    };
    let bar = progress_bar(args, &options);

    let interpreter = Interpreter::new(plan.structure.clone(), lanes);
    let compiler = Compiler::default();
    let compiled = OnceLock::new();
    let compiled_from = AtomicU32::new(u32::MAX);
    let samples_done = AtomicU32::new(0);
    let stop = stop_on_interrupt()?;
    let mut bvh_time = Duration::ZERO;
    let mut bvh_bytes = 0;
    let mut done = None;
    let mut render_cpu = None;
    std::thread::scope(|scope| {
        // Compilation runs beside the building of the hierarchy and, with `auto`, beside rendering.
        let compilation = (args.tier != TierArg::Interpreted).then(|| {
            scope.spawn(|| compiled.get_or_init(|| Compilation::run(&compiler, &plan, lanes)))
        });
        let bvh_start = Instant::now();
        let triangles = plan.data.triangle_count();
        let bvh = AnyBvh::build(&plan.data, LaneCount::native(), quality(triangles));
        bvh_time = bvh_start.elapsed();
        bvh_bytes = bvh.memory_bytes();
        if args.tier == TierArg::Specialized
            && let Some(compilation) = compilation
        {
            compilation.join().expect("compilation does not panic");
            if let Some(Compilation {
                result: Err(error), ..
            }) = compiled.get()
            {
                bail!("{error:#}\n--tier interpreted renders without a compiler");
            }
        }
        let view = SceneView {
            buffers: plan.data.buffers(),
            traversal: &bvh,
        };
        let choose = || -> &dyn TileRenderer {
            match compiled.get() {
                Some(Compilation {
                    result: Ok(renderer),
                    ..
                }) => {
                    let samples = samples_done.load(Ordering::Relaxed);
                    compiled_from.fetch_min(samples, Ordering::Relaxed);
                    renderer
                }
                _ => &interpreter,
            }
        };
        let show = |progress: residual_device_cpu::Progress| {
            samples_done.store(progress.samples, Ordering::Relaxed);
            match options.samples {
                Some(_) => bar.set_position(u64::from(progress.samples)),
                None => bar.set_position(progress.elapsed.as_millis() as u64),
            }
            bar.set_message(format!("{} spp", progress.samples));
            if stop.load(Ordering::Relaxed) {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let cpu_before = cpu_seconds();
        done = Some(device.render(choose, &view, &options, show));
        render_cpu = cpu_before
            .zip(cpu_seconds())
            .map(|(before, after)| after - before);
        bar.finish_and_clear();
        // A compiler that still runs comes too late; one that failed is reported below.
        if compiled.get().is_none() {
            compiler.give_up();
        }
        let (film, report) = done.as_ref().expect("just rendered");
        let metadata = Metadata {
            scene: plan.name.clone(),
            samples: film.samples(),
            seconds: report.elapsed.as_secs_f64(),
            relmse: film.error().map(|error| error.relmse),
        };
        outputs
            .iter()
            .try_for_each(|path| output::write(path, film, &metadata))
    })?;
    let (film, report) = done.expect("rendered");

    let (tier, compile_time) = match compiled.get() {
        Some(Compilation {
            result: Ok(_),
            time,
        }) => {
            let used = compiled_from.load(Ordering::Relaxed) != u32::MAX;
            (if used { "specialized" } else { "interpreted" }, *time)
        }
        Some(Compilation {
            result: Err(error),
            time,
        }) => {
            if !compiler.was_given_up() {
                eprintln!(
                    "warning: the renderer could not be compiled; it was interpreted instead: {error:#}"
                );
            }
            ("interpreted", *time)
        }
        None => ("interpreted", Duration::ZERO),
    };
    let from = compiled_from.load(Ordering::Relaxed);
    let statistics = Statistics {
        plan: &plan,
        film: &film,
        report: &report,
        stages: Stages {
            load,
            bvh: bvh_time,
            compile: compile_time,
            total: start.elapsed(),
        },
        tier,
        lanes: lanes.count(),
        compiled_from: (from != u32::MAX).then_some(from),
        render_cpu,
        bvh_bytes,
    };
    if !args.quiet {
        summary(
            &film,
            &report.elapsed,
            &outputs,
            args,
            statistics.compiled_from,
        );
        if stop.load(Ordering::Relaxed) {
            eprintln!("stopped; the image is what there was by then");
        }
    }
    match args.stats {
        Some(StatsArg::Json) => println!("{}", statistics.json()),
        Some(StatsArg::Text) => print!("{}", statistics.text()),
        None => {}
    }
    Ok(())
}

/// Set by Ctrl-C, after which the pass under way is finished and the image is written. A second Ctrl-C ends the program.
fn stop_on_interrupt() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        eprintln!("\nstopping after this pass; Ctrl-C again to lose the image");
    })
    .context("listening for Ctrl-C")?;
    Ok(stop)
}

/// The best hierarchy takes 6 s for a million triangles and saves a tenth of the tracing; the next takes less than 1 s.
pub(crate) fn quality(triangles: usize) -> BuildQuality {
    match triangles {
        0..=150_000 => BuildQuality::Best,
        150_001..=10_000_000 => BuildQuality::High,
        _ => BuildQuality::Medium,
    }
}

/// A compiled renderer, or why there is none, and how long that took.
struct Compilation {
    result: Result<LoadedRenderer>,
    time: Duration,
}

impl Compilation {
    fn run(compiler: &Compiler, plan: &Plan, lanes: LaneCount) -> Self {
        let start = Instant::now();
        let result = compiler.compile(plan, lanes);
        Self {
            result,
            time: start.elapsed(),
        }
    }
}

/// The files to be written, checked.
fn outputs(args: &RenderArgs) -> Result<Vec<PathBuf>> {
    let outputs = if args.output.is_empty() {
        // Not `with_extension`: a name may have dots of its own.
        let mut name = args.scene.scene.file_stem().unwrap_or_default().to_owned();
        name.push(".png");
        vec![PathBuf::from(name)]
    } else {
        args.output.clone()
    };
    outputs.iter().try_for_each(|path| output::check(path))?;
    Ok(outputs)
}

fn progress_bar(args: &RenderArgs, options: &RenderOptions) -> ProgressBar {
    if args.quiet {
        return ProgressBar::hidden();
    }
    // By samples where their number is known, else by milliseconds of the time limit.
    let length = match (options.samples, options.time) {
        (Some(samples), _) => u64::from(samples),
        (None, Some(time)) => time.as_millis() as u64,
        (None, None) => 0,
    };
    let style =
        ProgressStyle::with_template("{bar:40} {percent:>3} % {msg}, {elapsed} gone, {eta} left");
    ProgressBar::new(length).with_style(style.expect("the template is valid"))
}

fn summary(
    film: &Film,
    elapsed: &Duration,
    outputs: &[PathBuf],
    args: &RenderArgs,
    from: Option<u32>,
) {
    let files: Vec<_> = outputs
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let seconds = elapsed.as_secs_f64();
    eprintln!(
        "{}: {} samples per pixel in {seconds:.2} s",
        files.join(", "),
        film.samples()
    );
    if let Some(error) = film.error() {
        // Relative RMS error; it halves in four times the time.
        let (error, ci) = (error.relmse, error.ci95);
        eprintln!(
            "relative mean squared error {error:.2e} ± {ci:.1e}; a quarter of it: 4.0× the time, {:.0} s",
            4.0 * seconds
        );
    }
    if args.tier == TierArg::Auto
        && let Some(samples) = from
    {
        eprintln!("compiled renderer used after {samples} samples per pixel");
    }
    if film.invalid_samples() > 0 {
        eprintln!(
            "warning: {} samples were not finite and counted as black; please report this",
            film.invalid_samples()
        );
    }
}
