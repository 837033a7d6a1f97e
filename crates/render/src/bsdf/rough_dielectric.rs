//! A rough dielectric: frosted glass.

use super::fresnel::fresnel;
use super::ggx::{Ggx, half_cosine, reflect};
use super::interface::{Interface, radiance_scale, relative_ior};
use super::roughness::Roughness;
use super::{Bsdf, BsdfKind, BsdfSample, BsdfValue};
use crate::domain::{Bundle, Domain};
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// A dielectric surface of microfacets that reflect and transmit (Walter, Marschner, Li and Torrance 2007, "Microfacet models
/// for refraction through rough surfaces"; PBRT 4, section 9.7). What a thin sheet transmits is spread as what it reflects, on
/// the other side (KHR_materials_transmission). What facets throw at one another is lost.
#[derive(Clone, Copy, Debug)]
pub struct RoughDielectric<C, I, R, K> {
    /// Tint of the transmitted light.
    pub transmittance: C,
    /// Index of refraction of the inside relative to the outside, not within 1e-3 of 1.
    pub ior: I,
    /// How facets are turned.
    pub roughness: R,
    /// What lies behind the surface.
    pub interface: K,
}

/// The surface at a point.
struct Facets<'a, D: Domain, K> {
    ggx: Ggx<D::F>,
    /// Index of refraction beyond ÷ here.
    eta: D::F,
    tint: Color<D::F>,
    interface: &'a K,
}

impl<D: Domain, K: Interface> Facets<'_, D, K> {
    /// What facets transmit, over the density of their normals and all that depends on the tint; and the same over masking, as
    /// a density: the second number needs no masking of `wi`. `h` is the facet's normal.
    #[inline(always)]
    fn transmission(&self, d: D, wo: Vec3<D::F>, wi: Vec3<D::F>, h: Vec3<D::F>) -> (D::F, D::F) {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let (co, ci) = (wo.dot(d, h), wi.dot(d, h));
        let possible = d.lt(zero, co) & d.lt(ci, zero) & d.lt(wi.z, zero);
        let root = ci + co / self.eta;
        let measure = d.max(root * root, d.lit(1e-20));
        let common = self.ggx.distribution(d, h) * co * -ci / (measure * d.max(wo.z, d.lit(1e-9)));
        let (reflectance, _) = fresnel(d, d.max(co, zero), self.eta);
        let common = d.select(possible, common * (one - reflectance), zero);
        let out = one + self.ggx.lambda(d, wo);
        (common / (out + self.ggx.lambda(d, wi)), common / out)
    }

    #[inline(always)]
    fn eval(&self, d: D, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let zero = d.lit(0.0);
        let below = d.lt(wi.z, zero);
        let mirrored = vec3(wi.x, wi.y, d.abs(wi.z));
        let sum = wo + mirrored;
        let half = sum.normalize_any(d);
        let (value, pdf) = self.ggx.reflection(d, wo, mirrored, half);
        let (reflectance, _) = fresnel(d, half_cosine(d, sum, half), self.eta);
        let white = Vec3::splat(d.lit(1.0));
        if self.interface.refracts() {
            let (value, pdf) = (value * reflectance, pdf * reflectance);
            let h = (wo + wi.scale(self.eta)).normalize_any(d);
            let h = h.scale(d.copysign(d.lit(1.0), h.z));
            let (through, through_pdf) = self.transmission(d, wo, wi, h);
            let through = self.tint.scale(through / (self.eta * self.eta));
            BsdfValue {
                value: Vec3::choose(d, below, through, white.scale(value)),
                pdf: d.select(below, through_pdf, pdf),
            }
        } else {
            let passes = d.lit(1.0) - reflectance;
            let share = d.select(below, passes, reflectance);
            let color = Vec3::choose(d, below, self.tint, white);
            BsdfValue {
                value: color.scale(value * share),
                pdf: pdf * share,
            }
        }
    }

    #[inline(always)]
    fn sample(&self, d: D, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let h = self.ggx.sample_visible_normal(d, wo, [u[0], u[1]]);
        let co = d.max(wo.dot(d, h), zero);
        let (reflectance, g) = fresnel(d, co, self.eta);
        let mirror = d.lt(u[2], reflectance);
        let reflected = reflect(d, wo, h);
        let (_, reflected_pdf) = self.ggx.reflection(d, wo, reflected, h);
        let reflected_weight = self.ggx.sample_weight(d, wo, reflected);
        let (transmitted, weight, pdf) = if self.interface.refracts() {
            let inverse = one / self.eta;
            let wi = h.scale((co - g) * inverse) - wo.scale(inverse);
            let (through, pdf) = self.transmission(d, wo, wi, h);
            let possible = d.lt(zero, pdf);
            let weight = through / d.select(possible, pdf, one);
            (
                wi,
                d.select(possible, weight, zero) * inverse * inverse,
                pdf,
            )
        } else {
            let wi = vec3(reflected.x, reflected.y, -reflected.z);
            (wi, reflected_weight, reflected_pdf * (one - reflectance))
        };
        let white = Vec3::splat(reflected_weight);
        BsdfSample {
            wi: Vec3::choose(d, mirror, reflected, transmitted),
            weight: Vec3::choose(d, mirror, white, self.tint.scale(weight)),
            pdf: d.select(mirror, reflected_pdf * reflectance, pdf),
            delta: d.truth(false),
        }
    }
}

impl<C, I, R, K: Interface> RoughDielectric<C, I, R, K> {
    #[inline(always)]
    fn facets<D: Domain>(&self, d: D, surface: &Surface<D>) -> Facets<'_, D, K>
    where
        C: ColorSource<D>,
        I: ScalarSource<D>,
        R: Roughness<D>,
    {
        Facets {
            ggx: self.roughness.microfacets(d, surface),
            eta: relative_ior(d, surface, &self.interface, self.ior.scalar(d, surface)),
            tint: self.transmittance.color(d, surface),
            interface: &self.interface,
        }
    }
}

impl<D, C, I, R, K> Bsdf<D> for RoughDielectric<C, I, R, K>
where
    D: Domain,
    C: ColorSource<D>,
    I: ScalarSource<D>,
    R: Roughness<D>,
    K: Interface,
{
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        self.facets(d, surface).eval(d, wo, wi)
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        self.facets(d, surface).sample(d, wo, u)
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let facets = self.facets(d, surface);
        let (reflectance, _) = fresnel(d, wo.z, facets.eta);
        let white = Vec3::splat(d.lit(1.0));
        facets.tint.lerp(white, reflectance)
    }

    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        let ior = self.ior.scalar(d, surface);
        radiance_scale(d, surface, &self.interface, ior, wi.z)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
