//! Every model of the shared materials is rendered without a panic and without an invalid sample.

use std::path::Path;

use rayon::prelude::*;
use residual_device_cpu::LaneCount;
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::pictures::mean;
use residual_tests::{Look, Prepared, read_scene, scene_files, scenes};

const SIZE: [u32; 2] = [32, 24];

fn renders(path: &Path) {
    let name = path.display();
    let scene = read_scene(path, None).unwrap_or_else(|error| panic!("{error}"));
    let plan = plan(
        &scene,
        &PlanOptions {
            size: SIZE,
            ..PlanOptions::default()
        },
    )
    .unwrap();
    let film = Prepared::new(&plan, LaneCount::native()).interpret(&Look::new(SIZE, 4));
    assert_eq!(film.invalid_samples(), 0, "{name}");
    let mean = mean(&film.image());
    assert!(
        mean.iter().all(|c| c.is_finite() && *c > 0.0),
        "{name}: mean {mean:?}"
    );
    println!("{name}: mean {mean:.3?}");
}

#[test]
fn every_model_renders() {
    let Some(scenes) = scenes() else { return };
    let models = scene_files(&scenes.join("materials"));
    assert!(models.len() >= 27);
    // Importing keeps one processor busy.
    models.par_iter().for_each(|model| renders(model));
}
