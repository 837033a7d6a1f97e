//! The modified Phong lobe (Lafortune and Willems 1994, "Using the Modified Phong Reflectance Model for
//! Physically Based Rendering"): what OBJ's `Ks` and `Ns` mean.

use super::{Bsdf, BsdfKind, BsdfProposal, BsdfValue};
use crate::domain::Domain;
use crate::math::elementary::{pow, sincos_turns};
use crate::math::vec3::vec3;
use crate::math::{Color, Frame, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// f = color·(n + 2)/2π·cosⁿ of the angle to the mirrored direction.
#[derive(Clone, Copy, Debug)]
pub struct Phong<C, E> {
    /// Reflectance at normal incidence.
    pub color: C,
    /// Exponent n ≥ 0.
    pub exponent: E,
}

impl<D: Domain, C: ColorSource<D>, E: ScalarSource<D>> Bsdf<D> for Phong<C, E> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let n = self.exponent.scalar(d, surface);
        let cos = d.max(vec3(-wo.x, -wo.y, wo.z).dot(d, wi), d.lit(0.0));
        let lobe = pow(d, cos, n) * d.lit(0.5 * std::f64::consts::FRAC_1_PI);
        let value = lobe * (n + d.lit(2.0)) * wi.z;
        let pdf = lobe * (n + d.lit(1.0));
        BsdfValue {
            value: self.color.color(d, surface).scale(value),
            pdf,
        }
        .only(d, d.lt(d.lit(0.0), wi.z))
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let n = self.exponent.scalar(d, surface);
        let one = d.lit(1.0);
        let cos = pow(d, one - u[0], one / (n + one));
        let sin = d.sqrt(d.max(one - cos * cos, d.lit(0.0)));
        let (s, c) = sincos_turns(d, u[1]);
        let around = Frame::around(d, vec3(-wo.x, -wo.y, wo.z));
        let wi = around.to_world(vec3(sin * c, sin * s, cos));
        BsdfProposal::of_lobe(d, wi, d.lt(d.lit(0.0), wi.z))
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, _: Vec3<D::F>) -> Color<D::F> {
        self.color.color(d, surface)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
