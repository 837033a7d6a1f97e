//! The compiled-in renderer is the interpreter's equal, generated the same every time, and refuses foreign data.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::Command;

use residual_bvh::BuildQuality;
use residual_device_cpu::{AnyBvh, CpuDevice, Interpreter, SceneView, TileRenderer, Width};
use residual_render::film::Film;
use residual_render::passes::RenderOptions;
use residual_render::sampler::AnySampler;
use residual_scenegen::emit::rust;
use residual_scenegen::import::{ImportOptions, import};
use residual_scenegen::plan::{Binding, CullingRule, Plan, PlanOptions, plan};

#[path = "../src/settings.rs"]
mod settings;

#[allow(
    unreachable_pub,
    reason = "it may as well be included in a public module"
)]
mod renderer {
    include!(concat!(env!("OUT_DIR"), "/residual_scene.rs"));
}
use renderer::{Compiled, Scene};

const GENERATED: &str = include_str!(concat!(env!("OUT_DIR"), "/residual_scene.rs"));

fn planned(options: &PlanOptions) -> Plan {
    let scene = import(Path::new(settings::SCENE), &ImportOptions::default()).unwrap();
    assert_eq!(scene.warnings, []);
    plan(&scene, options).unwrap()
}

fn render(plan: &Plan, renderer: &dyn TileRenderer, threads: usize) -> Film {
    let bvh = AnyBvh::build(&plan.data, Width::Native, BuildQuality::Best);
    let view = SceneView {
        buffers: plan.data.buffers(),
        traversal: &bvh,
    };
    let job = RenderOptions {
        size: [96, 80],
        samples: Some(4),
        time: None,
        max_depth: 8,
        seed: 7,
        ..RenderOptions::default()
    };
    CpuDevice::new(threads)
        .unwrap()
        .render(|| renderer, &view, &job, |_| ControlFlow::Continue(()))
        .0
}

#[test]
fn compiled_in_and_interpreted_give_the_same_bits() {
    let plan = planned(&settings::plan_options());
    plan.check_structure(Scene::STRUCTURE).unwrap();
    let compiled = render(&plan, &Compiled, 2);
    let interpreted = render(&plan, &Interpreter::new(plan.structure.clone()), 1);
    let bits = |film: &Film| -> Vec<_> {
        film.image()
            .into_iter()
            .map(|rgb| rgb.map(f32::to_bits))
            .collect()
    };
    assert!(bits(&compiled) == bits(&interpreted));
    assert_eq!(compiled.invalid_samples(), 0);
    assert!(
        compiled.mean().iter().all(|&mean| mean > 0.05),
        "{:?}",
        compiled.mean()
    );
}

#[test]
fn the_build_script_wrote_what_is_emitted_now() {
    let lanes = format!("{:?}", Compiled::LANES);
    for _ in 0..2 {
        assert!(GENERATED == rust::module(&planned(&settings::plan_options()), &lanes));
    }
}

#[test]
fn data_of_another_structure_are_refused() {
    let others = [
        PlanOptions {
            binding: Binding::Constants,
            ..settings::plan_options()
        },
        PlanOptions {
            sampler: AnySampler::Independent,
            ..settings::plan_options()
        },
    ];
    for options in others {
        let error = planned(&options)
            .check_structure(Scene::STRUCTURE)
            .unwrap_err();
        assert_eq!(error.compiled, Scene::STRUCTURE);
        assert!(error.to_string().contains("compile again"), "{error}");
    }
    // What is data is free to change.
    let smaller = PlanOptions {
        size: [32, 32],
        ..settings::plan_options()
    };
    let two_sided = PlanOptions {
        culling: CullingRule::None,
        ..settings::plan_options()
    };
    for options in [smaller, two_sided] {
        planned(&options).check_structure(Scene::STRUCTURE).unwrap();
    }
}

#[test]
fn the_program_writes_its_image() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("image.png");
    let output = Command::new(env!("CARGO_BIN_EXE_residual-example-embed"))
        .arg(&path)
        .output()
        .unwrap();
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains("mean"));
    assert_eq!(
        image::open(&path).unwrap().to_rgb8().dimensions(),
        (512, 512)
    );
}
