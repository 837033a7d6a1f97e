//! Cameras against closed forms: the circle of confusion of a thin lens, where it is focused, and panoramas of an
//! environment that is known.

use residual_device_cpu::LaneCount;
use residual_render::camera::CameraRecord;
use residual_render::film::Film;
use residual_scenegen::desc::{MaterialDesc, Projection, SceneDesc};
use residual_scenegen::plan::{Aperture, Focus, Optics, PlanError, PlanOptions, plan};
use residual_tests::fixtures::{Builder, color, material, matte, sheet};
use residual_tests::{Look, Prepared};

/// Half of it is as high as its distance.
const RIGHT_ANGLE: Projection = Projection::Perspective {
    yfov: std::f32::consts::FRAC_PI_2,
};

const SIZE: [u32; 2] = [64; 2];

fn options(optics: Optics, size: [u32; 2]) -> PlanOptions {
    PlanOptions {
        optics,
        size,
        ..PlanOptions::default()
    }
}

/// What is emitted and seen directly.
fn render(scene: &SceneDesc, optics: Optics, size: [u32; 2], samples: u32) -> Film {
    let plan = plan(scene, &options(optics, size)).unwrap();
    let look = Look {
        max_depth: 1,
        ..Look::new(size, samples)
    };
    Prepared::new(&plan, LaneCount::native()).interpret(&look)
}

fn lamp() -> MaterialDesc {
    MaterialDesc {
        emission: color([1.0; 3]),
        ..material("lamp", matte([0.0; 3]))
    }
}

/// A square lamp of this side around the view axis, at a distance from the eye; nothing else.
fn point_light(side: f32, distance: f32) -> SceneDesc {
    let mut b = Builder::new("point");
    b.add(
        lamp(),
        [sheet(
            [-0.5 * side, -0.5 * side, -distance],
            [side, 0.0, 0.0],
            [0.0, side, 0.0],
        )],
    );
    b.camera("eye", [0.0; 3], [0.0, 0.0, -1.0], RIGHT_ANGLE);
    b.finish()
}

/// What a spot on the film comes to: its light, its middle, its variance along either axis, and the largest distance from
/// the middle; lengths in half heights of the film.
struct Spot {
    sum: f64,
    middle: [f64; 2],
    variance: [f64; 2],
    reach: f64,
}

fn spot(film: &Film) -> Spot {
    let image = film.image();
    let place = |index: usize| {
        let (x, y) = (index % SIZE[0] as usize, index / SIZE[0] as usize);
        [x, y].map(|k| (k as f64 + 0.5) * 2.0 / f64::from(SIZE[0]) - 1.0)
    };
    let (mut sum, mut first, mut second, mut reach) = (0.0, [0.0; 2], [0.0; 2], 0.0_f64);
    for (index, rgb) in image.iter().enumerate() {
        let (value, place) = (f64::from(rgb[1]), place(index));
        sum += value;
        for axis in 0..2 {
            first[axis] += value * place[axis];
            second[axis] += value * place[axis] * place[axis];
        }
        if value > 0.0 {
            reach = reach.max(place[0].hypot(place[1]));
        }
    }
    let middle = first.map(|k| k / sum);
    let variance = [0, 1].map(|axis| second[axis] / sum - middle[axis] * middle[axis]);
    Spot {
        sum,
        middle,
        variance,
        reach,
    }
}

/// A point at distance z, seen through a lens of radius r that is focused at distance f, is spread evenly over a disc of
/// radius r·|1/f − 1/z| on a film at distance 1 (the circle of confusion). Evenly, so that the variance along either axis
/// is a quarter of the radius squared; to which comes the variance of what a pinhole sees of the lamp, in pixels.
#[test]
fn points_off_the_plane_of_focus_spread_over_the_circle_of_confusion() {
    let pixel = 2.0 / f64::from(SIZE[1]);
    for (radius, focus, distance) in [
        (1.0, 4.0, 2.0),
        (1.0, 1.0, 2.0),
        (0.5, 1.0, 4.0),
        (0.25, 2.0, 2.0),
    ] {
        let side = 0.1 * distance;
        let scene = point_light(side, distance);
        let optics = Optics::ThinLens {
            aperture: Aperture::Diameter(2.0 * radius),
            focus: Focus::Distance(focus),
        };
        let [blurred, sharp] = [(optics, 1024), (Optics::Projection, 64)]
            .map(|(optics, samples)| spot(&render(&scene, optics, SIZE, samples)));
        let confusion = f64::from(radius * (1.0 / focus - 1.0 / distance).abs());
        let seen = f64::from(side / distance);
        let what = format!("lens {radius}, focus {focus}, distance {distance}");
        // No light is lost.
        assert!((blurred.sum / sharp.sum - 1.0).abs() < 0.01, "{what}");
        for axis in 0..2 {
            assert!(blurred.middle[axis].abs() < 0.1 * pixel, "{what}");
            let variance = 0.25 * confusion * confusion + sharp.variance[axis];
            let ratio = blurred.variance[axis] / variance;
            assert!((ratio - 1.0).abs() < 0.01, "{what}: {ratio}");
        }
        // Its rim is where the formula says, to within pixels and the lamp's corners.
        let slack = (0.5 * seen + pixel) * std::f64::consts::SQRT_2;
        assert!(
            blurred.reach <= confusion + slack && blurred.reach >= confusion - pixel,
            "{what}: {}",
            blurred.reach
        );
    }
}

