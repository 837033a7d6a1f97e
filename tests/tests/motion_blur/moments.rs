//! An open shutter shows the mean of its moments, sample by sample and bit for bit; and what does not move costs nothing.

use residual_device_cpu::{CpuDevice, Interpreter, LaneCount, Width};
use residual_driver::poses::Poses;
use residual_render::film::{Film, Sampling, TILE_SIZE};
use residual_render::passes::{Pass, RenderOptions};
use residual_render::program::LightNode;
use residual_render::shutter::Moments;
use residual_render::tracer::{AnySharing, TracerNode};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{LightPicks, PlanOptions, plan};
use residual_tests::pictures::first_difference;
use residual_variants::AnyLanes;
use serde_json::json;

use super::file::{File, interpret, options, planned, planned_for, turn};

const SIZE: [u32; 2] = [40, 30];

/// Everything that can move does: the camera, a light, nodes, a morph target and a joint.
fn busy() -> File {
    let mut file = File::perspective(0.6);
    file.animate(
        0,
        "translation",
        "LINEAR",
        &[&[0.0, 0.0, 5.0], &[0.1, 0.05, 4.8]],
    );
    let wall = file.rectangle([-2.0, 2.0], [-2.0, 2.0], 1);
    file.node(json!({ "name": "wall", "mesh": wall, "translation": [0, 0, -1] }));
    let lamp = file.point_light([1.0, 1.0, 2.0]);
    file.animate(
        lamp,
        "translation",
        "LINEAR",
        &[&[1.0, 1.0, 2.0], &[-1.0, 1.0, 2.5]],
    );
    let card = file.rectangle([-0.3, 0.3], [-0.3, 0.3], 1);
    let node = file.node(json!({ "name": "card", "mesh": card }));
    file.animate(node, "rotation", "LINEAR", &[&turn(0.0), &turn(80.0)]);
    file.animate(
        node,
        "translation",
        "LINEAR",
        &[&[-0.8, 0.0, 0.0], &[-0.4, 0.6, 0.0]],
    );
    let target = file.floats("VEC3", 6, &[0.0, 0.5, 0.0].repeat(6));
    let morphed = file.rectangle([0.3, 0.8], [-0.6, 0.0], 1);
    file.primitive(morphed)["targets"] = json!([{ "POSITION": target }]);
    let node = file.node(json!({ "name": "morphed", "mesh": morphed }));
    file.animate(node, "weights", "LINEAR", &[&[0.0], &[1.0]]);
    let bent = file.rectangle([-0.2, 0.2], [-1.0, -0.7], 1);
    let joints = file.accessor("VEC4", 5121, 6, &[0; 24]);
    let weights = file.floats("VEC4", 6, &[1.0, 0.0, 0.0, 0.0].repeat(6));
    let attributes = &mut file.primitive(bent)["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    let joint = file.node(json!({ "name": "joint" }));
    let skin = file.skin(json!({ "joints": [joint] }));
    file.node(json!({ "name": "bent", "mesh": bent, "skin": skin }));
    file.animate(joint, "rotation", "LINEAR", &[&turn(0.0), &turn(-30.0)]);
    file
}

fn expect_same(a: &Film, b: &Film) {
    assert_eq!(first_difference(&a.image(), &b.image()), None);
    assert_eq!(a.error(), b.error());
}

#[test]
fn every_sample_is_that_of_its_moment() {
    check_samples(TracerNode::default());
}

#[test]
fn paths_from_lights_are_of_the_moment_of_those_from_the_camera() {
    check_samples(TracerNode::Bidirectional(AnySharing::Combined));
}

fn check_samples(tracer: TracerNode) {
    let (file, seed) = (busy(), 11);
    let moments = Moments::new(4, seed).unwrap();
    let times: Vec<f64> = moments.times().collect();
    let open = planned_for(tracer, &file.open(&moments), SIZE);
    let effects = Effects::of(&open);
    for source in [
        "node \"card\"",
        "node \"morphed\"",
        "node \"bent\"",
        "light \"lamp\"",
        "camera \"camera\"",
    ] {
        let sources = effects.reasons(Effect::MotionBlur);
        assert!(sources.iter().any(|s| s == source), "{sources:?}");
    }
    assert_eq!(effects.reasons(Effect::MotionBlur).len(), 5);
    let film = interpret(&open, &options(SIZE, 8, seed));

    let device = CpuDevice::new(2).unwrap();
    let mut sums = vec![[0.0; 3]; film.image().len()];
    for sample in 0..8 {
        let time = times[moments.of_sample(sample) as usize];
        let closed = planned_for(tracer, &file.at(Some(time), Vec::new()), SIZE);
        assert!(closed.motion.is_none());
        assert_eq!(closed.structure, open.structure);
        let interpreter = Interpreter::new(closed.structure.clone());
        let poses = Poses::new(&closed, Width::Native, seed);
        let mut one = Film::new(SIZE[0], SIZE[1], TILE_SIZE, closed.structure.layers);
        let pass = Pass {
            first: sample,
            count: 1,
        };
        let look = options(SIZE, 8, seed);
        poses.pass(&device, &interpreter, &look, &mut one, pass);
        for (sum, rgb) in sums.iter_mut().zip(one.image()) {
            *sum = [0, 1, 2].map(|k| sum[k] + f64::from(rgb[k]));
        }
    }
    let expected: Vec<[f32; 3]> = sums
        .iter()
        .map(|sum| sum.map(|c| (c / 8.0) as f32))
        .collect();
    // Even and odd samples are summed apart, which rounds differently.
    for (found, expected) in film.image().iter().zip(&expected) {
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 1e-6 * expected.abs(),
                "{found} {expected}"
            );
        }
    }
    assert!(expected.iter().any(|rgb| rgb[0] > 0.0));
}

