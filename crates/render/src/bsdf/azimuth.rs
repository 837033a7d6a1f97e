//! A frame that is turned about the normal, so that a direction has no y.

use crate::domain::{Domain, Real};
use crate::math::Vec3;
use crate::math::vec3::vec3;

/// The turn that takes the tangent to a direction's projection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Azimuth<F> {
    cos: F,
    sin: F,
}

impl<F: Real> Azimuth<F> {
    /// That of a direction; none of one along the normal.
    #[inline(always)]
    pub(super) fn of<D: Domain<F = F>>(d: D, direction: Vec3<F>) -> Self {
        let one = d.lit(1.0);
        let across = d.sqrt(d.fma(direction.x, direction.x, direction.y * direction.y));
        let slanted = d.lt(d.lit(1e-6), across);
        let inverse = one / d.select(slanted, across, one);
        Self {
            cos: d.select(slanted, direction.x * inverse, one),
            sin: d.select(slanted, direction.y * inverse, d.lit(0.0)),
        }
    }

    /// A vector in the turned frame.
    #[inline(always)]
    pub(super) fn turned<D: Domain<F = F>>(self, d: D, v: Vec3<F>) -> Vec3<F> {
        vec3(
            d.fma(v.x, self.cos, v.y * self.sin),
            d.fma(v.y, self.cos, -(v.x * self.sin)),
            v.z,
        )
    }

    /// A vector of the turned frame.
    #[inline(always)]
    pub(super) fn turned_back<D: Domain<F = F>>(self, d: D, v: Vec3<F>) -> Vec3<F> {
        vec3(
            d.fma(v.x, self.cos, -(v.y * self.sin)),
            d.fma(v.x, self.sin, v.y * self.cos),
            v.z,
        )
    }
}
