//! Lights with a size, as a whole render shows them: their shadows, and what arrives below area lights.

use glam::Vec3;
use residual_device_cpu::LaneCount;
use residual_render::program::LightNode;
use residual_scenegen::desc::{Projection, PunctualKind, SceneDesc};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::fixtures::{Builder, material, matte, sheet};
use residual_tests::{Look, Prepared, read_scene};
use serde_json::{Value, json};

const SIZE: [u32; 2] = [64, 8];
/// Half the width of what the camera sees.
const HALF_WIDTH: f64 = 0.8;
/// The blade's height above the floor.
const HEIGHT: f64 = 4.0;

/// Adds a floor that reflects all, and a camera that looks down on it.
fn over_a_floor(mut b: Builder) -> SceneDesc {
    let floor = sheet([-9.0, -9.0, 0.0], [18.0, 0.0, 0.0], [0.0, 18.0, 0.0]);
    b.add(material("floor", matte([1.0; 3])), [floor]);
    let ymag = (HALF_WIDTH * f64::from(SIZE[1]) / f64::from(SIZE[0])) as f32;
    let lens = Projection::Orthographic { ymag };
    b.camera("camera", [0.0, 0.0, 3.0], [0.0, 0.0, 0.0], lens);
    b.finish()
}

/// A floor, and a blade above its left half, under a light; the camera is between the two.
fn blade(kind: PunctualKind, size: f32) -> SceneDesc {
    let mut b = Builder::new("blade");
    let edge = [-40.0, -40.0, HEIGHT as f32];
    let blade = sheet(edge, [40.0, 0.0, 0.0], [0.0, 80.0, 0.0]);
    b.add(material("blade", matte([0.0; 3])), [blade]);
    b.light(kind, [std::f32::consts::PI; 3]);
    b.size_of_light(size);
    over_a_floor(b)
}

/// Mean radiance of each column of the image.
fn columns(scene: &SceneDesc, samples: u32) -> Vec<f64> {
    let options = PlanOptions {
        size: SIZE,
        ..PlanOptions::default()
    };
    let plan = plan(scene, &options).unwrap();
    let look = Look {
        max_depth: 2,
        ..Look::new(SIZE, samples)
    };
    let prepared = Prepared::new(&plan, LaneCount::native());
    let image = prepared.interpret(&look).image();
    let [width, height] = SIZE.map(|side| side as usize);
    let column = |x: usize| {
        (0..height)
            .map(|y| f64::from(image[y * width + x][1]))
            .sum::<f64>()
    };
    (0..width).map(|x| column(x) / height as f64).collect()
}

/// The part of a disc of radius 1 on one side of a chord at the distance `s` from its middle.
fn part_of_disc(s: f64) -> f64 {
    let s = s.clamp(-1.0, 1.0);
    0.5 + (s * (1.0 - s * s).sqrt() + s.asin()) / std::f64::consts::PI
}

/// [`part_of_disc`] over a column, whose middle and width are in radii of the disc.
fn over_column(middle: f64, width: f64) -> f64 {
    let steps = 64;
    let at = |step: i32| (f64::from(step) + 0.5) / f64::from(steps) - 0.5;
    let sum: f64 = (0..steps)
        .map(|step| part_of_disc(middle + at(step) * width))
        .sum();
    sum / f64::from(steps)
}

/// Each column beside the part of the light that it sees, whose penumbra has this radius on the floor.
fn check_penumbra(scene: &SceneDesc, penumbra: f64) {
    let width = 2.0 * HALF_WIDTH / f64::from(SIZE[0]);
    for (k, found) in columns(scene, 256).into_iter().enumerate() {
        let x = (k as f64 + 0.5) * width - HALF_WIDTH;
        let expected = over_column(x / penumbra, width / penumbra);
        assert!((found - expected).abs() < 0.02, "{x}: {found} {expected}");
    }
}

/// Under the zenith's sun of angle 2α, the penumbra of an edge at height h is 2·h·tan α wide.
#[test]
fn the_penumbra_of_a_sun_is_as_wide_as_its_angle_says() {
    for degrees in [1.0_f64, 4.0, 15.0] {
        let angle = degrees.to_radians();
        let direction = Vec3::NEG_Z;
        let scene = blade(PunctualKind::Directional { direction }, angle as f32);
        check_penumbra(&scene, HEIGHT * (0.5 * angle).tan());
    }
}

/// A sphere as high above the blade as this above the floor: the penumbra is about as wide as the sphere.
#[test]
fn the_penumbra_of_a_sphere_is_as_wide_as_it_looks() {
    let position = Vec3::new(0.0, 0.0, 2.0 * HEIGHT as f32);
    let mut scene = blade(PunctualKind::Point { position }, 0.25);
    let intensity = std::f64::consts::PI * (2.0 * HEIGHT).powi(2);
    scene.lights[0].intensity = [intensity as f32; 3];
    // From the floor the sphere is a disc in its middle's plane, somewhat larger than itself.
    let distance = 2.0 * HEIGHT;
    let disc = 0.25 / (1.0 - (0.25 / distance).powi(2)).sqrt();
    check_penumbra(&scene, disc * HEIGHT / (distance - HEIGHT));
}

