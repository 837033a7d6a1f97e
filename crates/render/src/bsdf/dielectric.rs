//! A smooth dielectric: glass, water, or a thin sheet of either.

use super::interface::{Interface, clear_albedo, radiance_scale, relative_ior};
use super::{Bsdf, BsdfKind, BsdfProposal, BsdfValue};
use crate::domain::{Bundle, Domain};
use crate::math::fresnel::fresnel;
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

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
    #[inline(always)]
    fn eta<D: Domain>(&self, d: D, surface: &Surface<D>) -> D::F
    where
        I: ScalarSource<D>,
    {
        relative_ior(d, surface, &self.interface, self.ior.scalar(d, surface))
    }
}

impl<D: Domain, C: ColorSource<D>, I: ScalarSource<D>, K: Interface> Bsdf<D>
    for Dielectric<C, I, K>
{
    #[inline(always)]
    fn eval(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, _: Vec3<D::F>) -> BsdfValue<D> {
        BsdfValue::zero(d)
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
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
        BsdfProposal::of_delta(
            d,
            Vec3::choose(d, mirror, reflected, transmitted),
            Vec3::choose(d, mirror, Vec3::splat(one), weight),
        )
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let tint = self.transmittance.color(d, surface);
        clear_albedo(d, wo.z, self.eta(d, surface), tint)
    }

    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        let ior = self.ior.scalar(d, surface);
        radiance_scale(d, surface, &self.interface, ior, wi.z)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: false,
            delta: true,
        }
    }
}
