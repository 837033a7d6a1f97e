//! `cargo xtask bench compile`: how soon a scene's renderer is ready, and how much code makes it.

use std::fs;
use std::path::Path;
use std::time::Instant;

use crate::code_size::{CodeRow, code_lines, code_sizes, code_table};
use crate::compile::{CompileRow, LibraryRow, compile_heading, compile_summary, validate_wgsl};
use crate::measure::children_time;
use anyhow::{Context, Result, ensure};
use residual_accuracy::Estimate;
use residual_device_cpu::LaneCount;
use residual_driver::cache::Cache;
use residual_driver::compile::{Compiler, Origin, library_source};
use residual_driver::workspace;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{Binding, Plan, PlanOptions, plan};

use super::args::CompileBenchArgs;
use super::scenes::scenes_or_own;

pub(super) fn run(args: &CompileBenchArgs) -> Result<()> {
    let mut rows = Vec::new();
    if !args.json {
        println!("{}", compile_heading());
    }
    for scene in scenes_or_own(&args.scene)? {
        for binding in [Binding::Structure, Binding::Constants] {
            for row in measure(&scene, binding, args.rounds)? {
                if args.json {
                    println!("{}", row.to_json());
                } else {
                    println!("{}", row.to_line());
                }
                rows.push(row);
            }
        }
    }
    let code = code_sizes(workspace::root())?;
    if args.json {
        code.iter()
            .for_each(|row: &CodeRow| println!("{}", row.to_json()));
    } else {
        println!("\n{}\n{}", compile_summary(&rows), code_table(&code));
    }
    Ok(())
}

/// Seconds of the rounds.
#[derive(Default)]
struct Times {
    plan: Vec<f64>,
    rust: Vec<f64>,
    compile: Vec<f64>,
    compile_cpu: Vec<f64>,
    cached: Vec<f64>,
    wgsl: Vec<f64>,
    validate: Vec<f64>,
}

/// The rows of a scene, one for each device.
fn measure(path: &Path, binding: Binding, rounds: u32) -> Result<[CompileRow; 2]> {
    let mut times = Times::default();
    let mut last = None;
    for _ in 0..rounds {
        let plan = timed(&mut times.plan, || load(path, binding))?;
        let compiled = compile(&plan, &mut times)?;
        let wgsl = timed(&mut times.wgsl, || {
            residual_wgsl::scene_module(&plan.structure)
        });
        timed(&mut times.validate, || validate_wgsl(&wgsl))
            .with_context(|| format!("the WGSL of {:?}", plan.name))?;
        last = Some((plan, compiled, wgsl));
    }
    let (plan, compiled, wgsl) = last.expect("there is a round");
    let row = |device, text: &str, emit, compile, library| CompileRow {
        scene: plan.name.clone(),
        device,
        binding: match binding {
            Binding::Structure => "structure",
            Binding::Constants => "constants",
        },
        programs: plan.structure.programs.len(),
        lines: code_lines(text),
        plan: Estimate::of(times.plan.clone()),
        emit: Estimate::of(emit),
        compile: Estimate::of(compile),
        library,
    };
    let has_cpu = !times.compile_cpu.is_empty();
    let library = LibraryRow {
        compile_cpu: has_cpu.then(|| Estimate::of(times.compile_cpu)),
        cached: Estimate::of(times.cached),
        bytes: compiled.bytes,
    };
    Ok([
        row(
            "cpu",
            &compiled.source,
            times.rust,
            times.compile,
            Some(library),
        ),
        row("wgpu", &wgsl, times.wgsl, times.validate, None),
    ])
}

fn timed<R>(times: &mut Vec<f64>, work: impl FnOnce() -> R) -> R {
    let start = Instant::now();
    let result = work();
    times.push(start.elapsed().as_secs_f64());
    result
}

fn load(path: &Path, binding: Binding) -> Result<Plan> {
    let scene = import(path, &ImportOptions::default())?;
    let options = PlanOptions {
        binding,
        ..PlanOptions::default()
    };
    plan(&scene, &options).with_context(|| path.display().to_string())
}

struct Compiled {
    source: String,
    /// Size of the library.
    bytes: u64,
}

/// Compiles a renderer that is in no cache, and loads it again from one that nobody else uses.
fn compile(plan: &Plan, times: &mut Times) -> Result<Compiled> {
    let lanes = LaneCount::native();
    let source = timed(&mut times.rust, || library_source(plan, lanes));
    let parent = workspace::own_directory();
    fs::create_dir_all(&parent).with_context(|| format!("creating {}", parent.display()))?;
    let directory = tempfile::tempdir_in(&parent)?;
    let cache = Cache::at(&directory.path().join("first"));
    let compiler = Compiler::new(cache.clone());
    compiler.build_dependencies()?;
    let before = children_time();
    let compiled = timed(&mut times.compile, || {
        compiler.compile_source(&source, lanes)
    })?;
    let cpu = children_time().zip(before);
    times
        .compile_cpu
        .extend(cpu.map(|(after, before)| (after - before).as_secs_f64()));

    // A copy, since the system knows a library that it has loaded once.
    let key = Cache::key(&source)?;
    let library = cache
        .find(&key, &source)
        .context("it was compiled just now")?;
    let bytes = fs::metadata(&library)?.len();
    let copy = Cache::at(&directory.path().join("copy"));
    copy.keep(&key, &source, &library)?;
    let compiler = Compiler::new(copy);
    let cached = timed(&mut times.cached, || {
        compiler.compile_source(&source, lanes)
    })?;
    ensure!(
        (compiled.1, cached.1) == (Origin::Compiled, Origin::Cached),
        "the cache does not work"
    );
    Ok(Compiled { source, bytes })
}
