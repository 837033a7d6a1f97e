//! The phase function of Henyey and Greenstein (1941): how small particles scatter light.

use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::elementary::sincos_turns;
use crate::math::vec3::vec3;
use crate::math::warp::FRAC_1_PI;
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// The phase function, for a BSDF at a place within a medium: its value has no cosine in it. Its number is the mean cosine
/// between the directions before and after a scattering, in (−1, 1). The frame's z axis is `wo`.
#[derive(Clone, Copy, Debug)]
pub struct HenyeyGreenstein<F>(pub F);

impl<F> HenyeyGreenstein<F> {
    /// Density per steradian at a cosine to the direction before.
    #[inline(always)]
    fn density<D: Domain<F = F>>(self, d: D, cos: F) -> F
    where
        F: crate::domain::Real,
    {
        let g = self.0;
        let (one, size) = (d.lit(1.0), d.abs(g));
        let away = one - size;
        // (1 + g² − 2g·cos) without the cancellation of either end.
        let square = away * away + d.lit(2.0) * size * (one - d.copysign(one, g) * cos);
        let square = d.max(square, d.lit(1e-12));
        (one - g * g) * d.lit(0.25 * FRAC_1_PI) / (square * d.sqrt(square))
    }
}

impl<D: Domain> Bsdf<D> for HenyeyGreenstein<D::F> {
    #[inline(always)]
    fn eval(&self, d: D, _: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let density = self.density(d, -wo.dot(d, wi));
        BsdfValue {
            value: Vec3::splat(density),
            pdf: density,
        }
    }

    /// The inverse of the distribution of cosines, of which g is cancelled, so that it may be 0.
    #[inline(always)]
    fn propose(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let (g, one, half) = (self.0, d.lit(1.0), d.lit(0.5));
        let a = d.lit(2.0) * u[0] - one;
        let (aa, gg) = (a * a, g * g);
        let above = a + half * g * (aa + d.lit(3.0)) + gg * a + half * g * gg * (aa - one);
        let below = one + g * a;
        let cos = above / d.max(below * below, d.lit(1e-12));
        let cos = d.max(d.min(cos, one), -one);
        let sin = d.sqrt(d.max(one - cos * cos, d.lit(0.0)));
        let (y, x) = sincos_turns(d, u[1]);
        BsdfProposal::of_lobe(d, vec3(sin * x, sin * y, -cos), d.truth(true))
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let BsdfProposal { wi, .. } = self.propose(d, surface, wo, u);
        BsdfSample {
            wi,
            weight: Vec3::splat(d.lit(1.0)),
            pdf: self.density(d, -wi.z),
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, _: &Surface<D>, _: Vec3<D::F>) -> Color<D::F> {
        Vec3::splat(d.lit(1.0))
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
