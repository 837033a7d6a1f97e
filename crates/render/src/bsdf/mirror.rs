//! A perfect mirror.

use super::{Bsdf, BsdfKind, BsdfProposal, BsdfValue};
use crate::domain::Domain;
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::ColorSource;

/// Reflects into the mirrored direction alone, the same share of light from every angle.
#[derive(Clone, Copy, Debug)]
pub struct Mirror<C> {
    /// The share of light that is reflected, in [0, 1].
    pub reflectance: C,
}

impl<D: Domain, C: ColorSource<D>> Bsdf<D> for Mirror<C> {
    #[inline(always)]
    fn eval(&self, d: D, _: &Surface<D>, _: Vec3<D::F>, _: Vec3<D::F>) -> BsdfValue<D> {
        BsdfValue::zero(d)
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, _: [D::F; 3]) -> BsdfProposal<D> {
        let reflectance = self.reflectance.color(d, surface);
        BsdfProposal::of_delta(d, vec3(-wo.x, -wo.y, wo.z), reflectance)
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, _: Vec3<D::F>) -> Color<D::F> {
        self.reflectance.color(d, surface)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: false,
            delta: true,
        }
    }
}