#[test]
fn neither_threads_nor_passes_nor_a_compiler_show() {
    let moments = Moments::new(8, 2).unwrap();
    let plan = planned(&busy().open(&moments), SIZE);
    for sampling in [Sampling::Uniform, Sampling::Adaptive] {
        let look = RenderOptions {
            sampling,
            ..options(SIZE, 40, 2)
        };
        let expected = interpret(&plan, &look);
        assert_eq!(expected.invalid_samples(), 0);
        for (threads, lanes, width) in [
            (1, LaneCount::Four, Width::Four),
            (3, LaneCount::Eight, Width::Native),
        ] {
            let device = CpuDevice::new(threads).unwrap();
            let interpreter = AnyLanes::new(plan.structure.clone(), lanes);
            let poses = Poses::new(&plan, width, 2);
            poses.build_ahead();
            expect_same(&expected, &poses.render(&device, &interpreter, &look));
        }
        let compiled = residual_driver::compile(&plan, LaneCount::native()).unwrap();
        let device = CpuDevice::new(2).unwrap();
        let poses = Poses::new(&plan, Width::Native, 2);
        expect_same(&expected, &poses.render(&device, &compiled, &look));
    }
}

/// Where nothing moves meanwhile, an open shutter is a closed one: before the first key, after the last, and without channels.
#[test]
fn where_nothing_moves_there_is_one_pose() {
    let file = busy();
    let look = options(SIZE, 4, 0);
    for start in [-10.0, 5.0] {
        let times: Vec<f64> = (0..4).map(|k| start + f64::from(k)).collect();
        let open = planned(&file.at(None, times), SIZE);
        let closed = planned(&file.at(Some(start), Vec::new()), SIZE);
        assert!(open.motion.is_none());
        assert_eq!(open.structure, closed.structure);
        expect_same(&interpret(&open, &look), &interpret(&closed, &look));
        let dismissed = Effects::of(&open);
        assert!(!dismissed.has(Effect::MotionBlur));
        assert_eq!(dismissed.dismissed(Effect::MotionBlur).len(), 1);
        assert!(
            Effects::of(&closed)
                .dismissed(Effect::MotionBlur)
                .is_empty()
        );
    }
}

/// What moves unseen is no motion either.
#[test]
fn what_is_not_seen_does_not_move() {
    let mut file = File::orthographic(1.0, 1.0);
    let mesh = file.rectangle([-0.5, 0.5], [-0.5, 0.5], 0);
    file.node(json!({ "mesh": mesh }));
    let other = file.node(json!({ "camera": 0 }));
    file.animate(other, "translation", "LINEAR", &[&[0.0; 3], &[1.0; 3]]);
    let moments = Moments::new(4, 0).unwrap();
    let scene = file.open(&moments);
    assert_eq!(scene.later.len(), 3);
    let open = planned(&scene, SIZE);
    assert!(open.motion.is_none());
    assert_eq!(Effects::of(&open).dismissed(Effect::MotionBlur).len(), 1);
}

/// Poses that repeat, as those of steps do, are there once; and what is the same at two moments is shared.
#[test]
fn moments_of_one_pose_share_it() {
    let mut file = File::orthographic(1.0, 1.0);
    let mesh = file.rectangle([-0.5, 0.5], [-0.5, 0.5], 0);
    let node = file.node(json!({ "mesh": mesh }));
    let keys: [&[f32]; 3] = [&[0.0; 3], &[1.0, 0.0, 0.0], &[1.0, 0.0, 0.0]];
    file.animate(node, "translation", "STEP", &keys);
    let times: Vec<f64> = (0..8).map(|k| 0.6 + 0.1 * f64::from(k)).collect();
    let plan = planned(&file.at(None, times), SIZE);
    let motion = plan.motion.as_ref().unwrap();
    assert_eq!(motion.later.len(), 1);
    assert_eq!(motion.moments, [0, 0, 0, 0, 1, 1, 1, 1]);
    assert!(plan.memory_bytes() < 2 * plan.data.memory_bytes());
}

/// The only light of a scene goes out, or on: at some moments there is nothing to pick from.
#[test]
fn the_only_light_may_go_out() {
    // Three of eight moments are before second 1.
    only_light([&[1.0; 3], &[0.0; 3]], 3.0 / 8.0);
    only_light([&[0.0; 3], &[1.0; 3]], 5.0 / 8.0);
}

/// A lamp before a wall covers the image while it is there, and leaves it dark where it is not.
fn only_light(keys: [&[f32]; 2], part: f32) {
    let mut file = File::orthographic(1.0, 1.0);
    let mesh = file.rectangle([-3.0, 3.0], [-3.0, 3.0], 0);
    let node = file.node(json!({ "name": "lamp", "mesh": mesh }));
    file.animate(node, "scale", "STEP", &keys);
    let wall = file.rectangle([-1.0, 1.0], [-1.0, 1.0], 1);
    file.node(json!({ "mesh": wall, "translation": [0, 0, -1] }));
    let times: Vec<f64> = (0..8).map(|k| 0.25 + 0.25 * f64::from(k)).collect();
    for light_picks in [LightPicks::Auto, LightPicks::Tree] {
        let options_of_plan = PlanOptions {
            size: [16, 16],
            light_picks,
            ..PlanOptions::default()
        };
        let plan = plan(&file.at(None, times.clone()), &options_of_plan).unwrap();
        assert!(plan.structure.lights.contains(&LightNode::Point));
        let film = interpret(&plan, &options([16, 16], 16, 0));
        assert_eq!(film.invalid_samples(), 0);
        for [red, ..] in film.image() {
            assert!((red - part).abs() < 1e-6, "{red}");
        }
    }
}
