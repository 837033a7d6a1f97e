//! Renders the Cornell box into a texture of this program's own GPU device:
//! `residual-example-embed-wgpu [IMAGE.png]`.

mod settings;
mod texture;

use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result};
use residual_bvh::{BuildQuality, build};
use residual_device_wgpu::wgpu::{self, Backends};
use residual_device_wgpu::{Gpu, KernelSet, Mode, WgpuRenderer};
use residual_render::film::{Film, SampleSet, TILE_SIZE};
use residual_render::passes::{RenderOptions, render_passes};
use residual_render::texture::srgb_code;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::plan;

/// What the build script emitted.
const KERNELS: &str = include_str!(concat!(env!("OUT_DIR"), "/kernels.wgsl"));
const STRUCTURE: &str = env!("STRUCTURE");

fn main() -> Result<()> {
    let output = std::env::args_os()
        .nth(1)
        .unwrap_or_else(|| "cornell-box.png".into());
    // The data of the scene, which must be that of the kernels.
    let scene = import(Path::new(settings::SCENE), &ImportOptions::default())?;
    let options = settings::plan_options();
    let plan = plan(&scene, &options)?;
    plan.check_structure(STRUCTURE.parse()?)?;
    let kernels: KernelSet = KERNELS.parse().map_err(anyhow::Error::msg)?;

    // A device as any program has one: nothing is asked for beyond the defaults.
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapters = pollster::block_on(instance.enumerate_adapters(Backends::PRIMARY));
    let adapter = adapters.first().context("there is no graphics adapter")?;
    let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
    let gpu = Gpu::from_device(device.clone(), queue.clone(), adapter);

    let (positions, triangles) = (plan.data.positions(), plan.data.triangles());
    let sides = &plan.data.single_sided[..];
    let sides = sides.contains(&true).then_some(sides);
    let bvh = build::<4, 4>(&positions, &triangles, sides, BuildQuality::Best);
    let renderer =
        WgpuRenderer::with_kernels(&gpu, Mode::Plain, &kernels, &plan.data, &bvh, options.size)?;
    let job = RenderOptions {
        size: options.size,
        samples: Some(32),
        ..RenderOptions::default()
    };
    let [width, height] = options.size;
    let mut film = Film::new(width, height, TILE_SIZE, kernels.layers);
    let pass = |film: &mut Film, pass| {
        renderer.pass(film.tiles_mut(), pass, &job.tracer(SampleSet::First))
    };
    let (report, outcome) = render_passes(&job, &mut film, pass, |_| ControlFlow::Continue(()));
    outcome?;

    let texture = texture::upload(&device, &queue, &film);
    let pixels = texture::download(&device, &queue, &texture)?;
    let codes = pixels
        .iter()
        .flat_map(|[r, g, b, _]| [r, g, b].map(|&c| srgb_code(c)));
    let image =
        image::RgbImage::from_raw(width, height, codes.collect()).expect("three bytes a pixel");
    image
        .save(&output)
        .with_context(|| format!("writing {}", output.display()))?;
    println!(
        "{}: {}, {:.2} s",
        output.display(),
        gpu.adapter,
        report.elapsed.as_secs_f64()
    );
    Ok(())
}
