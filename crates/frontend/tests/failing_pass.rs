//! A device may fail in the middle of a render. A test of its own program, since a process listens for Ctrl-C once.

use std::ffi::OsStr;

use anyhow::bail;
use residual_frontend::display::ToneMap;
use residual_frontend::options::{RenderArgs, SceneDefaults};
use residual_frontend::session::{Session, Subject};
use residual_render::film::{Film, Sampling};
use residual_render::layer::Layers;
use residual_render::passes::{Counters, Pass};

const SIZE: [u32; 2] = [4, 3];

#[test]
fn what_there_was_before_is_written_and_the_failure_told() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("image.png");
    let args = RenderArgs {
        exposure: None,
        tonemap: ToneMap::default(),
        output: vec![image.clone()],
        spp: Some(8),
        time: None,
        error: None,
        adaptive: None,
        max_depth: Some(8),
        roulette: 5,
        seed: 0,
        reach: None,
        threads: 1,
        stats: None,
        quiet: true,
    };
    let session = Session::new(&args, OsStr::new("scene"), Layers::NONE).unwrap();
    let options = args.render_options(
        SIZE,
        SceneDefaults {
            max_depth: 8,
            reach: 1.0,
        },
        Sampling::Uniform,
    );
    let pass = |film: &mut Film, pass: Pass| {
        if pass.first > 0 {
            bail!("the device was lost");
        }
        let samples = vec![0.5; film.tiles_mut()[0].rect().area() * Layers::RADIANCE];
        film.tiles_mut()[0].add(&samples);
        Ok(Counters::default())
    };
    let subject = Subject {
        name: "scene",
        layers: Layers::NONE,
        manifests: &[],
    };
    let rendered = session.render(subject, &options, pass, |_| ());
    let error = format!("{:#}", rendered.err().expect("a failure"));
    assert!(error.contains("the device was lost"), "{error}");
    assert!(error.contains("1 samples per pixel"), "{error}");
    assert!(image.exists());
}
