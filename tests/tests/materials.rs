//! Every model of the shared materials is rendered without a panic and without an invalid sample, or refused for a
//! stated reason.

use residual_device_cpu::LaneCount;
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::pictures::mean;
use residual_tests::{Look, Prepared, read_scene, scene_files, scenes};

/// Files that require what is not supported, and the extension that their error names.
const REFUSED: &[(&str, &str)] = &[
    ("BoxMeshopt.glb", "EXT_meshopt_compression"),
    (
        "14_emission_strength.gltf",
        "KHR_materials_pbrSpecularGlossiness",
    ),
];

#[test]
fn every_model_renders_or_names_its_extension() {
    let Some(scenes) = scenes() else { return };
    let size = [32, 24];
    let (mut rendered, mut refused) = (0, 0);
    for path in scene_files(&scenes.join("materials")) {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let expected = REFUSED.iter().find(|(refused, _)| *refused == name);
        let scene = match (read_scene(&path, None), expected) {
            (Ok(scene), None) => scene,
            (Err(error), Some((_, extension))) => {
                assert!(error.to_string().contains(extension), "{error}");
                refused += 1;
                continue;
            }
            (Ok(_), Some(_)) => panic!("{name} is not refused any more; adapt this test"),
            (Err(error), None) => panic!("{error}"),
        };
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
    println!("{rendered} rendered, {refused} refused");
    assert!(rendered >= 25 && refused == REFUSED.len());
}
