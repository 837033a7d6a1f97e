//! Lights against closed forms (hard cases L-04, L-05, L-09, L-11).

use residual_render::domain::{Scalar, Uint};
use residual_render::light::{
    self, Area, AreaRecord, Directional, LightKind, Point, PunctualRecord, Spot, power_heuristic,
};
use residual_render::sampler::{SampleKey, Sampler, Sobol};
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, PathRay};
use residual_render::texture::Const;

use crate::support::irradiance::estimate;
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, Triangle, floor, scene, set_lights, surface_at};
use crate::support::stats::{Family, Mean, chi_squared};
use crate::support::{Worst, array, cross, dot, unit};

const LAMP: Area<Const<[f32; 3]>> = Area {
    emission: Const([1.0; 3]),
    attributes: Attributes {
        normals: false,
        tangents: false,
        uv0: false,
        uv1: false,
        colors: false,
    },
};

fn lamp_record(triangle: u32, double_sided: u32) -> AreaRecord {
    AreaRecord {
        kind: 0,
        triangle,
        double_sided,
    }
}

/// Lambert's formula for the irradiance of a polygon of radiance 1 that is wholly above the horizon.
fn lambert(vertices: &[[f64; 3]], from: [f64; 3], normal: [f64; 3]) -> f64 {
    let n = vertices.len();
    let seen: Vec<_> = vertices
        .iter()
        .map(|v| unit([v[0] - from[0], v[1] - from[1], v[2] - from[2]]))
        .collect();
    let edge = |k: usize| {
        let (a, b) = (seen[k], seen[(k + 1) % n]);
        let normal_of_edge = cross(a, b);
        let sine = dot(normal_of_edge, normal_of_edge).sqrt();
        sine.atan2(dot(a, b)) * dot(normal_of_edge, normal) / sine
    };
    ((0..n).map(edge).sum::<f64>() / 2.0).abs()
}

/// The floor's middle as it is computed, in f64.
pub(crate) fn middle(data: &SceneData) -> [f64; 3] {
    let buffers = data.buffers();
    array(floor(Scalar::new(&buffers)).point).map(f64::from)
}

#[test]
fn triangles_shine_as_lambert_says() {
    let mut rng = Rng::new(120);
    let mut family = Family::default();
    let mut squares = 0.0;
    let count = 200;
    for k in 0..count {
        let (height, size) = (
            10.0_f64.powf(rng.range(-0.5, 1.0)),
            10.0_f64.powf(rng.range(-1.0, 0.7)),
        );
        let centre = [rng.range(-3.0, 3.0), rng.range(-3.0, 3.0), height + size];
        let lamp: Triangle = [0; 3].map(|_| {
            let v = rng.direction();
            [0, 1, 2].map(|k| (centre[k] + v[k] * size) as f32)
        });
        let mut data = scene(&[FLOOR, lamp]);
        set_lights(&mut data, &[lamp_record(1, 1)], &[1.0]);
        let normal = [0.0, 0.0, 1.0];
        let exact = lambert(&lamp.map(|v| v.map(f64::from)), middle(&data), normal);
        let z = estimate(&data, &(LAMP, ()), normal, 4000, 121 + k).z(exact, 1e-6);
        assert!(z.abs() < 4.5, "{lamp:?}: z = {z}");
        squares += z * z;
        family.add_z(z, format!("{lamp:?}"));
    }
    family.assert_plausible();
    // Σz² has mean n and variance 2n.
    let z = (squares - count as f64) / (2.0 * count as f64).sqrt();
    assert!(z.abs() < 4.5, "Σz² = {squares}");
}

