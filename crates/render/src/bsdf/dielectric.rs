//! A smooth dielectric: glass, water, or a thin sheet of either.

use super::{Bsdf, BsdfKind, BsdfSample, BsdfValue};
use crate::domain::{Bundle, Domain};
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// What lies behind the surface.
pub trait Interface {
    /// Transmitted rays are refracted.
    fn refracts(&self) -> bool;
}

/// A body: rays refract in and out of it.
#[derive(Clone, Copy, Debug)]
pub struct Solid;
impl Interface for Solid {
    #[inline(always)]
    fn refracts(&self) -> bool {
        true
    }
}

/// A sheet without thickness: what is transmitted goes straight on (KHR_materials_transmission without volume).
#[derive(Clone, Copy, Debug)]
pub struct Thin;
impl Interface for Thin {
    #[inline(always)]
    fn refracts(&self) -> bool {
        false
    }
}

/// [`Interface`] chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AnyInterface {
    /// [`Solid`].
    Solid,
    /// [`Thin`].
    Thin,
}
impl Interface for AnyInterface {
    #[inline(always)]
    fn refracts(&self) -> bool {
        match self {
            Self::Solid => Solid.refracts(),
            Self::Thin => Thin.refracts(),
        }
    }
}

/// A smooth dielectric surface: delta reflection and delta transmission, chosen by the Fresnel factor.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric<C, I, K> {
    /// Tint of the transmitted light.
    pub transmittance: C,
    /// Index of refraction of the inside relative to the outside.
    pub ior: I,
    /// What lies behind the surface.
    pub interface: K,
}

impl<C, I, K: Interface> Dielectric<C, I, K> {
    /// Index of refraction of what lies beyond the surface relative to what lies before it.
    #[inline(always)]
    fn eta<D: Domain>(&self, d: D, surface: &Surface<D>) -> D::F
    where
        I: ScalarSource<D>,
    {
        let ior = self.ior.scalar(d, surface);
        // A sheet is entered from either side.
        if self.interface.refracts() {
            d.select(surface.front, ior, d.lit(1.0) / ior)
        } else {
            ior
        }
    }
}

/// Fresnel reflectance of unpolarised light and the quantity √(η² − 1 + cos²), η times the cosine of the
/// refracted ray; `cos` ≥ 0, `eta` = index beyond ÷ index here. On total reflection (1, 0).
///
/// Written without cancellation near η = 1 (hard case M-06).
#[inline(always)]
pub fn fresnel<D: Domain>(d: D, cos: D::F, eta: D::F) -> (D::F, D::F) {
    let one = d.lit(1.0);
    let q = (eta - one) * (eta + one);
    let c2 = cos * cos;
    let g2 = q + c2;
    let total = d.le(g2, d.lit(0.0));
    let g = d.sqrt(d.max(g2, d.lit(0.0)));
    let eta2 = eta * eta;
    let perpendicular = cos + g;
    let parallel = d.fma(eta2, cos, g);
    let rs = q / (perpendicular * perpendicular);
    let rp = q * d.fma(eta2 + one, c2, -one) / (parallel * parallel);
    let reflectance = d.lit(0.5) * d.fma(rs, rs, rp * rp);
    (
        d.select(total, one, d.min(reflectance, one)),
        d.select(total, d.lit(0.0), g),
    )
}

impl<D: Domain, C: ColorSource<D>, I: ScalarSource<D>, K: Interface> Bsdf<D>
    for Dielectric<C, I, K>
{
    #[inline(always)]
    fn eval(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, _: Vec3<D::F>) -> BsdfValue<D> {
        BsdfValue::zero(d)
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let one = d.lit(1.0);
        let eta = self.eta(d, surface);
        let (reflectance, g) = fresnel(d, wo.z, eta);
        let reflected = vec3(-wo.x, -wo.y, wo.z);
        let tint = self.transmittance.color(d, surface);
        let (transmitted, weight) = if self.interface.refracts() {
            // Radiance is squeezed into a cone narrower by η² (Veach 1997, section 5.2).
            let scale = one / (eta * eta);
            (
                vec3(-wo.x / eta, -wo.y / eta, -(g / eta)),
                tint.scale(scale),
            )
        } else {
            (-wo, tint)
        };
        let mirror = d.lt(u[2], reflectance);
        BsdfSample {
            wi: Vec3::choose(d, mirror, reflected, transmitted),
            weight: Vec3::choose(d, mirror, Vec3::splat(one), weight),
            pdf: d.lit(0.0),
            delta: d.truth(true),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let (reflectance, _) = fresnel(d, wo.z, self.eta(d, surface));
        self.transmittance
            .color(d, surface)
            .lerp(Vec3::splat(d.lit(1.0)), reflectance)
    }

    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        self.interface.refracts().then(|| {
            let ior = self.ior.scalar(d, surface);
            let (here, beyond) = (d.lt(d.lit(0.0), wi.z), d.lt(wi.z, d.lit(0.0)));
            let inside = (surface.front & beyond) | (!surface.front & here);
            d.select(inside, ior * ior, d.lit(1.0))
        })
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: false,
            delta: true,
        }
    }
}
