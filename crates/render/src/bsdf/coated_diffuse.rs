//! A dielectric coat over a diffuse base: glTF's dielectric, `fresnel_mix(diffuse, specular)` (glTF 2.0,
//! appendix B.3.5, with KHR_materials_specular and KHR_materials_ior).
//!
//! The formula is the specification's to the letter, its fault included: 1 − F(wo·h) leaves the base some light that
//! the coat has reflected already, so that a white surface returns too much of the light that grazes it (hard case
//! M-04; a test says how much). Layering by (1 − F(wo))(1 − F(wi)) was tried: it conserves energy, and makes rooms
//! 1 to 4 % darker than other renderers make them, since it takes rough coats for smooth ones.

use super::microfacet::{Ggx, half_cosine, reflect, schlick_weight};
use super::{Bsdf, BsdfKind, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::warp::{FRAC_1_PI, cosine_hemisphere, cosine_hemisphere_pdf};
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// GGX reflection over a diffuse base that receives what the Fresnel factor leaves.
#[derive(Clone, Copy, Debug)]
pub struct CoatedDiffuse<C, R, S, G> {
    /// Albedo of the base.
    pub albedo: C,
    /// Perceptual roughness of the coat.
    pub roughness: R,
    /// Fresnel factor at normal incidence.
    pub reflectance: S,
    /// Fresnel factor at grazing incidence.
    pub grazing: G,
}

/// The sources' values at one point.
struct Coat<D: Domain> {
    albedo: Color<D::F>,
    ggx: Ggx<D::F>,
    reflectance: Color<D::F>,
    grazing: D::F,
}

impl<D: Domain> Coat<D> {
    #[inline(always)]
    fn fresnel(&self, d: D, cos: D::F) -> Color<D::F> {
        self.reflectance
            .lerp(Vec3::splat(self.grazing), schlick_weight(d, cos))
    }

    /// The probability of sampling the coat: its share of the albedo seen from `wo`, at least a tenth, so that
    /// highlights of dark-seeming coats are found.
    #[inline(always)]
    fn coat_probability(&self, d: D, wo: Vec3<D::F>) -> D::F {
        let coat = self.fresnel(d, wo.z).max_component(d);
        let base = (d.lit(1.0) - coat) * self.albedo.max_component(d);
        d.max(coat / d.max(coat + base, d.lit(1e-9)), d.lit(0.1))
    }

    #[inline(always)]
    fn eval(&self, d: D, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let sum = wo + wi;
        let h = sum.normalize_any(d);
        let fresnel = self.fresnel(d, half_cosine(d, sum, h));
        let (coat, coat_pdf) = self.ggx.reflection(d, wo, wi, h);
        let cos = d.max(wi.z, d.lit(0.0));
        let base = (d.lit(1.0) - fresnel.max_component(d)) * cos * d.lit(FRAC_1_PI);
        let p = self.coat_probability(d, wo);
        BsdfValue {
            value: fresnel.scale(coat) + self.albedo.scale(base),
            pdf: d.fma(
                p,
                coat_pdf,
                (d.lit(1.0) - p) * cosine_hemisphere_pdf(d, cos),
            ),
        }
    }
}

impl<C, R, S, G> CoatedDiffuse<C, R, S, G> {
    #[inline(always)]
    fn coat<D: Domain>(&self, d: D, surface: &Surface<D>) -> Coat<D>
    where
        C: ColorSource<D>,
        R: ScalarSource<D>,
        S: ColorSource<D>,
        G: ScalarSource<D>,
    {
        Coat {
            albedo: self.albedo.color(d, surface),
            ggx: Ggx::from_roughness(d, self.roughness.scalar(d, surface)),
            reflectance: self.reflectance.color(d, surface),
            grazing: self.grazing.scalar(d, surface),
        }
    }
}

impl<D, C, R, S, G> Bsdf<D> for CoatedDiffuse<C, R, S, G>
where
    D: Domain,
    C: ColorSource<D>,
    R: ScalarSource<D>,
    S: ColorSource<D>,
    G: ScalarSource<D>,
{
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        self.coat(d, surface).eval(d, wo, wi)
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let coat = self.coat(d, surface);
        let direction = [u[0], u[1]];
        let wi = d.branch(
            d.lt(u[2], coat.coat_probability(d, wo)),
            || reflect(d, wo, coat.ggx.sample_visible_normal(d, wo, direction)),
            || cosine_hemisphere(d, direction),
        );
        let BsdfValue { value, pdf } = coat.eval(d, wo, wi);
        let possible = d.lt(d.lit(0.0), pdf);
        let inverse = d.lit(1.0) / d.select(possible, pdf, d.lit(1.0));
        BsdfSample {
            wi,
            weight: value.scale(inverse).only(d, possible),
            pdf,
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let coat = self.coat(d, surface);
        let fresnel = coat.fresnel(d, wo.z);
        let base = d.lit(1.0) - fresnel.max_component(d);
        fresnel + coat.albedo.scale(base)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
