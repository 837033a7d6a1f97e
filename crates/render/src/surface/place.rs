//! The place of a hit on its triangle.

use super::ray::SurfaceHit;
use crate::domain::Domain;
use crate::math::Vec3;
use crate::triangle::TriangleRecord;

/// The place of a hit on its triangle.
pub(super) struct Place<D: Domain> {
    /// Weights of the corners.
    pub(super) weights: [D::F; 3],
    pub(super) point: Vec3<D::F>,
    /// Bound on the rounding error of each component of `point`.
    pub(super) error: Vec3<D::F>,
    /// The triangle's normal; its length is twice the area.
    pub(super) normal: Vec3<D::F>,
    pub(super) triangle: TriangleRecord<D>,
}

impl<D: Domain> Place<D> {
    /// The bound on the error is γ₇ times the weighted magnitudes of the corners (Pharr, Jakob, Humphreys 2023,
    /// section 6.8.4).
    #[inline(always)]
    pub(super) fn new(d: D, hit: &SurfaceHit<D>) -> Self {
        let triangle = TriangleRecord::load(d, hit.prim);
        let weights = [d.lit(1.0) - hit.u - hit.v, hit.u, hit.v];
        let [a, b, c] = [triangle.a, triangle.b, triangle.c];
        let (wa, wb, wc) = (
            a.scale(weights[0]),
            b.scale(weights[1]),
            c.scale(weights[2]),
        );
        let magnitude = |v: Vec3<D::F>| v.map(|x| d.abs(x));
        let gamma = d.lit(7.0 * 5.960_464_5e-8 / (1.0 - 7.0 * 5.960_464_5e-8));
        Self {
            weights,
            point: wa + wb + wc,
            error: (magnitude(wa) + magnitude(wb) + magnitude(wc)).scale(gamma),
            normal: (b - a).cross(c - a),
            triangle,
        }
    }
}