#[test]
fn focus_is_on_what_is_in_the_middle() {
    let planned = |scene: &SceneDesc, focus| {
        let aperture = Aperture::FNumber(2.0);
        let optics = Optics::ThinLens { aperture, focus };
        plan(scene, &options(optics, SIZE)).map(|plan| plan.data.record::<CameraRecord>(0))
    };
    let scene = point_light(1.0, 3.5);
    let camera = planned(&scene, Focus::Middle).unwrap();
    assert_eq!(camera.focus_distance, 3.5);
    // 12 mm of focal length, open 6 mm wide.
    assert!((camera.lens_radius - 0.003).abs() < 1e-8);
    assert_eq!(
        planned(&scene, Focus::Distance(2.0))
            .unwrap()
            .focus_distance,
        2.0
    );

    let mut aside = scene.clone();
    aside.meshes[0]
        .positions
        .iter_mut()
        .for_each(|p| p.x += 9.0);
    let error = planned(&aside, Focus::Middle).unwrap_err();
    assert!(matches!(error, PlanError::NothingInFocus), "{error}");
    let mut parallel = scene;
    parallel.cameras[0].projection = Projection::Orthographic { ymag: 1.0 };
    let error = planned(&parallel, Focus::Distance(2.0)).unwrap_err();
    assert!(matches!(error, PlanError::NoLens { .. }), "{error}");
}

/// Towards +X, a panorama of nothing but an environment is the environment's image: texel for texel in the middle of pixels
/// of the same number, and in between as its bilinear filter says.
#[test]
fn a_panorama_of_an_environment_is_its_image() {
    let size = [16_u32, 8];
    let mut b = Builder::new("sky");
    let image = b.floats(size[0], size[1]);
    b.environment(image, 0.5, 0.0);
    b.camera("eye", [1.0, 2.0, 3.0], [2.0, 2.0, 3.0], RIGHT_ANGLE);
    let scene = b.finish();
    let residual_scenegen::desc::Texels::RgbaF32(texels) = &scene.images[image].texels else {
        unreachable!("an image of floats")
    };
    let film = render(&scene, Optics::Panorama, size, 1024);
    let texel = |x: i32, y: i32, channel: usize| {
        let x = x.rem_euclid(size[0] as i32);
        let y = y.clamp(0, size[1] as i32 - 1);
        0.5 * texels[(y * size[0] as i32 + x) as usize][channel]
    };
    for (index, rgb) in film.image().iter().enumerate() {
        let (x, y) = (
            (index as u32 % size[0]) as i32,
            (index as u32 / size[0]) as i32,
        );
        for (channel, found) in rgb.iter().enumerate() {
            // The mean over a pixel of what the filter makes of a texel and its neighbours: (1, 6, 1)/8 along either axis.
            let weight = |k: i32| if k == 0 { 0.75 } else { 0.125 };
            let mut expected = 0.0;
            for (dx, dy) in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| (dx, dy))) {
                expected += weight(dx) * weight(dy) * texel(x + dx, y + dy, channel);
            }
            assert!(
                (found - expected).abs() < 2e-3,
                "{x} {y}: {found} {expected}"
            );
        }
    }
}

/// Four lamps around the eye, each where a panorama has it: ahead in the middle, to the right of it, above, and behind at both
/// edges.
#[test]
fn panoramas_have_what_is_to_the_right_to_the_right() {
    let size = [64_u32, 32];
    let place = |x: u32, y: u32| (y * size[0] + x) as usize;
    for (corner, lit) in [
        ([-0.1, -0.1, -2.0], vec![place(32, 16), place(31, 15)]),
        ([-0.1, -0.1, 2.0], vec![place(0, 16), place(63, 15)]),
    ] {
        let mut b = Builder::new("around");
        let lamp = MaterialDesc {
            double_sided: true,
            ..lamp()
        };
        b.add(lamp, [sheet(corner, [0.2, 0.0, 0.0], [0.0, 0.2, 0.0])]);
        b.camera("eye", [0.0; 3], [0.0, 0.0, -1.0], RIGHT_ANGLE);
        let image = render(&b.finish(), Optics::Panorama, size, 16).image();
        for (index, rgb) in image.iter().enumerate() {
            assert!(!lit.contains(&index) || rgb[0] > 0.2, "{corner:?} {index}");
        }
        let sum: f32 = image.iter().map(|rgb| rgb[0]).sum();
        // 0.1 rad by 0.1 rad, where a pixel is 2π/64 wide and high.
        let expected = (0.1 / (std::f32::consts::TAU / 64.0)).powi(2);
        assert!((sum / expected - 1.0).abs() < 0.1, "{corner:?}: {sum}");
    }
    for (corner, side, lit) in [
        // To the right, a quarter of the circle from the middle.
        ([2.0, -0.1, -0.1], [0.0, 0.0, 0.2], place(48, 16)),
        ([-2.0, -0.1, -0.1], [0.0, 0.0, 0.2], place(16, 16)),
    ] {
        let mut b = Builder::new("aside");
        let lamp = MaterialDesc {
            double_sided: true,
            ..lamp()
        };
        b.add(lamp, [sheet(corner, side, [0.0, 0.2, 0.0])]);
        b.camera("eye", [0.0; 3], [0.0, 0.0, -1.0], RIGHT_ANGLE);
        let image = render(&b.finish(), Optics::Panorama, size, 16).image();
        assert!(image[lit][0] > 0.2, "{corner:?}");
    }
    // The zenith is the whole top edge.
    let mut b = Builder::new("above");
    let lamp = MaterialDesc {
        double_sided: true,
        ..lamp()
    };
    b.add(
        lamp,
        [sheet([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0])],
    );
    b.camera("eye", [0.0; 3], [0.0, 0.0, -1.0], RIGHT_ANGLE);
    let image = render(&b.finish(), Optics::Panorama, size, 16).image();
    assert!((0..64).all(|x| image[place(x, 0)] == [1.0; 3]));
    assert!((0..64).all(|x| image[place(x, 31)] == [0.0; 3]));
}
