//! The GGX microfacet distribution with height-correlated Smith masking, and metals made of it.
//!
//! D is evaluated from the half vector's components, never from 1 − cos²θ, which cancels (hard case M-01).
//! Visible normals are sampled by spherical caps (Dupuy and Benyoub 2023).

use super::{Bsdf, BsdfKind, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::elementary::sincos_turns;
use crate::math::vec3::vec3;
use crate::math::warp::FRAC_1_PI;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// The smallest α: roughness below 0.01 is rendered as 0.01.
pub const MIN_ALPHA: f64 = 1e-4;

/// A GGX distribution of unit half-angle slope α.
#[derive(Clone, Copy, Debug)]
pub struct Ggx<F> {
    alpha: F,
}

impl<F: crate::domain::Real> Ggx<F> {
    /// From perceptual roughness in [0, 1]: α = roughness² (glTF 2.0, appendix B.2).
    #[inline(always)]
    pub fn from_roughness<D: Domain<F = F>>(d: D, roughness: F) -> Self {
        Self {
            alpha: d.max(roughness * roughness, d.lit(MIN_ALPHA)),
        }
    }

    /// Density of microfacet normals, per steradian, projected area normalised to 1.
    #[inline(always)]
    pub fn distribution<D: Domain<F = F>>(&self, d: D, h: Vec3<F>) -> F {
        let alpha2 = self.alpha * self.alpha;
        let t = d.fma(h.z, h.z, d.fma(h.x, h.x, h.y * h.y) / alpha2);
        d.lit(FRAC_1_PI) / (alpha2 * t * t)
    }

    /// Smith's Λ.
    #[inline(always)]
    pub fn lambda<D: Domain<F = F>>(&self, d: D, w: Vec3<F>) -> F {
        let tan2 = d.fma(w.x, w.x, w.y * w.y) / d.max(w.z * w.z, d.lit(1e-30));
        let x = self.alpha * self.alpha * tan2;
        // (√(1 + x) − 1)/2 without cancellation.
        d.lit(0.5) * x / (d.sqrt(d.lit(1.0) + x) + d.lit(1.0))
    }

    /// A normal visible from `wo`.
    #[inline(always)]
    pub fn sample_visible_normal<D: Domain<F = F>>(&self, d: D, wo: Vec3<F>, u: [F; 2]) -> Vec3<F> {
        let one = d.lit(1.0);
        let stretched = vec3(wo.x * self.alpha, wo.y * self.alpha, wo.z).normalize(d);
        let (sin, cos) = sincos_turns(d, u[0]);
        let z = d.fma(one - u[1], one + stretched.z, -stretched.z);
        let r = d.sqrt(d.max(one - z * z, d.lit(0.0)));
        let cap = vec3(
            d.fma(r, cos, stretched.x),
            d.fma(r, sin, stretched.y),
            z + stretched.z,
        );
        vec3(
            cap.x * self.alpha,
            cap.y * self.alpha,
            d.max(cap.z, d.lit(1e-9)),
        )
        .normalize_any(d)
    }

    /// Reflection by mirror-like facets: f·cos ÷ Fresnel, and the density of sampling by visible normals.
    /// `h` is the half vector. Both are 0 where either direction is below the surface.
    #[inline(always)]
    pub fn reflection<D: Domain<F = F>>(
        &self,
        d: D,
        wo: Vec3<F>,
        wi: Vec3<F>,
        h: Vec3<F>,
    ) -> (F, F) {
        let zero = d.lit(0.0);
        let one = d.lit(1.0);
        let above = d.lt(zero, wo.z) & d.lt(zero, wi.z);
        let common = self.distribution(d, h) / (d.lit(4.0) * d.max(wo.z, d.lit(1e-9)));
        let out = one + self.lambda(d, wo);
        let value = common / (out + self.lambda(d, wi));
        (
            d.select(above, value, zero),
            d.select(above, common / out, zero),
        )
    }

    /// G₂/G₁: the weight of a sampled reflection ÷ Fresnel.
    #[inline(always)]
    pub fn sample_weight<D: Domain<F = F>>(&self, d: D, wo: Vec3<F>, wi: Vec3<F>) -> F {
        let out = d.lit(1.0) + self.lambda(d, wo);
        let weight = out / (out + self.lambda(d, wi));
        d.select(d.lt(d.lit(0.0), wi.z), weight, d.lit(0.0))
    }
}

/// `v` mirrored about the unit normal `h`.
#[inline(always)]
pub fn reflect<D: Domain>(d: D, v: Vec3<D::F>, h: Vec3<D::F>) -> Vec3<D::F> {
    h.scale(d.lit(2.0) * v.dot(d, h)) - v
}

/// Cosine between either of two directions and their half vector `h`; `sum` is theirs. The same for both to the
/// last bit, which their scalar products with `h` are not at grazing angles (hard case M-05).
#[inline(always)]
pub fn half_cosine<D: Domain>(d: D, sum: Vec3<D::F>, h: Vec3<D::F>) -> D::F {
    d.lit(0.5) * sum.dot(d, h)
}

/// (1 − cos)⁵, Schlick's weight.
#[inline(always)]
pub fn schlick_weight<D: Domain>(d: D, cos: D::F) -> D::F {
    let m = d.max(d.lit(1.0) - cos, d.lit(0.0));
    let m2 = m * m;
    m2 * m2 * m
}

/// A metal: GGX reflection whose Fresnel factor goes from `color` to 1 (glTF 2.0, appendix B.3.5, conductor).
#[derive(Clone, Copy, Debug)]
pub struct Conductor<C, R> {
    /// Reflectance at normal incidence.
    pub color: C,
    /// Perceptual roughness.
    pub roughness: R,
}

#[inline(always)]
fn conductor_fresnel<D: Domain>(d: D, color: Color<D::F>, cos: D::F) -> Color<D::F> {
    color.lerp(Vec3::splat(d.lit(1.0)), schlick_weight(d, cos))
}

impl<D: Domain, C: ColorSource<D>, R: ScalarSource<D>> Bsdf<D> for Conductor<C, R> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let ggx = Ggx::from_roughness(d, self.roughness.scalar(d, surface));
        let sum = wo + wi;
        let h = sum.normalize_any(d);
        let (value, pdf) = ggx.reflection(d, wo, wi, h);
        let cos = half_cosine(d, sum, h);
        let fresnel = conductor_fresnel(d, self.color.color(d, surface), cos);
        BsdfValue {
            value: fresnel.scale(value),
            pdf,
        }
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let ggx = Ggx::from_roughness(d, self.roughness.scalar(d, surface));
        let h = ggx.sample_visible_normal(d, wo, [u[0], u[1]]);
        let wi = reflect(d, wo, h);
        let fresnel = conductor_fresnel(d, self.color.color(d, surface), d.abs(wo.dot(d, h)));
        let (_, pdf) = ggx.reflection(d, wo, wi, h);
        BsdfSample {
            wi,
            weight: fresnel.scale(ggx.sample_weight(d, wo, wi)),
            pdf,
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        conductor_fresnel(d, self.color.color(d, surface), wo.z)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
