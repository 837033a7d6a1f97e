//! A thin sheet of a rough dielectric: a frosted pane.

use super::directional_albedo::DirectionalAlbedo;
use super::ggx::{Ggx, are_above, half_cosine, reflect};
use super::interface::clear_albedo;
use super::roughness::Roughness;
use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::{Bundle, Domain};
use crate::math::fresnel::fresnel;
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// A sheet without thickness, of microfacets that reflect and transmit. What it transmits is spread as what it reflects, on
/// the other side (KHR_materials_transmission without volume). What facets throw at one another is added in proportion to the
/// rest, as [`Glossy`](super::Glossy) does for facets that reflect everything: so a sheet that absorbs nothing loses nothing.
#[derive(Clone, Copy, Debug)]
pub struct RoughSheet<C, I, R> {
    /// Tint of the transmitted light.
    pub transmittance: C,
    /// Index of refraction.
    pub ior: I,
    /// How facets are turned.
    pub roughness: R,
}

/// The sheet at a point.
struct Facets<D: Domain> {
    ggx: Ggx<D::F>,
    ior: D::F,
    tint: Color<D::F>,
    /// How much brighter all events together are than the first.
    all: D::F,
}

/// What a facet does whose normal was drawn.
struct Event<D: Domain> {
    normal: Vec3<D::F>,
    /// Where light comes from that it reflects; what it transmits comes from below that.
    reflected: Vec3<D::F>,
    is_mirrored: D::M,
    /// Probability of that.
    share: D::F,
}

impl<D: Domain> Event<D> {
    #[inline(always)]
    fn direction(&self, d: D) -> Vec3<D::F> {
        let Vec3 { x, y, z } = self.reflected;
        Vec3::choose(d, self.is_mirrored, self.reflected, vec3(x, y, -z))
    }
}

impl<D: Domain> Facets<D> {
    #[inline(always)]
    fn event(&self, d: D, wo: Vec3<D::F>, u: [D::F; 3]) -> Event<D> {
        let h = self.ggx.sample_reflecting_normal(d, wo, [u[0], u[1]]);
        let (reflectance, _) = fresnel(d, d.max(wo.dot(d, h), d.lit(0.0)), self.ior);
        let is_mirrored = d.lt(u[2], reflectance);
        Event {
            normal: h,
            reflected: reflect(d, wo, h),
            is_mirrored,
            share: d.select(is_mirrored, reflectance, d.lit(1.0) - reflectance),
        }
    }
}

impl<C, I, R> RoughSheet<C, I, R> {
    #[inline(always)]
    fn facets<D: Domain>(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Facets<D>
    where
        C: ColorSource<D>,
        I: ScalarSource<D>,
        R: Roughness<D>,
    {
        let ggx = self.roughness.microfacets(d, surface);
        Facets {
            ggx,
            ior: self.ior.scalar(d, surface),
            tint: self.transmittance.color(d, surface),
            all: d.lit(1.0) / DirectionalAlbedo::new(d, &ggx, wo.z).white,
        }
    }
}

impl<D, C, I, R> Bsdf<D> for RoughSheet<C, I, R>
where
    D: Domain,
    C: ColorSource<D>,
    I: ScalarSource<D>,
    R: Roughness<D>,
{
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let facets = self.facets(d, surface, wo);
        let below = d.lt(wi.z, d.lit(0.0));
        let mirrored = vec3(wi.x, wi.y, d.abs(wi.z));
        let sum = wo + mirrored;
        let half = sum.normalize_any(d);
        let (value, pdf) = facets.ggx.bounded_reflection(d, wo, mirrored, half);
        let (reflectance, _) = fresnel(d, half_cosine(d, sum, half), facets.ior);
        let share = d.select(below, d.lit(1.0) - reflectance, reflectance);
        let white = Vec3::splat(d.lit(1.0));
        let color = Vec3::choose(d, below, facets.tint, white);
        BsdfValue {
            value: color.scale(value * share * facets.all),
            pdf: pdf * share,
        }
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let facets = self.facets(d, surface, wo);
        let event = facets.event(d, wo, u);
        BsdfProposal::of_lobe(d, event.direction(d), are_above(d, wo, event.reflected))
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let facets = self.facets(d, surface, wo);
        let event = facets.event(d, wo, u);
        let above = event.reflected;
        let (_, pdf) = facets.ggx.bounded_reflection(d, wo, above, event.normal);
        let white = Vec3::splat(d.lit(1.0));
        let color = Vec3::choose(d, event.is_mirrored, white, facets.tint);
        BsdfSample {
            wi: event.direction(d),
            weight: color.scale(facets.ggx.bounded_weight(d, wo, above) * facets.all),
            pdf: pdf * event.share,
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let tint = self.transmittance.color(d, surface);
        clear_albedo(d, wo.z, self.ior.scalar(d, surface), tint)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
