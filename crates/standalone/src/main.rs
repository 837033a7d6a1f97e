//! The program of a single scene, which carries its renderer and its data: what `cargo xtask build` makes.

use std::convert::Infallible;
use std::ffi::OsStr;
use std::process::ExitCode;
use std::time::Instant;

use anyhow::{Context, Result};
use clap::Parser;
use residual_device_cpu::{AnyBvh, CpuDevice, LaneCount, SceneView, TileRenderer, Width};
use residual_frontend::cryptomatte::Manifest;
use residual_frontend::hierarchy_quality;
use residual_frontend::options::{EvenOnly, RenderArgs, SceneDefaults, Size};
use residual_frontend::session::{Session, Subject};
use residual_frontend::stats::{DeviceReport, Preparation, SceneSummary, Statistics, TierReport};
use residual_render::camera::set_aspect;
use residual_render::scene_data::SceneData;

/// The renderer and the data.
#[allow(
    unreachable_pub,
    reason = "emitted code may as well be included in a public module"
)]
mod scene {
    include!(env!("RESIDUAL_EMITTED_CODE"));
}

/// A scene as its program carries it.
struct StandaloneScene {
    /// Its name.
    name: &'static str,
    /// Width and height of the image, unless told otherwise.
    size: [u32; 2],
    /// How many material programs there are.
    programs: usize,
    /// No sample can be brighter than white.
    is_bounded: bool,
    /// The effects that are in.
    effects: &'static [&'static str],
    /// The layers of Cryptomatte by their names, each with the names behind its ids.
    manifests: &'static [(&'static str, &'static [&'static str])],
    /// What [`SceneData::to_bytes`] wrote.
    data: &'static [u8],
    /// The renderer.
    renderer: &'static (dyn TileRenderer + Sync),
    /// What its tracer does unless told otherwise.
    defaults: SceneDefaults,
    /// Paths that it shades at once.
    lanes: LaneCount,
}

/// Renders the one scene that is in this program
#[derive(Parser)]
#[command(version)]
struct Args {
    #[command(flatten)]
    render: RenderArgs,
    /// Width and height of the image in pixels [default: as built]
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
}

/// Status 0, 1 for a failed job, 2 for bad usage.
fn main() -> ExitCode {
    let args = Args::parse();
    let scene = scene::SCENE
        .context("no scene is in this program; cargo xtask build SCENE -o FILE makes one");
    match scene.and_then(|scene| run(&scene, &args)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(scene: &StandaloneScene, args: &Args) -> Result<()> {
    let even_only = EvenOnly::of_processor(scene.renderer.has_light_paths());
    let sampling = args.render.sampling(even_only)?;
    let session = Session::new(
        &args.render,
        OsStr::new(scene.name),
        scene.renderer.layers(),
    )?;
    let mut data = SceneData::from_bytes(scene.data)?;
    let size = args.size.map_or(scene.size, |size| size.0);
    if size != scene.size {
        set_aspect(&mut data, size[0] as f32 / size[1] as f32);
    }
    let load = session.start.elapsed();
    let bvh_start = Instant::now();
    let quality = hierarchy_quality(data.triangle_count());
    let bvh = AnyBvh::build(&data, Width::Native, quality);
    let preparation = Preparation {
        load,
        bvh: bvh_start.elapsed(),
        ..Preparation::default()
    };
    let device = CpuDevice::new(args.render.threads).context("starting threads")?;
    let view = SceneView {
        buffers: data.buffers(),
        traversal: &bvh,
    };
    let options = args.render.render_options(size, scene.defaults, sampling);
    let manifests = scene.manifests.iter();
    let manifests = manifests.map(|&(layer, names)| Manifest {
        layer: layer.parse().expect("a layer"),
        names: names.iter().map(ToString::to_string).collect(),
    });
    let subject = Subject {
        name: scene.name,
        layers: scene.renderer.layers(),
        manifests: &manifests.collect::<Vec<_>>(),
    };
    let rendered = session.render(
        subject,
        &options,
        |film, pass| Ok::<_, Infallible>(device.pass(scene.renderer, &view, &options, film, pass)),
        |_| (),
    )?;
    let summary = SceneSummary {
        name: scene.name.to_owned(),
        triangles: data.triangle_count(),
        programs: scene.programs,
        effects: scene.effects.iter().map(ToString::to_string).collect(),
        bytes: data.memory_bytes(),
        is_bounded: scene.is_bounded,
    };
    session.finish(&Statistics {
        scene: &summary,
        rendered: &rendered,
        device: DeviceReport::Cpu,
        threads: device.threads(),
        preparation,
        total: session.start.elapsed(),
        tiers: TierReport {
            tier: "specialized",
            compiled_from: Some(0),
            break_even: None,
        },
        lanes: scene.lanes.count(),
        bvh_bytes: bvh.memory_bytes(),
    });
    Ok(())
}
