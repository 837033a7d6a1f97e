//! Triangles sampled by solid angle, against closed forms: needles, triangles far away, near, and seen edge-on among them.

use residual_render::domain::{Buffers, Domain, Precise, Scalar, Uint};
use residual_render::light::{self, AreaBySolidAngle, AreaBySolidAngleRecord, LightKind};
use residual_render::math::{SphericalTriangle, Vec3, warp};
use residual_render::surface::{Attributes, PathRay};
use residual_render::texture::Const;

use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, Triangle, floor, scene, set_lights, surface_at};
use crate::support::stats::{Family, Mean, chi_squared};
use crate::support::{Worst, array, cross, dot, unit};

const LAMP: AreaBySolidAngle<Const<[f32; 3]>> = AreaBySolidAngle {
    emission: Const([1.0; 3]),
    attributes: Attributes::NONE,
};

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn length(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

/// The normal, whose length is twice the area.
fn across(lamp: &Triangle) -> [f64; 3] {
    let [a, b, c] = lamp.map(|v| v.map(f64::from));
    cross(minus(b, a), minus(c, a))
}

fn record(lamp: &Triangle) -> AreaBySolidAngleRecord {
    AreaBySolidAngleRecord {
        kind: 0,
        triangle: 1,
        double_sided: 1,
        normal: across(lamp).map(|x| x as f32).into(),
    }
}

/// A triangle as it is seen from a point.
#[derive(Clone, Debug)]
struct Case {
    name: &'static str,
    lamp: Triangle,
    from: [f32; 3],
}

impl Case {
    /// The solid angle of the triangle with these corners relative to the point (Van Oosterom and Strackee 1983).
    fn solid_angle([a, b, c]: [[f64; 3]; 3]) -> f64 {
        let volume = dot(a, cross(minus(b, a), minus(c, a))).abs();
        let [la, lb, lc] = [a, b, c].map(length);
        let sum = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb;
        2.0 * volume.atan2(sum)
    }

    fn corners(&self) -> [[f64; 3]; 3] {
        let from = self.from.map(f64::from);
        self.lamp.map(|v| minus(v.map(f64::from), from))
    }

    /// How wrong `f32` may be, of the solid angle and of places. The point's height over the triangle's plane is a difference of numbers as
    /// large as the distance to the nearest corner, the sum of the directions to two corners one of unit vectors, and corners have weights of
    /// 24 bits. Where the first bound is more than 1e-3 the triangle is seen edge-on, and shines as much less, or the point all but touches an edge.
    fn bounds(&self) -> [f64; 2] {
        let corners = self.corners();
        let height = dot(corners[0], unit(across(&self.lamp))).abs();
        let nearest = corners
            .map(length)
            .into_iter()
            .fold(f64::INFINITY, f64::min);
        let farthest = corners.map(length).into_iter().fold(0.0, f64::max);
        let seen = corners.map(unit);
        let opposite = [[0, 1], [1, 2], [2, 0]].map(|[a, b]| 2.0 + 2.0 * dot(seen[a], seen[b]));
        let closest = opposite.into_iter().fold(1.0, f64::min).sqrt();
        let bound = 1e-6 * (nearest / height).max(1.0 / closest);
        [bound, 2.0 * bound.max(1e-6 * farthest / nearest)]
    }

    fn seen<D: Domain>(&self, d: D) -> SphericalTriangle<D> {
        let real = |x: f32| d.lit(f64::from(x));
        let vector = |v: [f32; 3]| Vec3::from(v.map(real));
        let normal = across(&self.lamp).map(|x| d.lit(x));
        SphericalTriangle::new(
            d,
            vector(self.from),
            self.lamp.map(vector),
            Vec3::from(normal),
        )
    }
}

/// `count` cases of each kind.
fn cases(count: usize, seed: u64) -> Vec<Case> {
    let mut rng = Rng::new(seed);
    let mut cases = Vec::new();
    for _ in 0..count {
        let power = |rng: &mut Rng, low, high| 10.0_f64.powf(rng.range(low, high));
        let around = |rng: &mut Rng, size: f64| [0; 3].map(|_| rng.range(-size, size));
        let mut add = |name, origin: [f64; 3], scale: f64, lamp: [[f64; 3]; 3], from: [f64; 3]| {
            let world = |v: [f64; 3]| [0, 1, 2].map(|k| (origin[k] + scale * v[k]) as f32);
            let mut lamp = lamp.map(world);
            lamp.rotate_left(cases.len() % 3);
            cases.push(Case {
                name,
                lamp,
                from: world(from),
            });
        };
        let here = [0.0; 3];
        let lamp = [0; 3].map(|_| around(&mut rng, 1.0));
        let from = around(&mut rng, 2.0);
        add("any", here, 1.0, lamp, from);
        // A place in front of the triangle, a part of its size away from it.
        let normal = unit(cross(minus(lamp[1], lamp[0]), minus(lamp[2], lamp[0])));
        let before =
            |place: [f64; 3], distance: f64| [0, 1, 2].map(|k| place[k] + normal[k] * distance);
        let mix = |weights: [f64; 3]| {
            [0, 1, 2].map(|k| (0..3).map(|i| lamp[i][k] * weights[i]).sum::<f64>())
        };
        let near = power(&mut rng, -3.0, 0.0);
        let scale = power(&mut rng, -3.0, 3.0);
        add(
            "near",
            here,
            scale,
            lamp,
            before(mix([0.2, 0.3, 0.5]), near),
        );
        let t = rng.range(0.0, 1.0);
        let on_edge = mix([1.0 - t, t, 0.0]);
        add("near an edge", here, scale, lamp, before(on_edge, near));
        add("near a corner", here, scale, lamp, before(lamp[0], near));
        let beyond = mix([1.0, 0.5, -0.5]);
        add("edge-on", here, scale, lamp, before(beyond, near));
        let distance = power(&mut rng, 1.0, 4.0);
        let far = around(&mut rng, distance);
        add("far away", here, scale, lamp, far);

        // A needle ten long, of any width, some way from its middle.
        let end = unit(around(&mut rng, 1.0)).map(|x| x * 10.0);
        let width = power(&mut rng, -4.0, -1.0);
        let side = unit(cross(end, around(&mut rng, 1.0))).map(|x| x * width);
        let tip = |s: f64| [0, 1, 2].map(|k| end[k] * s + side[k]);
        let share = rng.range(0.0, 1.0);
        let distance = power(&mut rng, -2.0, 1.0);
        let aside = around(&mut rng, distance);
        let from = [0, 1, 2].map(|k| end[k] * share + aside[k]);
        add("needle", here, 1.0, [here, end, tip(1.0)], from);
        add(
            "sliver",
            here,
            1.0,
            [here, end, tip(rng.range(0.0, 1.0))],
            from,
        );
        let origin = around(&mut rng, 100.0);
        add("off the origin", origin, 1.0, lamp, around(&mut rng, 2.0));
    }
    cases
}

/// How wrong the solid angle is, relatively, and how far the two numbers that a place is made of are from uniform ones.
fn errors<D: Domain>(d: D, case: &Case, rng: &mut Rng) -> [f64; 3]
where
    D::F: Into<f64>,
{
    let seen = case.seen(d);
    let corners = case.corners();
    let exact = Case::solid_angle(corners);
    let of_angle = (seen.solid_angle(d).into() / exact - 1.0).abs();
    let (mut of_edge, mut of_arc) = (0.0_f64, 0.0_f64);
    for _ in 0..20 {
        let u = [rng.unit(), rng.unit()].map(|x| d.lit(f64::from(x)));
        let (b1, b2) = warp::triangle(d, u);
        let place = seen.place(d, [b1, b2]).map(Into::<f64>::into);
        let away = 1.0 - b1.into();
        let along = b2.into() / away;
        if away < 1e-3 {
            continue;
        }
        // Where the line from the second corner through the place meets the opposite edge: up to there a uniform share of the
        // solid angle, and on that arc a uniform share of the cap around the corner.
        let [a, b, c] = corners;
        let on_edge = |t: f64| [0, 1, 2].map(|k| a[k] + (c[k] - a[k]) * t);
        let edge = on_edge(place[1] / (1.0 - place[0]));
        // Near the second corner it makes as much less of a difference.
        let share = Case::solid_angle([a, b, edge]) / exact - along;
        of_edge = of_edge.max(share.abs() * away);
        let at = [0, 1, 2].map(|k| b[k] * place[0] + edge[k] * (1.0 - place[0]));
        let cap = |p: [f64; 3]| {
            let chord = minus(unit(p), unit(b));
            dot(chord, chord)
        };
        of_arc = of_arc.max((cap(at) / cap(edge) - away * away).abs());
    }
    [of_angle, of_edge, of_arc]
}

#[test]
fn places_are_uniform_by_solid_angle() {
    let buffers = Buffers::EMPTY;
    let mut rng = Rng::new(401);
    let mut worst = [(); 6].map(|()| Worst::default());
    let mut in_bound = 0;
    let what = ["solid angle", "share of it", "share of the arc"];
    for case in cases(2000, 400) {
        let single = errors(Scalar::new(&buffers), &case, &mut rng);
        let double = errors(Precise::new(&buffers), &case, &mut rng);
        let [angle, place] = case.bounds();
        let single = [0, 1, 2].map(|k| single[k] / if k == 0 { angle } else { place });
        for (worst, error) in worst.iter_mut().zip([single, double].concat()) {
            worst.add(error, || format!("{}: {case:?}", case.name));
        }
        in_bound += usize::from(place < 1e-3);
    }
    assert!(in_bound * 10 > 18_000 * 9, "{in_bound}");
    for (k, worst) in worst.iter().enumerate() {
        // A sine is a polynomial of 1e-7 there, too, and near zero where half the solid angle is near π.
        let (bound, precision) = match k < 3 {
            true => (1.0, "f32, in terms of the bound"),
            false => (1e-5, "f64"),
        };
        worst.assert_below(bound, &format!("{}, {precision}", what[k % 3]));
    }
}

/// The vector irradiance of a triangle of radiance 1 by Lambert's formula: its part along any normal is the irradiance, with what comes from
/// behind negative.
fn lambert(corners: [[f64; 3]; 3]) -> [f64; 3] {
    let seen = corners.map(unit);
    let edges = [0, 1, 2].map(|k| {
        let (a, b) = (seen[k], seen[(k + 1) % 3]);
        let across = cross(a, b);
        let sine = length(across);
        across.map(|x| 0.5 * x / sine * sine.atan2(dot(a, b)))
    });
    [0, 1, 2].map(|k| edges[0][k] + edges[1][k] + edges[2][k])
}

#[test]
fn triangles_shine_as_lambert_says() {
    let mut rng = Rng::new(411);
    let mut family = Family::default();
    for case in cases(40, 410) {
        let mut data = scene(&[FLOOR, case.lamp]);
        set_lights(&mut data, &[record(&case.lamp)], &[1.0]);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let corners = case.corners();
        let exact = lambert(corners);
        // Which way it points depends on the order of the corners.
        let towards = unit(exact);
        let sign = dot(towards, unit(corners[0]))
            + dot(towards, unit(corners[1]))
            + dot(towards, unit(corners[2]));
        let towards = towards.map(|x| x * sign.signum());
        let mut mean = Mean::default();
        for _ in 0..4000 {
            let sample = LAMP.sample(d, Uint(0), case.from.into(), rng.unit3());
            let cos = dot(array(sample.wi).map(f64::from), towards);
            mean.add(f64::from(sample.radiance.x) * cos / f64::from(sample.pdf));
        }
        family.add_z(
            mean.z(length(exact), case.bounds()[1].max(1e-4)),
            format!("{case:?}"),
        );
    }
    family.assert_plausible();
}

/// Cells of a triangle get as many directions as they have of its solid angle.
#[test]
fn directions_are_uniform() {
    const SIDE: usize = 8;
    let buffers = Buffers::EMPTY;
    let d = Scalar::new(&buffers);
    let mut rng = Rng::new(421);
    let mut family = Family::default();
    for case in cases(20, 420) {
        let seen = case.seen(d);
        let (mut counts, mut expected) = (vec![0.0; SIDE * SIDE], vec![0.0; SIDE * SIDE]);
        let samples = 20_000;
        for _ in 0..samples {
            let (b1, b2) = warp::triangle(d, [rng.unit(), rng.unit()]);
            let [u, v] = seen.place(d, [b1, b2]);
            assert!(u >= 0.0 && v >= 0.0 && u + v <= 1.000_001, "{case:?}");
            // Strips along an edge, and sectors around the corner opposite.
            let away = (1.0 - u).clamp(0.0, 0.999_999);
            let along = (v / away.max(1e-9)).clamp(0.0, 0.999_999);
            let [i, j] = [away, along].map(|x| (x * SIDE as f32) as usize);
            counts[SIDE * i + j] += 1.0;
        }
        let corners = case.corners();
        let at = |away: usize, along: usize| {
            let [away, along] = [away, along].map(|k| k as f64 / SIDE as f64);
            let weights = [away * (1.0 - along), 1.0 - away, away * along];
            [0, 1, 2].map(|k| (0..3).map(|i| corners[i][k] * weights[i]).sum::<f64>())
        };
        let whole = Case::solid_angle(corners);
        for i in 0..SIDE {
            for j in 0..SIDE {
                let [a, b, c, e] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                let first = Case::solid_angle([a, b, c]);
                let second = if i == 0 {
                    0.0
                } else {
                    Case::solid_angle([a, c, e])
                };
                expected[SIDE * i + j] = (first + second) / whole * f64::from(samples);
            }
        }
        family.add(chi_squared(&counts, &expected), format!("{case:?}"));
    }
    family.assert_plausible();
}

/// A path that meets a light asks for the density with which the place that it comes from samples it.
#[test]
fn density_is_the_same_from_both_sides() {
    let mut rng = Rng::new(431);
    for case in cases(100, 430) {
        let mut data = scene(&[FLOOR, case.lamp]);
        set_lights(&mut data, &[record(&case.lamp)], &[1.0]);
        data.set_light(1, 0);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let sample = light::sample(d, &(LAMP, ()), case.from.into(), rng.unit3());
        let away = array(sample.wi).map(f64::from);
        let seen = surface_at(d, 1, [0.3, 0.3], away);
        let ray = PathRay::unbounded(d, case.from.into(), sample.wi);
        assert_eq!(
            sample.pdf,
            light::density(d, &(LAMP, ()), &ray, &seen),
            "{case:?}"
        );
        let exact = 1.0 / Case::solid_angle(case.corners());
        let error = (f64::from(sample.pdf) / exact - 1.0).abs();
        assert!(error < case.bounds()[0], "{case:?}: {error}");
    }
}

/// From the triangle's own plane nothing is seen of it, and all numbers are finite.
#[test]
fn points_in_the_plane_see_nothing() {
    let lamp: Triangle = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 2.0, 0.0]];
    let froms = [
        lamp[0],
        lamp[1],
        lamp[2],
        [0.0, -1.0, 0.0],
        [0.5, 0.5, 0.0],
        [0.0; 3],
        [3.0, 0.0, 0.0],
        [0.0, -1.001, 0.0],
    ];
    let mut data = scene(&[FLOOR, lamp]);
    set_lights(&mut data, &[record(&lamp)], &[1.0]);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let mut rng = Rng::new(440);
    for from in froms {
        for _ in 0..1000 {
            let sample = LAMP.sample(d, Uint(0), from.into(), rng.unit3());
            assert!(sample.pdf.is_finite() && sample.pdf > 0.0, "{from:?}");
            assert!(array(sample.wi).iter().all(|x| x.is_finite()), "{from:?}");
            assert_eq!(sample.radiance.x, 0.0, "{from:?}");
        }
    }
}

#[test]
fn one_side_or_both_shine() {
    let up: Triangle = [[-1.0, -1.0, 2.0], [1.0, -1.0, 2.0], [0.0, 1.0, 2.0]];
    let down: Triangle = [up[0], up[2], up[1]];
    let mut rng = Rng::new(450);
    for (lamp, double_sided, shines) in [(down, 0, true), (up, 0, false), (up, 1, true)] {
        let mut data = scene(&[FLOOR, lamp]);
        let record = AreaBySolidAngleRecord {
            double_sided,
            ..record(&lamp)
        };
        set_lights(&mut data, &[record], &[1.0]);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let sample = LAMP.sample(d, Uint(0), floor(d).point, rng.unit3());
        assert_eq!(sample.radiance.x > 0.0, shines, "{lamp:?} {double_sided}");
    }
}
