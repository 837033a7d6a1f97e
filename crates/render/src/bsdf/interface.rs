//! What lies behind a transmitting surface: a body, or nothing.

use crate::domain::Domain;
use crate::math::fresnel::fresnel;
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// What lies behind the surface.
pub trait Interface {
    /// Transmitted rays are refracted.
    fn refracts(&self) -> bool;

    /// What is around the body is known at each point ([`Surface::around`]), and may have another index than 1.
    #[inline(always)]
    fn may_be_within(&self) -> bool {
        false
    }
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

/// A body that may lie within others: rays refract between it and them.
#[derive(Clone, Copy, Debug)]
pub struct SolidAmongSolids;
impl Interface for SolidAmongSolids {
    #[inline(always)]
    fn refracts(&self) -> bool {
        true
    }

    #[inline(always)]
    fn may_be_within(&self) -> bool {
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
    /// [`SolidAmongSolids`].
    SolidAmongSolids,
    /// [`Thin`].
    Thin,
}
impl Interface for AnyInterface {
    #[inline(always)]
    fn refracts(&self) -> bool {
        match self {
            Self::Solid => Solid.refracts(),
            Self::SolidAmongSolids => SolidAmongSolids.refracts(),
            Self::Thin => Thin.refracts(),
        }
    }

    #[inline(always)]
    fn may_be_within(&self) -> bool {
        matches!(self, Self::SolidAmongSolids)
    }
}

/// Nearer to 1 than by this no ratio of indices gets: facets would bend light so little that their normals could not be told
/// from directions.
const LEAST_BEND: f64 = 1e-3;

/// Index of refraction of what lies beyond the surface relative to what lies before it, of a body of this index.
#[inline(always)]
pub(super) fn relative_ior<D: Domain>(
    d: D,
    surface: &Surface<D>,
    interface: &impl Interface,
    ior: D::F,
) -> D::F {
    let one = d.lit(1.0);
    if interface.may_be_within() {
        let ratio = ior / surface.around;
        let bend = ratio - one;
        let least = one + d.copysign(d.lit(LEAST_BEND), bend);
        let ratio = d.select(d.lt(d.abs(bend), d.lit(LEAST_BEND)), least, ratio);
        return d.select(surface.front, ratio, one / ratio);
    }
    // A sheet is entered from either side.
    if interface.refracts() {
        d.select(surface.front, ior, d.lit(1.0) / ior)
    } else {
        ior
    }
}

/// The squared index of refraction of what `wi` leads into, relative to the outside: see
/// [`Bsdf::radiance_scale`](super::Bsdf::radiance_scale).
#[inline(always)]
pub(super) fn radiance_scale<D: Domain>(
    d: D,
    surface: &Surface<D>,
    interface: &impl Interface,
    ior: D::F,
    wi_z: D::F,
) -> Option<D::F> {
    interface.refracts().then(|| {
        let (here, beyond) = (d.lt(d.lit(0.0), wi_z), d.lt(wi_z, d.lit(0.0)));
        let inside = (surface.front & beyond) | (!surface.front & here);
        let around = match interface.may_be_within() {
            true => surface.around * surface.around,
            false => d.lit(1.0),
        };
        d.select(inside, ior * ior, around)
    })
}

/// What a surface that absorbs nothing but by its tint seems to be coloured: what it reflects at an angle of this cosine, and
/// the tint of what passes.
#[inline(always)]
pub(super) fn clear_albedo<D: Domain>(
    d: D,
    cos: D::F,
    eta: D::F,
    tint: Color<D::F>,
) -> Color<D::F> {
    let (reflectance, _) = fresnel(d, cos, eta);
    tint.lerp(Vec3::splat(d.lit(1.0)), reflectance)
}
