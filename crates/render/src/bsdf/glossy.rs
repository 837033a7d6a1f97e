//! Glossy reflection by microfacets: metals, and coats of dielectrics.

use super::directional_albedo::DirectionalAlbedo;
use super::fresnel::Fresnel;
use super::ggx::{Ggx, are_above, half_cosine, reflect};
use super::roughness::Roughness;
use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// GGX reflection (glTF 2.0, appendix B.3), and what facets throw at one another in proportion to it: rough surfaces that
/// absorb nothing lose nothing. The factor for the latter depends on where the light goes, so that the lobe is not
/// reciprocal; a path tracer does not need that.
#[derive(Clone, Copy, Debug)]
pub struct Glossy<F, R> {
    /// How much facets reflect.
    pub fresnel: F,
    /// How facets are turned.
    pub roughness: R,
}

impl<F, R> Glossy<F, R> {
    /// The facets, the normal of one that was drawn, and where light comes from that it reflects.
    #[inline(always)]
    fn event<D: Domain>(
        &self,
        d: D,
        surface: &Surface<D>,
        wo: Vec3<D::F>,
        u: [D::F; 3],
    ) -> (Ggx<D::F>, [Vec3<D::F>; 2])
    where
        R: Roughness<D>,
    {
        let ggx = self.roughness.microfacets(d, surface);
        let h = ggx.sample_reflecting_normal(d, wo, [u[0], u[1]]);
        (ggx, [h, reflect(d, wo, h)])
    }
}

impl<D: Domain, F: Fresnel<D>, R: Roughness<D>> Bsdf<D> for Glossy<F, R> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let ggx = self.roughness.microfacets(d, surface);
        let sum = wo + wi;
        let h = sum.normalize_any(d);
        let (value, pdf) = ggx.bounded_reflection(d, wo, wi, h);
        let fresnel = self.fresnel.reflectance(d, surface, half_cosine(d, sum, h));
        let curve = self.fresnel.curve(d, surface, wo.z);
        let all = DirectionalAlbedo::new(d, &ggx, wo.z).compensation(d, &curve);
        BsdfValue {
            value: (fresnel * all).scale(value),
            pdf,
        }
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let (_, [_, wi]) = self.event(d, surface, wo, u);
        BsdfProposal::of_lobe(d, wi, are_above(d, wo, wi))
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let (ggx, [h, wi]) = self.event(d, surface, wo, u);
        let fresnel = self.fresnel.reflectance(d, surface, d.abs(wo.dot(d, h)));
        let curve = self.fresnel.curve(d, surface, wo.z);
        let all = DirectionalAlbedo::new(d, &ggx, wo.z).compensation(d, &curve);
        let (_, pdf) = ggx.bounded_reflection(d, wo, wi, h);
        BsdfSample {
            wi,
            weight: (fresnel * all).scale(ggx.bounded_weight(d, wo, wi)),
            pdf,
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let ggx = self.roughness.microfacets(d, surface);
        let curve = self.fresnel.curve(d, surface, wo.z);
        let albedo = DirectionalAlbedo::new(d, &ggx, wo.z);
        albedo.of(&curve) * albedo.compensation(d, &curve)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
