//! Whether sampling by solid angle pays: how much less variance direct light has by it than by area, at points on the scene's surfaces.

use glam::DVec3;
use residual_render::domain::{Buffers, Precise};
use residual_render::math::{SphericalTriangle, warp};
use residual_render::scene_data::SceneData;

use super::equal_areas;

/// Points at which it is looked.
const POINTS: usize = 128;
/// Places on each light, the square of a number.
const PLACES: u32 = 16;

/// An emitting triangle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Emitter {
    /// Index among all lights.
    pub(super) light: usize,
    /// Corners.
    pub(super) corners: [DVec3; 3],
    /// Mean luminance of what it emits.
    pub(super) radiance: f64,
    /// Whether both sides emit.
    pub(super) double_sided: bool,
}

impl Emitter {
    /// The normal, whose length is twice the area.
    pub(super) fn across(&self) -> DVec3 {
        let [a, b, c] = self.corners;
        (b - a).cross(c - a)
    }
}

/// What light samples and BSDF samples bring together at one point.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    /// Mean of what each of the two brings.
    means: [f64; 2],
    /// Sum of their mean squares.
    square: f64,
}

impl Moments {
    /// Adds a part of all directions that has this solid angle, in which `light` arrives at this cosine; `pdf` is the density of light samples
    /// there. The surface is white and matte; both strategies are weighed by the power heuristic.
    fn add(&mut self, solid_angle: f64, light: f64, cos: f64, pdf: f64) {
        let of_bsdf = cos * std::f64::consts::FRAC_1_PI;
        let value = light * of_bsdf;
        let sum = pdf * pdf + of_bsdf * of_bsdf;
        for (mean, density) in self.means.iter_mut().zip([pdf, of_bsdf]) {
            let share = value * density * density / sum;
            *mean += share * solid_angle;
            self.square += share * share / density * solid_angle;
        }
    }

    fn mean(&self) -> f64 {
        self.means[0] + self.means[1]
    }

    fn variance(&self) -> f64 {
        let [a, b] = self.means;
        (self.square - a * a - b * b).max(0.0)
    }
}

/// By how many times direct light without shadows has more variance where places on triangles are sampled by area than where they are by
/// solid angle, relative to its mean. `pick` is the probability of a light at a point.
pub(super) fn gain(
    emitters: &[Emitter],
    pick: impl Fn(DVec3, usize) -> f64,
    data: &SceneData,
) -> f64 {
    let found: Vec<_> = points_on_surfaces(data)
        .flat_map(|(at, normal)| on_both_sides(emitters, &pick, at, normal))
        .filter(|[_, by_area]| by_area.mean() > 0.0)
        .collect();
    let mean = found.iter().map(|[_, by_area]| by_area.mean()).sum::<f64>() / found.len() as f64;
    let mut sums = [0.0; 2];
    for moments in &found {
        // Where hardly any direct light arrives there is other light.
        let scale = moments[1].mean() + DIM * mean;
        for (sum, moments) in sums.iter_mut().zip(moments) {
            *sum += moments.variance() / (scale * scale);
        }
    }
    let [by_solid_angle, by_area] = sums;
    match by_solid_angle > 0.0 {
        true => by_area / by_solid_angle,
        false => 1.0,
    }
}

/// What arrives besides, in terms of the mean.
const DIM: f64 = 0.1;

/// The moments at a point on a surface with this normal, and on one with the opposite, where triangles are sampled by solid angle and
/// by area.
fn on_both_sides(
    emitters: &[Emitter],
    pick: &impl Fn(DVec3, usize) -> f64,
    at: DVec3,
    normal: DVec3,
) -> [[Moments; 2]; 2] {
    let buffers = Buffers::EMPTY;
    let d = Precise::new(&buffers);
    let normals = [normal, -normal];
    let mut sides = [[Moments::default(); 2]; 2];
    for emitter in emitters {
        let corners = emitter.corners;
        let is_seen = normals.map(|normal| {
            let before = |corner: &DVec3| (*corner - at).dot(normal) > 0.0;
            corners.iter().any(before)
        });
        let across = emitter.across();
        let height = (at - corners[0]).dot(across);
        if height <= 0.0 && !emitter.double_sided {
            continue;
        }
        let vector = |v: DVec3| v.to_array().into();
        let seen = SphericalTriangle::new(d, vector(at), corners.map(vector), vector(across));
        let (solid_angle, probability) = (seen.solid_angle(d), pick(at, emitter.light));
        if !(solid_angle > 0.0 && probability > 0.0) {
            continue;
        }
        for [x, y] in places() {
            let (u, v) = warp::triangle(d, [x, y]);
            let [u, v] = seen.place(d, [u, v]);
            let place = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
            let away = place - at;
            let distance = away.length();
            let side = usize::from(away.dot(normal) <= 0.0);
            let cos = away.dot(normals[side]) / distance;
            if is_seen[side] && cos > 0.0 {
                // distance² / (cosine at the light · area)
                let by_area = distance.powi(3) * 2.0 / height.abs();
                let part = solid_angle / f64::from(PLACES);
                for (moments, density) in sides[side].iter_mut().zip([1.0 / solid_angle, by_area]) {
                    moments.add(part, emitter.radiance, cos, density * probability);
                }
            }
        }
    }
    sides
}

/// Places spread over the unit square.
fn places() -> impl Iterator<Item = [f64; 2]> {
    let side = PLACES.isqrt();
    (0..PLACES).map(move |k| [k % side, k / side].map(|i| (f64::from(i) + 0.5) / f64::from(side)))
}

/// Points that stand for equal parts of all area, with their normals.
fn points_on_surfaces(data: &SceneData) -> impl Iterator<Item = (DVec3, DVec3)> {
    // Spread evenly over the square (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences").
    let steps = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];
    let triangles = equal_areas::triangles(data, POINTS).into_iter();
    triangles.enumerate().map(move |(k, [a, b, c])| {
        let [x, y] = steps.map(|step: f64| (0.5 + step * k as f64).fract());
        let (x, y) = if x + y < 1.0 {
            (x, y)
        } else {
            (1.0 - x, 1.0 - y)
        };
        let (right, up) = (b - a, c - a);
        (
            a + right * x + up * y,
            right.cross(up).normalize_or(DVec3::Z),
        )
    })
}
