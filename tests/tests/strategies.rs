//! Strategies of sampling agree with one another: light that two can find is found by each alone (L-10).

use residual_device_cpu::{CpuDevice, LaneCount};
use residual_render::film::Film;
use residual_render::layer::{Layer, Layers};
use residual_render::passes::RenderOptions;
use residual_render::tracer::{AnyMis, TracerNode};
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::plan::{LightPicks, PlanOptions, plan};
use residual_tests::{Prepared, fixtures};
use std::ops::ControlFlow;

const SIZE: [u32; 2] = [48, 36];
const SAMPLES: u32 = 1024;

fn render(scene: &SceneDesc, mis: AnyMis, light_picks: LightPicks, seed: u32) -> Film {
    let options = PlanOptions {
        size: SIZE,
        tracer: TracerNode::Path(mis),
        light_picks,
        layers: Layers::NONE.with(Layer::StandardError),
        ..PlanOptions::default()
    };
    let plan = plan(scene, &options).unwrap();
    let prepared = Prepared::new(&plan, LaneCount::native());
    let options = RenderOptions {
        size: SIZE,
        samples: Some(SAMPLES),
        seed,
        ..RenderOptions::default()
    };
    let renderer = prepared.interpreter();
    let go_on = |_: residual_render::passes::Progress<'_>| ControlFlow::Continue(());
    let device = CpuDevice::new(2).unwrap();
    device
        .render(|| &renderer, &prepared.view(), &options, go_on)
        .0
}

/// Mean of the image and its standard error, by channel.
fn mean(film: &Film) -> [[f64; 2]; 3] {
    let mean = film.mean();
    [0, 1, 2].map(|k| {
        let errors = film.channel(Layer::StandardError, k).unwrap();
        let squares: f64 = errors.iter().map(|e| f64::from(*e).powi(2)).sum();
        [mean[k], squares.sqrt() / errors.len() as f64]
    })
}

fn agree(a: &Film, b: &Film, what: &str) {
    for (k, ([a, error_a], [b, error_b])) in mean(a).into_iter().zip(mean(b)).enumerate() {
        let z = (a - b) / error_a.hypot(error_b);
        // 4.5 standard errors, in some thirty comparisons: once in five thousand runs of other seeds.
        assert!(
            z.abs() < 4.5,
            "{what}, channel {k}: {a} and {b}, {z:.1} standard errors"
        );
        assert!(error_a < 0.02 * a, "{what}: {a} is known to {error_a}");
    }
}

/// The scenes have a roof's or a sky's light, points and spots, and glossy surfaces.
fn scenes() -> Vec<(&'static str, SceneDesc)> {
    vec![("room", fixtures::room()), ("lights", fixtures::lights())]
}

#[test]
fn weights_of_all_kinds_give_one_image() {
    for (name, scene) in scenes() {
        let power = render(&scene, AnyMis::PowerHeuristic, LightPicks::Mixed, 1);
        let others = [
            AnyMis::BalanceHeuristic,
            AnyMis::LightsOnly,
            AnyMis::BsdfOnly,
        ];
        for (seed, mis) in (2..).zip(others) {
            let other = render(&scene, mis, LightPicks::Mixed, seed);
            agree(&power, &other, &format!("{name}, {mis:?}"));
        }
    }
}

#[test]
fn lights_may_be_picked_in_any_way() {
    for (name, scene) in scenes() {
        let mixed = render(&scene, AnyMis::LightsOnly, LightPicks::Mixed, 5);
        for (seed, picks) in (6..).zip([LightPicks::Power, LightPicks::Uniform]) {
            let other = render(&scene, AnyMis::LightsOnly, picks, seed);
            agree(&mixed, &other, &format!("{name}, {picks:?}"));
        }
    }
}
