//! Samples of the GPU have the processor's bits, where the adapter's arithmetic is exact. It rests on the same formulas in the
//! same order, on hits that do not depend on the hierarchy, and on samples that are added up in their order.

use residual_device_wgpu::Mapping;
use residual_render::layer::{Layer, Layers};
use residual_render::passes::MAX_PASS;
use residual_render::tracer::{DebugView, TracerNode};
use residual_scenegen::plan::PlanOptions;
use residual_tests::{Look, fixtures, tiny};

use crate::subject::{SCENES_OF_LAYERS, Subject, chamber, difference, for_each_shared};
use crate::{MAPPINGS, exact_machine};

/// The shared scenes of a folder, as a wavefront.
fn check_folder(folder: &str, at_least: usize) {
    let Some(machine) = exact_machine() else {
        return;
    };
    let look = Look::new([64; 2], 2);
    let check = |subject: Subject| {
        let programs = subject.plan.structure.programs.len();
        if programs > machine.most_programs() {
            println!("skipped: {}: {programs} programs", subject.plan.name);
        } else {
            subject.agrees(machine, Mapping::Wavefront, &look);
        }
    };
    for_each_shared(folder, at_least, machine.step(), look.size, check);
}

#[test]
fn interiors() {
    check_folder("interiors", 7);
}

#[test]
fn scenes_of_benchmarks() {
    check_folder("bench", 6);
}

#[test]
fn scenes_of_materials() {
    check_folder("materials", 25);
}

/// Every kind of surface, texture, light, camera and sampler. The size is no multiple of a block.
#[test]
fn tiny_scenes() {
    let Some(machine) = exact_machine() else {
        return;
    };
    for (index, tiny) in tiny::all().into_iter().enumerate() {
        let subject = Subject::new(tiny.plan());
        for &mapping in machine.mappings(index) {
            subject.agrees(machine, mapping, &Look::new(tiny::SIZE, 3));
        }
    }
}

/// Splats come back in any order, some at a time.
#[test]
fn paths_from_both_ends() {
    let Some(machine) = exact_machine() else {
        return;
    };
    let look = Look::new(tiny::SIZE, 3);
    // All steps are recorded and run elsewhere (`reads.rs`): these are of most kinds of lights, cameras and media.
    let names = [
        "matte",
        "spot_light",
        "spherical_point",
        "environment",
        "depth_of_field",
        "dielectric_coat",
        "drink",
        "prism",
    ];
    for (index, tiny) in names.map(tiny::named).into_iter().enumerate() {
        let subject = Subject::from_both_ends(&tiny.scene, &tiny.options);
        for &mapping in machine.mappings(index) {
            subject.agrees(machine, mapping, &look);
        }
    }
    // More paths than have their splats in memory at a time (a pass of the most samples), more splats of each than is likely, and
    // more vertices than between two looks.
    let options = PlanOptions {
        size: tiny::SIZE,
        ..PlanOptions::default()
    };
    let look = Look {
        max_depth: 20,
        ..Look::new(tiny::SIZE, MAX_PASS)
    };
    let subject = Subject::from_both_ends(&chamber(), &options);
    for mapping in MAPPINGS {
        subject.agrees(machine, mapping, &look);
    }
}

#[test]
fn paths_of_any_length() {
    let Some(machine) = exact_machine() else {
        return;
    };
    let size = [23, 17];
    let options = PlanOptions {
        size,
        ..PlanOptions::default()
    };
    let look = |max_depth| Look {
        max_depth,
        seed: 7,
        ..Look::new(size, 3)
    };
    let [chamber, lights] =
        [chamber(), fixtures::lights()].map(|scene| Subject::of(&scene, &options));
    let [shorter, longer] = [17, 20].map(|max_depth| chamber.on_cpu(&look(max_depth)));
    assert!(difference(&shorter, &longer).is_some(), "short paths");
    for subject in [chamber, lights] {
        for mapping in MAPPINGS {
            // The length of paths is no part of kernels.
            let renderer = subject.renderer(machine, machine.probe.dialect, mapping, size);
            // Between two looks at whether any path is left, the device takes sixteen vertices.
            for look in [1, 2, 16, 17, 20].map(look) {
                let cpu = subject.on_cpu(&look);
                let gpu = subject.passes(&renderer, &look, &[look.samples]);
                let name = &subject.plan.name;
                assert_eq!(difference(&cpu, &gpu), None, "{name}, {mapping}, {look:?}");
            }
        }
    }
}

