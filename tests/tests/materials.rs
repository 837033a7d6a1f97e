//! Every model of the shared materials is rendered without a panic and without an invalid sample.

use residual_device_cpu::LaneCount;
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::pictures::mean;
use residual_tests::{Look, Prepared, read_scene, scene_files, scenes};

#[test]
fn every_model_renders() {
    let Some(scenes) = scenes() else { return };
    let size = [32, 24];
    let mut rendered = 0;
    for path in scene_files(&scenes.join("materials")) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let scene = read_scene(&path, None).unwrap_or_else(|error| panic!("{error}"));
        let plan = plan(
            &scene,
            &PlanOptions {
                size,
                ..PlanOptions::default()
            },
        )
        .unwrap();
        let film = Prepared::new(&plan, LaneCount::native()).interpret(&Look::new(size, 4));
        assert_eq!(film.invalid_samples(), 0, "{name}");
        let mean = mean(&film.image());
        assert!(
            mean.iter().all(|c| c.is_finite() && *c > 0.0),
            "{name}: mean {mean:?}"
        );
        println!("{name}: mean {mean:.3?}");
        rendered += 1;
    }
    println!("{rendered} rendered");
    assert!(rendered >= 27);
}
