//! Stacks of panes: each lets its share of light through, whoever asks, camera rays or shadow rays.

use residual_device_cpu::LaneCount;
use residual_scenegen::desc::{AlphaMode, MaterialDesc, Projection, PunctualKind, SceneDesc};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::fixtures::{Builder, color, material, matte, scalar, sheet};
use residual_tests::{Look, Prepared};

const SIZE: [u32; 2] = [32, 32];

fn mean(scene: &SceneDesc) -> f64 {
    let options = PlanOptions {
        size: SIZE,
        ..PlanOptions::default()
    };
    let plan = plan(scene, &options).unwrap();
    let look = Look::new(SIZE, 256);
    let film = Prepared::new(&plan, LaneCount::native()).interpret(&look);
    film.mean()[0]
}

/// Black panes of this alpha at the heights 1, 1.1, … in a view from above of what lies below, 1 wide.
fn below_panes(count: usize, alpha: f32, eye: f32, below: impl FnOnce(&mut Builder)) -> SceneDesc {
    let mut b = Builder::new("panes");
    below(&mut b);
    let pane = MaterialDesc {
        alpha_mode: AlphaMode::Blend,
        alpha: scalar(alpha),
        double_sided: true,
        ..material("pane", matte([0.0; 3]))
    };
    let panes = (0..count).map(|k| {
        let height = 1.0 + 0.1 * k as f32;
        sheet([-9.0, height, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0])
    });
    b.add(pane, panes.collect::<Vec<_>>());
    let lens = Projection::Orthographic { ymag: 0.5 };
    b.camera("camera", [0.0, eye, 0.001], [0.0, 0.0, 0.0], lens);
    b.finish()
}

#[test]
fn stacks_of_panes_let_the_product_of_their_shares_through() {
    for (count, alpha) in [
        (0, 0.5),
        (1, 0.5),
        (2, 0.5),
        (5, 0.5),
        (8, 0.25),
        (30, 0.05),
    ] {
        let expected = f64::from(1.0 - alpha).powi(count as i32);
        let close = |found: f64, what: &str| {
            assert!(
                (found - expected).abs() < 0.01,
                "{what}: {count} of {alpha}: {found} {expected}"
            );
        };
        // Seen through the panes.
        let lamp = |b: &mut Builder| {
            let glowing = MaterialDesc {
                emission: color([1.0; 3]),
                ..material("lamp", matte([0.0; 3]))
            };
            b.add(
                glowing,
                [sheet([-9.0, 0.0, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0])],
            );
        };
        close(mean(&below_panes(count, alpha, 9.0, lamp)), "seen");
        // Lit through the panes, and seen from below them.
        let floor = |b: &mut Builder| {
            b.add(
                material("floor", matte([1.0; 3])),
                [sheet([-9.0, 0.0, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0])],
            );
            let direction = glam::Vec3::NEG_Y;
            let irradiance = std::f32::consts::PI;
            b.light(PunctualKind::Directional { direction }, [irradiance; 3]);
        };
        close(mean(&below_panes(count, alpha, 0.5, floor)), "lit");
    }
}
