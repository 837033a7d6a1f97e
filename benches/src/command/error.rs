//! `cargo xtask bench error`: what accuracy costs, ours and Mitsuba's.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use anyhow::{Context, Result, ensure};
use residual_device_cpu::plugin::LoadedRenderer;
use residual_device_cpu::{
    AnyBvh, CpuDevice, Interpreter, LaneCount, SceneView, TileRenderer, Width,
};
use residual_driver::compile;
use residual_frontend::pictures::{Picture, write};
use residual_frontend::{hierarchy_quality, output};
use residual_render::sampler::AnySampler;
use residual_render::texture::srgb_code;
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::{EnvironmentOptions, ImportOptions, import};
use residual_scenegen::plan::{BodyRule, CullingRule, Plan, PlanOptions, plan};

use super::args::{ErrorArgs, PeerArg, TierArg};
use super::scenes::scenes_or_own;
use crate::efficiency::{
    Agreement, Contender, Peer, PeerSampler, Pool, Residual, Series, Started, rounds, rows, table,
};
use crate::mitsuba;

pub(super) fn run(args: &ErrorArgs) -> Result<()> {
    for path in scenes_or_own(&args.scene)? {
        measure(&path, args).with_context(|| path.display().to_string())?;
    }
    Ok(())
}

fn measure(path: &Path, args: &ErrorArgs) -> Result<()> {
    let scene = lit_scene(path, args.env.as_deref())?;
    let samples: Vec<u32> = BTreeSet::from_iter(args.spp.iter().copied())
        .into_iter()
        .collect();
    let plans = args
        .sampler
        .iter()
        .map(|&sampler| Ok(plan(&scene, &plan_options(sampler, args))?))
        .collect::<Result<Vec<_>>>()?;
    let renderers = plans
        .iter()
        .map(|plan| Renderer::of(plan, args.tier))
        .collect::<Result<Vec<_>>>()?;
    // What samplers differ in is not in the data.
    let data = &plans.first().context("there is no sampler")?.data;
    let quality = hierarchy_quality(data.triangle_count());
    let bvh = AnyBvh::build(data, Width::Native, quality);
    let device = CpuDevice::new(args.threads).context("starting threads")?;
    let mut contenders: Vec<Box<dyn Contender + '_>> = Vec::new();
    let own = plans.iter().zip(&renderers).zip(&args.sampler);
    for (((plan, renderer), &sampler), &sampling) in
        own.flat_map(|own| args.sampling.iter().map(move |sampling| (own, sampling)))
    {
        contenders.push(Box::new(Residual {
            tier: args.tier.name(),
            sampler: sampler_name(sampler),
            sampling,
            device: &device,
            renderer: renderer.tiles(),
            view: SceneView {
                buffers: plan.data.buffers(),
                traversal: &bvh,
            },
            size: args.size.0,
            max_depth: args.max_depth,
        }));
    }
    let folder = tempfile::tempdir()?;
    let peer = start_peer(&scene, args, folder.path())?;
    let peers = peer.into_iter().flat_map(PeerSampler::all);
    contenders.extend(peers.map(|peer| Box::new(peer) as Box<dyn Contender>));
    let name = &plans[0].name;
    let progress = |done| eprintln!("{name}: {done} of {} rounds", args.runs);
    let all = rounds(&mut contenders, &samples, args.runs, progress)?;
    report(name, &all, args)
}

/// A scene as the command line lights it: by an environment, if there is one, and in the studio where nothing else shines.
fn lit_scene(path: &Path, environment: Option<&Path>) -> Result<SceneDesc> {
    let environment = environment.map(|path| EnvironmentOptions {
        path: path.to_owned(),
        strength: 1.0,
        rotation_degrees: 0.0,
    });
    let options = ImportOptions {
        environment,
        ..ImportOptions::default()
    };
    let mut scene = import(path, &options)?;
    if scene.is_unlit() {
        scene.add_studio();
    }
    Ok(scene)
}

/// As in [`mitsuba`], where both sides of every surface block light, and whoever leaves a body is outside.
fn plan_options(sampler: AnySampler, args: &ErrorArgs) -> PlanOptions {
    PlanOptions {
        size: args.size.0,
        sampler,
        culling: CullingRule::None,
        bodies: BodyRule::Beside,
        ..PlanOptions::default()
    }
}

/// What renders tiles.
enum Renderer {
    Interpreted(Interpreter),
    Specialized(LoadedRenderer),
}

