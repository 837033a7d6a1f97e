//! Renders the Cornell box with a renderer that was compiled in: `residual-example-embed [IMAGE.png]`.

use std::ops::ControlFlow;
use std::path::Path;

use anyhow::{Context, Result};
use residual_bvh::BuildQuality;
use residual_device_cpu::{AnyBvh, CpuDevice, SceneView, Width};
use residual_render::passes::RenderOptions;
use residual_render::texture::srgb_code;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::plan;

mod settings;

/// What the build script generated: the types `Scene` and `Compiled`.
#[allow(
    unreachable_pub,
    reason = "it may as well be included in a public module"
)]
mod renderer {
    include!(concat!(env!("OUT_DIR"), "/residual_scene.rs"));
}
use renderer::{Compiled, Scene};

fn main() -> Result<()> {
    let output = std::env::args_os()
        .nth(1)
        .unwrap_or_else(|| "cornell-box.png".into());
    let scene = import(Path::new(settings::SCENE), &ImportOptions::default())?;
    let options = settings::plan_options();
    let plan = plan(&scene, &options)?;
    plan.check_structure(Scene::STRUCTURE)?;

    let bvh = AnyBvh::build(&plan.data, Width::Native, BuildQuality::Best);
    let view = SceneView {
        buffers: plan.data.buffers(),
        traversal: &bvh,
    };
    let job = RenderOptions {
        size: options.size,
        samples: Some(32),
        time: None,
        max_depth: 8,
        seed: 0,
        ..RenderOptions::default()
    };
    let device = CpuDevice::new(0)?;
    let (film, report) = device.render(|| &Compiled, &view, &job, |_| ControlFlow::Continue(()));

    let pixels = film
        .image()
        .into_iter()
        .flat_map(|rgb| rgb.map(srgb_code))
        .collect();
    let image = image::RgbImage::from_raw(film.width(), film.height(), pixels)
        .expect("three bytes a pixel");
    image
        .save(&output)
        .with_context(|| format!("writing {}", output.display()))?;
    let [r, g, b] = film.mean();
    println!(
        "{}: mean {r:.4} {g:.4} {b:.4}, {:.2} s",
        output.display(),
        report.elapsed.as_secs_f64()
    );
    Ok(())
}
