//! The GGX microfacet distribution with height-correlated Smith masking, as wide along the tangent as across it or not.
//!
//! D is evaluated from the half vector's components, never from 1 − cos²θ, which cancels (hard case M-01).
//! Visible normals are sampled by spherical caps (Dupuy and Benyoub 2023), for reflections by smaller ones (Eto and Tokuyoshi 2023).

use crate::domain::Domain;
use crate::math::Vec3;
use crate::math::elementary::sincos_turns;
use crate::math::vec3::vec3;
use crate::math::warp::FRAC_1_PI;

/// The smallest α: roughness below 0.01 is rendered as 0.01.
pub const MIN_ALPHA: f64 = 1e-4;

/// A GGX distribution.
#[derive(Clone, Copy, Debug)]
pub struct Ggx<F> {
    /// The slope α along the tangent and along the bitangent, at least [`MIN_ALPHA`].
    alpha: [F; 2],
}

impl<F: crate::domain::Real> Ggx<F> {
    /// From perceptual roughness in [0, 1]: α = roughness² (glTF 2.0, appendix B.2).
    #[inline(always)]
    pub fn from_roughness<D: Domain<F = F>>(d: D, roughness: F) -> Self {
        Self {
            alpha: [d.max(roughness * roughness, d.lit(MIN_ALPHA)); 2],
        }
    }

    /// As from roughness, and stretched along the tangent by `anisotropy` in [0, 1]: there α goes to 1
    /// (KHR_materials_anisotropy).
    #[inline(always)]
    pub fn anisotropic<D: Domain<F = F>>(d: D, roughness: F, anisotropy: F) -> Self {
        let across = roughness * roughness;
        let along = d.fma(anisotropy * anisotropy, d.lit(1.0) - across, across);
        Self {
            alpha: [along, across].map(|alpha| d.max(alpha, d.lit(MIN_ALPHA))),
        }
    }

    /// α of an isotropic distribution that reflects about as much.
    #[inline(always)]
    pub fn mean_alpha<D: Domain<F = F>>(&self, d: D) -> F {
        d.sqrt(self.alpha[0] * self.alpha[1])
    }

    /// Density of microfacet normals, per steradian, projected area normalised to 1.
    #[inline(always)]
    pub fn distribution<D: Domain<F = F>>(&self, d: D, h: Vec3<F>) -> F {
        let (x, y) = (h.x / self.alpha[0], h.y / self.alpha[1]);
        let t = d.fma(h.z, h.z, d.fma(x, x, y * y));
        d.lit(FRAC_1_PI) / (self.alpha[0] * self.alpha[1] * t * t)
    }

    /// Smith's Λ.
    #[inline(always)]
    pub fn lambda<D: Domain<F = F>>(&self, d: D, w: Vec3<F>) -> F {
        let (x, y) = (w.x * self.alpha[0], w.y * self.alpha[1]);
        // α²·tan² of the angle with the normal.
        let x = d.fma(x, x, y * y) / d.max(w.z * w.z, d.lit(1e-30));
        // (√(1 + x) − 1)/2 without cancellation.
        d.lit(0.5) * x / (d.sqrt(d.lit(1.0) + x) + d.lit(1.0))
    }

    /// A normal visible from `wo`.
    #[inline(always)]
    pub fn sample_visible_normal<D: Domain<F = F>>(&self, d: D, wo: Vec3<F>, u: [F; 2]) -> Vec3<F> {
        let stretched = self.stretched(wo).normalize(d);
        self.sample_cap(d, stretched, stretched.z, u)
    }

    /// A normal visible from `wo`, of those that may reflect light from above the surface: others are left out as far as a
    /// bound on them knows (Eto and Tokuyoshi 2023, "Bounded VNDF sampling for Smith–GGX reflections").
    #[inline(always)]
    pub fn sample_reflecting_normal<D: Domain<F = F>>(
        &self,
        d: D,
        wo: Vec3<F>,
        u: [F; 2],
    ) -> Vec3<F> {
        let stretched = self.stretched(wo).normalize(d);
        self.sample_cap(d, stretched, self.bound(d, wo) * stretched.z, u)
    }

    /// A direction as it is where facets are turned evenly.
    #[inline(always)]
    fn stretched(&self, w: Vec3<F>) -> Vec3<F> {
        vec3(w.x * self.alpha[0], w.y * self.alpha[1], w.z)
    }