/// Smaller than a block, as wide as one, one more.
#[test]
fn images_of_any_size() {
    let Some(machine) = exact_machine() else {
        return;
    };
    for size in [[1, 1], [3, 5], [8, 8], [65, 9], [7, 130]] {
        let options = PlanOptions {
            size,
            ..PlanOptions::default()
        };
        let subject = Subject::of(&tiny::plain().scene, &options);
        for mapping in MAPPINGS {
            subject.agrees(machine, mapping, &Look::new(size, 2));
        }
    }
}

/// More pixels than there may be paths under way (2²¹), so that a sample is put together from two launches. Depths tell all pixels
/// apart, and take no light to compute.
#[test]
fn a_sample_of_two_launches() {
    let Some(machine) = exact_machine() else {
        return;
    };
    let size = [1480, 1432];
    let options = PlanOptions {
        size,
        tracer: TracerNode::Debug(DebugView::Depth),
        ..PlanOptions::default()
    };
    let subject = Subject::of(&tiny::plain().scene, &options);
    for mapping in MAPPINGS {
        let look = Look {
            reach: 10.0,
            ..Look::new(size, 1)
        };
        subject.agrees(machine, mapping, &look);
    }
}

/// Every tracer, with all layers and without any. What traversal costs depends on the hierarchy, and is not compared here.
#[test]
fn tracers_and_layers() {
    let Some(machine) = exact_machine() else {
        return;
    };
    let views = DebugView::ALL.into_iter();
    let views = views
        .filter(|&view| view != DebugView::TraversalCost)
        .map(TracerNode::Debug);
    let tracers = [TracerNode::default(), TracerNode::AmbientOcclusion];
    let size = [37, 29];
    for (index, tracer) in tracers.into_iter().chain(views).enumerate() {
        let all = SCENES_OF_LAYERS
            .map(|name| (tiny::named(name).scene, Layer::ALL.into_iter().collect()));
        for (scene, layers) in all.into_iter().chain([(fixtures::lights(), Layers::NONE)]) {
            let options = PlanOptions {
                size,
                tracer,
                layers,
                ..PlanOptions::default()
            };
            let look = Look {
                reach: 2.0,
                ..Look::new(size, 3)
            };
            let subject = Subject::of(&scene, &options);
            for &mapping in machine.mappings(index) {
                subject.agrees(machine, mapping, &look);
            }
        }
    }
}

/// The heat map has colours of rays that visit something, and more than one.
#[test]
fn the_heat_map_is_of_visits() {
    let Some(machine) = exact_machine() else {
        return;
    };
    let look = Look::new([40, 30], 2);
    let options = PlanOptions {
        size: look.size,
        tracer: TracerNode::Debug(DebugView::TraversalCost),
        ..PlanOptions::default()
    };
    let subject = Subject::of(&fixtures::room(), &options);
    let films = MAPPINGS.map(|mapping| subject.on_gpu(machine, mapping, &look));
    assert_eq!(difference(&films[0], &films[1]), None);
    let mut colors: Vec<_> = films[0]
        .image()
        .into_iter()
        .map(|rgb| rgb.map(f32::to_bits))
        .collect();
    colors.sort_unstable();
    colors.dedup();
    assert!(colors.len() > 8, "{} colours", colors.len());
    // The processor's hierarchy is another, but no less or more than a few times as good.
    let [gpu, cpu] =
        [&films[0], &subject.on_cpu(&look)].map(|film| film.mean().iter().sum::<f64>());
    assert!(gpu > 0.3 * cpu && gpu < 3.0 * cpu, "{gpu} and {cpu}");
}

/// Neither a run nor the passes into which samples are divided show.
#[test]
fn runs_and_passes_do_not_show() {
    let Some(machine) = exact_machine() else {
        return;
    };
    let look = Look::new([21, 15], 4);
    let options = PlanOptions {
        size: look.size,
        layers: Layer::ALL.into_iter().collect(),
        ..PlanOptions::default()
    };
    let subject = Subject::of(&tiny::named("drink").scene, &options);
    for mapping in MAPPINGS {
        let renderer = subject.renderer(machine, machine.probe.dialect, mapping, look.size);
        let expected = subject.passes(&renderer, &look, &[4]);
        for groups in [&[4][..], &[1, 3], &[1; 4]] {
            let film = subject.passes(&renderer, &look, groups);
            assert_eq!(difference(&expected, &film), None, "{mapping}, {groups:?}");
        }
        let other = Look { seed: 1, ..look };
        let film = subject.passes(&renderer, &other, &[4]);
        assert!(difference(&expected, &film).is_some(), "seeds show");
    }
}