impl Renderer {
    fn of(plan: &Plan, tier: TierArg) -> Result<Self> {
        Ok(match tier {
            TierArg::Interpreted => Self::Interpreted(Interpreter::new(plan.structure.clone())),
            TierArg::Specialized => Self::Specialized(compile(plan, LaneCount::native())?),
        })
    }

    fn tiles(&self) -> &dyn TileRenderer {
        match self {
            Self::Interpreted(renderer) => renderer,
            Self::Specialized(renderer) => renderer,
        }
    }
}

fn sampler_name(sampler: AnySampler) -> &'static str {
    match sampler {
        AnySampler::Sobol => "sobol",
        AnySampler::Independent => "independent",
    }
}

/// Mitsuba with the scene, which is exported into `folder`. Without it, or if the scene cannot be exported, there is a line on
/// standard error, and no peer.
fn start_peer(scene: &SceneDesc, args: &ErrorArgs, folder: &Path) -> Result<Option<Peer>> {
    if args.peer == PeerArg::None {
        return Ok(None);
    }
    let options = plan_options(AnySampler::Sobol, args);
    if let Err(error) = mitsuba::export(scene, &options, args.max_depth, folder) {
        eprintln!("without Mitsuba: {error:#}");
        return Ok(None);
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("peers/mitsuba_error.py");
    let mut command = Command::new(&args.python);
    command.arg(script).arg(folder);
    command.arg(args.threads.to_string());
    command.args(&args.variant);
    let pixels = args.size.0.map(|length| length as usize);
    match Peer::start(&mut command, pixels[0] * pixels[1])? {
        Started::Ready(peer) => {
            let notes = &peer.hello().notes;
            notes.iter().for_each(|note| eprintln!("Mitsuba: {note}"));
            Ok(Some(peer))
        }
        Started::Missing(reason) => {
            eprintln!("without Mitsuba: {reason}");
            Ok(None)
        }
    }
}

fn report(scene: &str, all: &[Series], args: &ErrorArgs) -> Result<()> {
    let rows = rows(scene, Residual::NAME, all);
    let (ours, theirs): (Vec<_>, Vec<_>) = all
        .iter()
        .partition(|series| series.label.renderer == Residual::NAME);
    let peer = theirs.first().map(|series| series.label.renderer.as_str());
    let ours = Pool::of(ours);
    let theirs = peer.map(|_| Pool::of(theirs));
    let names = [Residual::NAME, peer.unwrap_or_default()];
    let agreement = theirs
        .as_ref()
        .map(|theirs| Agreement::of(scene, names, [&ours, theirs]));
    if args.json {
        rows.iter().for_each(|row| println!("{}", row.to_json()));
        agreement.iter().for_each(|a| println!("{}", a.to_json()));
    } else {
        println!(
            "{scene}, {} x {} pixels, paths of at most {} vertices, {} images each, threads: {}\n\n{}",
            args.size.0[0],
            args.size.0[1],
            args.max_depth,
            args.runs,
            args.threads,
            table(&rows)
        );
        agreement.iter().for_each(|a| println!("{}", a.to_text()));
    }
    if let Some(folder) = &args.pictures {
        for (name, pool) in names.into_iter().zip([Some(&ours), theirs.as_ref()]) {
            if let Some(pool) = pool {
                write_picture(folder, &format!("{scene}-{name}"), pool, args.size.0)?;
            }
        }
    }
    let difference = agreement.map_or(0.0, |agreement| agreement.difference());
    ensure!(
        difference <= Agreement::TOLERABLE,
        "the converged means differ by {:.1} %: the renderers do not render the same scene",
        100.0 * difference
    );
    Ok(())
}

/// The converged image as PNG and EXR.
fn write_picture(folder: &Path, stem: &str, pool: &Pool<'_>, size: [u32; 2]) -> Result<()> {
    let image = pool.image();
    let channel = |k: usize| image.iter().map(|pixel| pixel[k]).collect();
    let picture = Picture {
        size: size.map(|length| length as usize),
        colors: image.iter().map(|pixel| pixel.map(srgb_code)).collect(),
        channels: vec![("R", channel(0)), ("G", channel(1)), ("B", channel(2))],
        comment: Some(format!("mean of renders by {stem}")),
    };
    for extension in ["png", "exr"] {
        let path = folder.join(format!("{stem}.{extension}"));
        output::check(&path)?;
        write(&path, &picture).with_context(|| path.display().to_string())?;
    }
    Ok(())
}