    /// How deep the cap of mirrored directions reaches that [`sample_reflecting_normal`](Self::sample_reflecting_normal) draws
    /// from, as a part of the whole.
    #[inline(always)]
    fn bound<D: Domain<F = F>>(&self, d: D, wo: Vec3<F>) -> F {
        let one = d.lit(1.0);
        let across = one + d.sqrt(d.fma(wo.x, wo.x, wo.y * wo.y));
        let across2 = across * across;
        let alpha = d.min(d.min(self.alpha[0], self.alpha[1]), one);
        let alpha2 = alpha * alpha;
        (one - alpha2) * across2 / d.fma(alpha2 * wo.z, wo.z, across2)
    }

    /// A normal halfway between a stretched direction and one of those above −`depth`, uniformly.
    #[inline(always)]
    fn sample_cap<D: Domain<F = F>>(
        &self,
        d: D,
        stretched: Vec3<F>,
        depth: F,
        u: [F; 2],
    ) -> Vec3<F> {
        let one = d.lit(1.0);
        let (sin, cos) = sincos_turns(d, u[0]);
        let z = d.fma(one - u[1], one + depth, -depth);
        let r = d.sqrt(d.max(one - z * z, d.lit(0.0)));
        let cap = vec3(
            d.fma(r, cos, stretched.x),
            d.fma(r, sin, stretched.y),
            z + stretched.z,
        );
        vec3(
            cap.x * self.alpha[0],
            cap.y * self.alpha[1],
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
        let above = are_above(d, wo, wi);
        let common = self.distribution(d, h) / (d.lit(4.0) * d.max(wo.z, d.lit(1e-9)));
        let out = one + self.lambda(d, wo);
        let value = common / (out + self.lambda(d, wi));
        (
            d.select(above, value, zero),
            d.select(above, common / out, zero),
        )
    }

    /// The same, and the density of sampling by [`sample_reflecting_normal`](Self::sample_reflecting_normal).
    #[inline(always)]
    pub fn bounded_reflection<D: Domain<F = F>>(
        &self,
        d: D,
        wo: Vec3<F>,
        wi: Vec3<F>,
        h: Vec3<F>,
    ) -> (F, F) {
        let zero = d.lit(0.0);
        let above = are_above(d, wo, wi);
        let distribution = self.distribution(d, h);
        let masking = d.lit(1.0) + self.lambda(d, wo) + self.lambda(d, wi);
        let value = distribution / (d.lit(4.0) * d.max(wo.z, d.lit(1e-9)) * masking);
        let density = distribution / (d.lit(2.0) * self.bounded_area(d, wo));
        (d.select(above, value, zero), d.select(above, density, zero))
    }

    /// The weight of a reflection by [`sample_reflecting_normal`](Self::sample_reflecting_normal) ÷ Fresnel.
    #[inline(always)]
    pub fn bounded_weight<D: Domain<F = F>>(&self, d: D, wo: Vec3<F>, wi: Vec3<F>) -> F {
        let masking = d.lit(1.0) + self.lambda(d, wo) + self.lambda(d, wi);
        let facing = d.lit(2.0) * d.max(wo.z, d.lit(1e-9));
        let weight = self.bounded_area(d, wo) / (facing * masking);
        d.select(d.lt(d.lit(0.0), wi.z), weight, d.lit(0.0))
    }

    /// Twice the projected area of what [`sample_reflecting_normal`](Self::sample_reflecting_normal) draws from.
    #[inline(always)]
    fn bounded_area<D: Domain<F = F>>(&self, d: D, wo: Vec3<F>) -> F {
        let stretched = self.stretched(wo);
        let length = d.sqrt(stretched.dot(d, stretched));
        d.max(d.fma(self.bound(d, wo), wo.z, length), d.lit(1e-9))
    }

    /// G₂/G₁: the weight of a sampled reflection ÷ Fresnel.
    #[inline(always)]
    pub fn sample_weight<D: Domain<F = F>>(&self, d: D, wo: Vec3<F>, wi: Vec3<F>) -> F {
        let out = d.lit(1.0) + self.lambda(d, wo);
        let weight = out / (out + self.lambda(d, wi));
        d.select(d.lt(d.lit(0.0), wi.z), weight, d.lit(0.0))
    }
}

/// Whether both directions are above the surface.
#[inline(always)]
pub fn are_above<D: Domain>(d: D, wo: Vec3<D::F>, wi: Vec3<D::F>) -> D::M {
    d.lt(d.lit(0.0), wo.z) & d.lt(d.lit(0.0), wi.z)
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
