//! Lambert's diffuse reflection, and the surface that reflects nothing.

use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::vec3::vec3;
use crate::math::warp::{FRAC_1_PI, cosine_hemisphere, cosine_hemisphere_pdf};
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::ColorSource;

/// Diffuse reflection: f = albedo/π on both sides.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse<C> {
    /// Albedo, in [0, 1].
    pub albedo: C,
}

impl<D: Domain, C: ColorSource<D>> Bsdf<D> for Diffuse<C> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, _: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let cos = d.max(wi.z, d.lit(0.0));
        BsdfValue {
            value: self.albedo.color(d, surface).scale(cos * d.lit(FRAC_1_PI)),
            pdf: cosine_hemisphere_pdf(d, cos),
        }
    }

    #[inline(always)]
    fn propose(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let wi = cosine_hemisphere(d, [u[0], u[1]]);
        BsdfProposal::of_lobe(d, wi, d.lt(d.lit(0.0), wi.z))
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let BsdfProposal { wi, .. } = self.propose(d, surface, wo, u);
        BsdfSample {
            wi,
            weight: self.albedo.color(d, surface),
            pdf: cosine_hemisphere_pdf(d, wi.z),
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, _: Vec3<D::F>) -> Color<D::F> {
        self.albedo.color(d, surface)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}

/// Reflects nothing: light sources with a black base colour.
#[derive(Clone, Copy, Debug)]
pub struct Black;

impl<D: Domain> Bsdf<D> for Black {
    #[inline(always)]
    fn eval(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, _: Vec3<D::F>) -> BsdfValue<D> {
        BsdfValue::zero(d)
    }

    #[inline(always)]
    fn propose(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, _: [D::F; 3]) -> BsdfProposal<D> {
        let up = vec3(d.lit(0.0), d.lit(0.0), d.lit(1.0));
        BsdfProposal::of_lobe(d, up, d.truth(false))
    }

    #[inline(always)]
    fn albedo(&self, d: D, _: &Surface<D>, _: Vec3<D::F>) -> Color<D::F> {
        Vec3::splat(d.lit(0.0))
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: false,
            delta: false,
        }
    }
}
