//! Diffuse transmission: paper, leaves, lamp shades.

use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::vec3::vec3;
use crate::math::warp::{FRAC_1_PI, cosine_hemisphere, cosine_hemisphere_pdf};
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::ColorSource;

/// Light that leaves on the other side in all directions: f = color/π (KHR_materials_diffuse_transmission).
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmission<C> {
    /// The share of light that passes, in [0, 1].
    pub color: C,
}

impl<D: Domain, C: ColorSource<D>> Bsdf<D> for DiffuseTransmission<C> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, _: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let cos = d.max(-wi.z, d.lit(0.0));
        BsdfValue {
            value: self.color.color(d, surface).scale(cos * d.lit(FRAC_1_PI)),
            pdf: cosine_hemisphere_pdf(d, cos),
        }
    }

    #[inline(always)]
    fn propose(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let w = cosine_hemisphere(d, [u[0], u[1]]);
        BsdfProposal::of_lobe(d, vec3(w.x, w.y, -w.z), d.lt(d.lit(0.0), w.z))
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let BsdfProposal { wi, .. } = self.propose(d, surface, wo, u);
        BsdfSample {
            wi,
            weight: self.color.color(d, surface),
            pdf: cosine_hemisphere_pdf(d, -wi.z),
            delta: d.truth(false),
        }
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