/// A size of 0 is no other light than one without; and sizes near 0 give its picture.
#[test]
fn a_light_without_a_size_is_a_point() {
    let direction = Vec3::new(0.0, 0.0, -1.0);
    let position = Vec3::new(0.3, 0.0, 8.0);
    let spot = PunctualKind::Spot {
        position,
        direction,
        inner: 0.1,
        outer: 0.5,
    };
    for (kind, without, with) in [
        (
            PunctualKind::Point { position },
            LightNode::Point,
            LightNode::SphericalPoint,
        ),
        (spot, LightNode::Spot, LightNode::SphericalSpot),
        (
            PunctualKind::Directional { direction },
            LightNode::Directional,
            LightNode::Sun,
        ),
    ] {
        let lights = |size: f32| {
            let plan = plan(&blade(kind, size), &PlanOptions::default()).unwrap();
            plan.structure.lights
        };
        assert_eq!(lights(0.0), [without]);
        assert_eq!(lights(1e-6), [with]);
        let [point, small] = [0.0, 1e-6].map(|size| columns(&blade(kind, size), 16));
        for (point, small) in point.into_iter().zip(small) {
            assert!(
                (point - small).abs() < 1e-4 * point.max(1e-3),
                "{point} {small}"
            );
        }
    }
    let mut scene = blade(spot, 0.0);
    scene.set_sun_angle(0.1);
    assert_eq!(scene.lights[0].size, 0.0);
    scene.set_light_radius(0.1);
    assert_eq!(scene.lights[0].size, 0.1);
}

/// The light of a file, 1 above a floor; the camera is above the light.
fn below(light: &Value) -> SceneDesc {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("light.gltf");
    let gltf = json!({
        "asset": { "version": "2.0" },
        "extensionsUsed": ["EXT_lights_area"],
        "extensions": { "EXT_lights_area": { "lights": [light] } },
        "nodes": [{ "translation": [0, 0, 1], "extensions": { "EXT_lights_area": { "light": 0 } } }],
    });
    std::fs::write(&file, gltf.to_string()).unwrap();
    over_a_floor(Builder::of(read_scene(&file, None).unwrap()))
}

/// Irradiance over π below a disc of radiance 1, at this distance from its axis (Naraghi and Chung 1982, "Radiation
/// configuration factors between disks and a class of axisymmetric bodies").
fn below_disc(radius: f64, x: f64) -> f64 {
    let [r2, x2] = [radius * radius, x * x];
    0.5 * (1.0 - (1.0 + x2 - r2) / ((1.0 + x2 + r2).powi(2) - 4.0 * r2 * x2).sqrt())
}

/// The same below a rectangle, as far from its middle along its width: four corners' worth (Howell, "A Catalog of Radiation
/// Configuration Factors", B-4).
fn below_rectangle(half: [f64; 2], x: f64) -> f64 {
    let corner = |a: f64, b: f64| {
        let side = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        (side(a, b) + side(b, a)) / (2.0 * std::f64::consts::PI)
    };
    2.0 * (corner(half[0] - x, half[1]) + corner(half[0] + x, half[1]))
}

/// From above, where the camera is, nothing is there of a light that shines down.
#[test]
fn the_floor_below_area_lights_is_as_bright_as_closed_forms_say() {
    let disc = json!({ "type": "disk", "size": 1.2, "intensity": 1 });
    let rectangle = json!({ "type": "rect", "size": 0.6, "rect": { "aspect": 2 }, "intensity": 1 });
    for (light, expected) in [
        (disc, &(|x| below_disc(0.6, x)) as &dyn Fn(f64) -> f64),
        (rectangle, &|x| below_rectangle([0.6, 0.3], x)),
    ] {
        let width = 2.0 * HALF_WIDTH / f64::from(SIZE[0]);
        for (k, found) in columns(&below(&light), 256).into_iter().enumerate() {
            let expected = expected((k as f64 + 0.5) * width - HALF_WIDTH);
            assert!(
                (found / expected - 1.0).abs() < 0.01,
                "{k}: {found} {expected}"
            );
        }
    }
}

/// Cameras see the front of area lights.
#[test]
fn area_lights_are_as_bright_as_they_say() {
    let light = json!({ "type": "rect", "size": 9, "intensity": 0.75 });
    let mut scene = below(&light);
    scene.cameras[0].rotation = glam::Quat::from_rotation_x(std::f32::consts::PI);
    scene.cameras[0].position = Vec3::new(0.0, 0.0, 0.5);
    assert!(columns(&scene, 4).into_iter().all(|found| found == 0.75));
}