#[test]
fn one_sided_and_degenerate_triangles() {
    let up: Triangle = [[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [0.0, 1.0, 2.0]];
    let down: Triangle = [up[0], up[2], up[1]];
    let line: Triangle = [up[0], up[0], up[1]];
    let edge_on: Triangle = [[0.0, 0.5, 1.0], [0.0, 0.5, 2.0], [0.0, -0.5, 1.5]];
    for (lamp, both, shines) in [
        (down, 0, true),
        (up, 0, false),
        (up, 1, true),
        (line, 1, false),
    ] {
        let mut data = scene(&[FLOOR, lamp]);
        set_lights(&mut data, &[lamp_record(1, both)], &[1.0]);
        let mean = estimate(&data, &(LAMP, ()), [0.0, 0.0, 1.0], 1000, 130);
        assert_eq!(
            mean.value() > 0.0,
            shines,
            "{lamp:?} {both}: {}",
            mean.value()
        );
        assert!(mean.value().is_finite());
    }
    // Seen edge on, up to the rounding of the point that it is seen from.
    let mut data = scene(&[FLOOR, edge_on]);
    set_lights(&mut data, &[lamp_record(1, 1)], &[1.0]);
    assert!(estimate(&data, &(LAMP, ()), [0.0, 0.0, 1.0], 1000, 130).value() < 1e-7);
    // The point lies on the light itself.
    let mut data = scene(&[FLOOR]);
    set_lights(&mut data, &[lamp_record(0, 1)], &[1.0]);
    assert_eq!(
        estimate(&data, &(LAMP, ()), [0.0, 0.0, 1.0], 1000, 131).value(),
        0.0
    );
}

#[test]
fn density_of_a_light_is_the_same_from_both_sides() {
    let lamp: Triangle = [[0.3, -0.2, 2.0], [0.4, 1.1, 2.5], [1.7, 0.1, 1.5]];
    let mut data = scene(&[FLOOR, lamp]);
    set_lights(&mut data, &[lamp_record(1, 1)], &[1.0]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let mut rng = Rng::new(132);
    let mut worst = Worst::default();
    for _ in 0..10_000 {
        let sample = LAMP.sample(d, Uint(0), floor(d).point, rng.unit3());
        let (b1, b2) = residual_render::math::warp::triangle(d, [rng.unit(), rng.unit()]);
        let hit = surface_at(
            d,
            1,
            [f64::from(b1), f64::from(b2)],
            array(sample.wi).map(f64::from),
        );
        assert!(sample.pdf > 0.0 && hit.cos_geometric > 0.0);
        // ∫ 1 dω over the lamp by either density: pdf · cos · area ÷ distance² = 1.
        let from = floor(d).point;
        let away = hit.point - from;
        let there = surface_at(
            d,
            1,
            [f64::from(b1), f64::from(b2)],
            array(away).map(f64::from),
        );
        let ray = PathRay::unbounded(d, from, away.normalize(d));
        let pdf = LAMP
            .density(d, Uint(0), &ray, &there)
            .expect("rays meet lamps");
        let cos = f64::from(there.cos_geometric) * f64::from(there.area)
            / f64::from(away.length(d)).powi(2);
        worst.add((f64::from(pdf) * cos - 1.0).abs(), || format!("{b1} {b2}"));
    }
    worst.assert_below(1e-6, "area light's density");
}

/// A red light of the only kind.
pub(crate) fn punctual(position: [f32; 3], intensity: f32) -> PunctualRecord {
    PunctualRecord::new(0, position, [intensity, 0.0, 0.0])
}

#[test]
fn punctual_lights_are_their_closed_forms() {
    let normal = [0.0, 0.0, 1.0];
    let mut data = scene(&[FLOOR]);
    let point = middle(&data);
    let mut rng = Rng::new(133);
    let close = |got: Mean, exact: f64, bound: f64| {
        assert!(
            (got.value() - exact).abs() <= bound * exact.abs().max(1e-2),
            "{} {exact}",
            got.value()
        )
    };
    for _ in 0..300 {
        let place = [0, 1, 2].map(|k| rng.range(-3.0, 3.0) as f32 + if k == 2 { 4.0 } else { 0.0 });
        let intensity = rng.range(0.1, 100.0) as f32;
        let away = [0, 1, 2].map(|k| f64::from(place[k]) - point[k]);
        let (d2, wi) = (dot(away, away), unit(away));
        let exact = f64::from(intensity) / d2 * dot(wi, normal).max(0.0);
        set_lights(&mut data, &[punctual(place, intensity)], &[1.0]);
        // A spot of KHR_lights_punctual: inner and outer cone angles of 0.2 and 0.6.
        let axis = unit([0.1, 0.2, -1.0]);
        let (inner, outer) = (0.2_f64.cos(), 0.6_f64.cos());
        let falloff = (-dot(axis, wi) - outer) / (inner - outer);
        let falloff = falloff.clamp(0.0, 1.0).powi(2);
        let axis = axis.map(|c| c as f32);
        let spot = PunctualRecord::spot(0, place, [intensity, 0.0, 0.0], axis, [0.2, 0.6]);
        set_lights(&mut data, &[spot], &[1.0]);
        close(
            estimate(&data, &(Spot, ()), normal, 2, 135),
            exact * falloff,
            1e-3,
        );
        let sun = punctual(wi.map(|c| c as f32), intensity);
        set_lights(&mut data, &[sun], &[1.0]);
        close(
            estimate(&data, &(Directional, ()), normal, 2, 136),
            f64::from(intensity) * dot(wi, normal).max(0.0),
            1e-5,
        );
    }
    // A light at the point itself is finite.
    let there = punctual(point.map(|c| c as f32), 1.0);
    set_lights(&mut data, &[there], &[1.0]);
    assert!(
        estimate(&data, &(Point, ()), normal, 2, 137)
            .value()
            .is_finite()
    );
}

/// Cones down to a ten-thousandth of a degree, with soft and with hard edges, beside the formula of KHR_lights_punctual in
/// 64 bits.
#[test]
fn narrow_spots_fall_off_as_wide_ones() {
    let mut data = scene(&[FLOOR]);
    let to = [0.0_f32, 0.0, 0.0];
    for outer in [1.5, 0.5, 0.05, 0.019, 4e-3, 1e-4, 2e-6_f32] {
        for inner in [0.0, 0.5, 0.999, 1.0].map(|share| share * outer) {
            for share in [0.0, 0.3, 0.7, 0.99, 1.01, 1.5] {
                // Off the axis by this share of the cone, 10 away.
                let angle = share * f64::from(outer);
                let position = [10.0 * angle.sin(), 0.0, 10.0 * angle.cos()].map(|c| c as f32);
                let axis = [0.0, 0.0, -1.0];
                let spot = PunctualRecord::spot(0, position, [100.0; 3], axis, [inner, outer]);
                set_lights(&mut data, &[spot], &[1.0]);
                let buffers = data.buffers();
                let d = Scalar::new(&buffers);
                let sample = Spot.sample(d, Uint(0), to.into(), [0.5; 3]);
                let versine = |angle: f64| 2.0 * (angle / 2.0).sin().powi(2);
                let [full, edge] = [inner, outer].map(|angle| versine(angle.into()));
                let exact = match inner == outer {
                    true => f64::from(u8::from(share < 1.0)),
                    false => ((edge - versine(angle)) / (edge - full))
                        .clamp(0.0, 1.0)
                        .powi(2),
                };
                // A ramp as steep as that is all rounding in its middle.
                let is_ramp = inner > 0.99 * outer && inner < outer && exact > 0.0 && exact < 1.0;
                let found = f64::from(sample.radiance.x);
                let bound = if is_ramp { 1.0 } else { 1e-3 };
                assert!(
                    (found - exact).abs() <= bound,
                    "{inner} {outer} {share}: {found} {exact}"
                );
            }
        }
    }
}

#[test]
fn lights_are_picked_by_their_weights() {
    let mut data = scene(&[FLOOR]);
    let weights = [5.0, 0.0, 1.0, 2.5, 0.01, 40.0, 3.0];
    let records: Vec<_> = (0..7)
        .map(|k| punctual([0.0, 0.0, 1.0], k as f32 + 1.0))
        .collect();
    set_lights(&mut data, &records, &weights);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = floor(d);
    let mut rng = Rng::new(160);
    let (mut counts, n) = (vec![0.0; 7], 400_000.0);
    let total: f64 = weights.iter().sum();
    for _ in 0..n as usize {
        let sample = light::sample(d, &(Directional, ()), surface.point, [rng.unit(), 0.5, 0.5]);
        let light = sample.radiance.x as usize - 1;
        counts[light] += 1.0;
        assert!((f64::from(sample.pdf) - weights[light] / total).abs() < 1e-7);
        assert_eq!(sample.pdf, light::pick_probability(d, Uint(light as u32)));
    }
    let expected: Vec<_> = weights.iter().map(|w| w / total * n).collect();
    assert!(
        chi_squared(&counts, &expected) > 0.001,
        "{counts:?} {expected:?}"
    );
    // Kinds: the number in the record decides.
    let second = PunctualRecord {
        kind: 1,
        ..punctual([0.0, 0.0, 2.0], 7.0)
    };
    set_lights(&mut data, &[second], &[1.0]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let sample = light::sample(d, &(Directional, (Point, ())), floor(d).point, [0.5; 3]);
    assert!(!sample.infinite && (f64::from(sample.radiance.x) - 1.75).abs() < 1e-6);
}

#[test]
fn power_heuristic_weighs_to_one() {
    let data = scene(&[]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let weigh = |a: f32, b: f32| power_heuristic(d, a, b);
    let table = [
        (1.0, 0.0, 1.0),
        (f32::INFINITY, 1.0, 1.0),
        (1.0, f32::INFINITY, 0.0),
        (1e30, 1e30, 0.5),
        (1e-30, 1e-30, 0.5),
        (1e30, 1e-30, 1.0),
        (1e-30, 1e30, 0.0),
        (2.0, 1.0, 0.8),
        (1.0, 3.0, 0.1),
    ];
    for (a, b, weight) in table {
        assert!(
            (weigh(a, b) - weight).abs() < 1e-7,
            "{a} {b}: {}",
            weigh(a, b)
        );
    }
    let mut rng = Rng::new(161);
    for _ in 0..200_000 {
        let (a, b) = (
            rng.signed_power(-60.0, 60.0).abs(),
            rng.signed_power(-60.0, 60.0).abs(),
        );
        let sum = f64::from(weigh(a, b)) + f64::from(weigh(b, a));
        assert!(
            (sum - 1.0).abs() <= 2.0 * f64::from(f32::EPSILON),
            "{a} {b}: {sum}"
        );
    }
}

/// Well-spread points are well spread over each light. With numbers of their own for the place, counts would differ from the
/// expected ones by ten.
#[test]
fn places_on_each_light_are_as_evenly_spread_as_the_points() {
    let mut data = scene(&[FLOOR]);
    let records: Vec<_> = (0..3).map(|_| punctual([0.0, 0.0, 1.0], 1.0)).collect();
    set_lights(&mut data, &records, &[1.0, 2.0, 5.0]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let points = 1024;
    let mut counts = [[0; 4]; 3];
    for index in 0..points {
        let key = SampleKey {
            pixel: Uint(77),
            index: Uint(index),
        };
        let picked = light::pick(d, Sobol.pair(d, key, Uint(5)));
        let light = picked.record.0 / light::LIGHT_WORDS;
        let [x, y] = picked.place.map(|x| usize::from(x >= 0.5));
        counts[light as usize][2 * x + y] += 1;
    }
    for (counts, weight) in counts.iter().zip([1.0, 2.0, 5.0]) {
        let expected = f64::from(points) * weight / 8.0 / 4.0;
        for count in counts {
            assert!(
                (f64::from(*count) - expected).abs() <= 4.0,
                "{counts:?} {expected}"
            );
        }
    }
}

/// Where picking leaves no digits of the first number, places are uniform all the same.
#[test]
fn places_are_uniform_on_each_of_many_lights() {
    let mut data = scene(&[FLOOR]);
    let lights = 1 << 20;
    set_lights(
        &mut data,
        &vec![punctual([0.0, 0.0, 1.0], 1.0); lights],
        &vec![1.0; lights],
    );
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let mut rng = Rng::new(161);
    let mut counts = vec![0.0; 256];
    let n = 200_000;
    for _ in 0..n {
        let place = light::pick(d, [rng.unit(), rng.unit()]).place;
        assert!(place.iter().all(|x| (0.0..1.0).contains(x)));
        let [x, y] = place.map(|x| (x * 16.0) as usize);
        counts[16 * x + y] += 1.0;
    }
    let expected = vec![f64::from(n) / 256.0; 256];
    assert!(chi_squared(&counts, &expected) > 0.001, "{counts:?}");
}
