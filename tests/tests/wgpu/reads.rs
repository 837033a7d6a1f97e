//! Kernels are loaded without checks of bounds, on trust: no function of any scene reads beyond a buffer. Here every function
//! is run as it is printed and every read looked at; and the image that comes of it is the processor's, so that what was looked
//! at is what renders. No adapter is needed.

use residual_render::domain::{Buffer, Buffers};
use residual_render::film::{Film, SampleSet};
use residual_render::layer::Layer;
use residual_render::passes::RenderOptions;
use residual_render::tracer::{DebugView, PathOrigin, TracerNode};
use residual_scenegen::plan::PlanOptions;
use residual_tests::{Look, fixtures, tiny};
use residual_wgsl::SceneFunctions;

use crate::recorded::{Reads, Recording};
use crate::subject::{Subject, difference, for_each_shared};

/// Renders what is recorded of a plan, with these buffers.
fn render(Subject { plan, bvh }: &Subject, buffers: Buffers<'_>, look: &Look) -> (Film, Reads) {
    let reads = Reads::default();
    let options = RenderOptions {
        size: look.size,
        max_depth: look.max_depth,
        seed: look.seed,
        reach: look.reach,
        ..RenderOptions::default()
    };
    let functions = |origin| SceneFunctions::of(&plan.structure, origin);
    let has_light_paths = plan.structure.tracer.has_light_paths();
    let of_lights = has_light_paths.then(|| functions(PathOrigin::Lights));
    let recording = Recording {
        functions: &functions(PathOrigin::Camera),
        of_lights: of_lights.as_ref(),
        layers: plan.structure.layers,
        buffers,
        traversal: bvh,
        options: options.tracer(SampleSet::First),
        reads: &reads,
    };
    let film = recording.film(look.samples);
    (film, reads)
}

/// Nothing is read beyond a buffer, and the image is the processor's.
fn check(subject: &Subject, look: &Look) {
    let plan = &subject.plan;
    let (film, reads) = render(subject, plan.data.buffers(), look);
    let name = &plan.name;
    assert!(reads.of(Buffer::Camera) > 0, "{name}: nothing is read");
    let beyond = reads.beyond();
    assert!(
        beyond.is_empty(),
        "{name}: {} reads, the first {}",
        beyond.len(),
        beyond[0]
    );
    let expected = subject.on_cpu(look);
    assert_eq!(difference(&expected, &film), None, "{name}");
}

#[test]
fn tiny_scenes_are_read_within_bounds() {
    for tiny in tiny::all() {
        check(&Subject::new(tiny.plan()), &Look::new(tiny::SIZE, 2));
    }
}

#[test]
fn tracers_and_layers_read_within_bounds() {
    let views = DebugView::ALL.into_iter();
    let views = views.filter(|&view| view != DebugView::TraversalCost);
    let tracers = [TracerNode::default(), TracerNode::AmbientOcclusion];
    let size = [21, 15];
    for tracer in tracers.into_iter().chain(views.map(TracerNode::Debug)) {
        for scene in [fixtures::textures(), fixtures::room(), fixtures::lights()] {
            let options = PlanOptions {
                size,
                tracer,
                layers: Layer::ALL.into_iter().collect(),
                ..PlanOptions::default()
            };
            let look = Look {
                reach: 2.0,
                ..Look::new(size, 2)
            };
            check(&Subject::of(&scene, &options), &look);
        }
    }
}

#[test]
fn paths_from_both_ends_read_within_bounds() {
    for tiny in tiny::all() {
        let subject = Subject::from_both_ends(&tiny.scene, &tiny.options);
        check(&subject, &Look::new(tiny::SIZE, 1));
    }
}

#[test]
fn shared_scenes_are_read_within_bounds() {
    let look = Look::new([24; 2], 1);
    for (folder, at_least) in [("interiors", 7), ("materials", 25)] {
        for_each_shared(folder, at_least, 1, look.size, |subject| {
            check(&subject, &look)
        });
    }
}

/// Reads beyond a buffer are found, whatever the buffer.
#[test]
fn short_buffers_are_found_out() {
    let look = Look::new([21, 15], 1);
    let options = PlanOptions {
        size: look.size,
        layers: Layer::ALL.into_iter().collect(),
        ..PlanOptions::default()
    };
    let mut cut = 0;
    for scene in [fixtures::textures(), fixtures::lights()] {
        let subject = Subject::of(&scene, &options);
        let plan = &subject.plan;
        let (_, reads) = render(&subject, plan.data.buffers(), &look);
        for short in Buffer::ALL
            .into_iter()
            .filter(|&buffer| reads.of(buffer) > 0)
        {
            let words = Buffer::ALL.map(|buffer| {
                let words = plan.data.buffer(buffer);
                match buffer == short {
                    true => &words[..words.len() / 2],
                    false => words,
                }
            });
            let (_, reads) = render(&subject, Buffers::new(words), &look);
            let beyond = reads.beyond();
            assert!(!beyond.is_empty(), "half of {short:?} is not missed");
            let name = format!("in {short:?}");
            assert!(beyond[0].ends_with(&name), "{}", beyond[0]);
            cut += 1;
        }
    }
    assert!(cut > Buffer::COUNT, "{cut} buffers");
}
