//! Maps from the unit square to the domains that are sampled.

use super::elementary::sincos_turns;
use super::vec3::{Vec3, vec3};
use crate::domain::Domain;

/// 1/π.
pub const FRAC_1_PI: f64 = std::f64::consts::FRAC_1_PI;

/// A uniformly distributed point of the unit disc.
#[inline(always)]
pub fn disc<D: Domain>(d: D, u: [D::F; 2]) -> [D::F; 2] {
    let (sin, cos) = sincos_turns(d, u[1]);
    let r = d.sqrt(u[0]);
    [r * cos, r * sin]
}

/// A direction on the hemisphere around +z with density cos θ/π: above a point of the disc (Malley's method).
#[inline(always)]
pub fn cosine_hemisphere<D: Domain>(d: D, u: [D::F; 2]) -> Vec3<D::F> {
    let [x, y] = disc(d, u);
    vec3(x, y, d.sqrt(d.lit(1.0) - u[0]))
}

/// Density of [`cosine_hemisphere`], per steradian.
#[inline(always)]
pub fn cosine_hemisphere_pdf<D: Domain>(d: D, cos: D::F) -> D::F {
    cos * d.lit(FRAC_1_PI)
}

/// Barycentric coordinates (u, v) of a uniformly distributed point of a triangle (Heitz 2019,
/// "A Low-Distortion Map Between Triangle and Square").
#[inline(always)]
pub fn triangle<D: Domain>(d: D, u: [D::F; 2]) -> (D::F, D::F) {
    let half = d.lit(0.5);
    let below = d.lt(u[0], u[1]);
    let x = u[0] * d.select(below, half, d.lit(1.0)) - d.select(below, d.lit(0.0), u[1] * half);
    let y = u[1] * d.select(below, d.lit(1.0), half) - d.select(below, u[0] * half, d.lit(0.0));
    (x, y)
}
