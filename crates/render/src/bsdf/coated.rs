//! A layer over another: coats, sheen.

use super::combine::Blend;
use super::{Bsdf, BsdfKind, BsdfProposal, BsdfValue};
use crate::domain::Domain;
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// A coat, and what lies under it and receives what the coat does not return.
///
/// The base is scaled by 1 − the coat's albedo as seen from where the light goes, the largest of its components, so that
/// the two return no more light than arrives (Kulla and Conty Estevez 2017, "Revisiting physically based shading", albedo
/// scaling; with the largest component as in glTF 2.0, appendix B.3.5, where a coloured coat does not tint its base with
/// the complement). The formula of that appendix, 1 − F(wo·h), gains light at grazing angles. (1 − F(wo))(1 − F(wi)) gains
/// none, and makes rooms 1 to 4 % darker than other renderers do, since it takes rough coats for smooth ones.
#[derive(Clone, Copy, Debug)]
pub struct Coated<C, B> {
    /// The coat. Its [`Bsdf::albedo`] has to be the true share of light that returns.
    pub coat: C,
    /// What lies under it.
    pub base: B,
}

/// The least probability of sampling the coat, so that highlights of coats that seem dark are found.
const LEAST_COAT: f64 = 0.1;

impl<C, B> Coated<C, B> {
    #[inline(always)]
    fn blend<D: Domain>(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Blend<D::F>
    where
        C: Bsdf<D>,
        B: Bsdf<D>,
    {
        let one = d.lit(1.0);
        let coat = self.coat.albedo(d, surface, wo).max_component(d);
        let under = d.max(one - coat, d.lit(0.0));
        let base = under * self.base.albedo(d, surface, wo).max_component(d);
        let share = coat / d.max(coat + base, d.lit(1e-9));
        Blend {
            factor_a: under,
            factor_b: one,
            probability_b: d.min(d.max(share, d.lit(LEAST_COAT)), one),
        }
    }
}

impl<D: Domain, C: Bsdf<D>, B: Bsdf<D>> Bsdf<D> for Coated<C, B> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let base = self.base.eval(d, surface, wo, wi);
        let coat = self.coat.eval(d, surface, wo, wi);
        self.blend(d, surface, wo).eval(d, base, coat)
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        self.blend(d, surface, wo)
            .propose(d, surface, wo, u, (&self.base, &self.coat))
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let coat = self.coat.albedo(d, surface, wo);
        let under = d.max(d.lit(1.0) - coat.max_component(d), d.lit(0.0));
        coat + self.base.albedo(d, surface, wo).scale(under)
    }

    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        self.base.radiance_scale(d, surface, wi)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        self.coat.kind().union(self.base.kind())
    }
}
