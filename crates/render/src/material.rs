//! Materials: programs that turn a surface point into a BSDF and emitted light.

use crate::bsdf::Bsdf;
use crate::domain::{Buffer, Domain};
use crate::math::{Color, Vec3};
use crate::surface::{Attributes, Surface};

/// What a material says about one point.
#[derive(Clone, Copy, Debug)]
pub struct Shading<F, B> {
    /// Emitted radiance towards `wo`, if the material emits at all.
    pub emission: Option<Color<F>>,
    /// How it scatters.
    pub bsdf: B,
}

/// A material program. Emitted programs return concrete types, interpreted ones boxed nodes.
pub trait Material<D: Domain> {
    /// The vertex attributes that are read.
    fn attributes(&self) -> Attributes;

    /// Index of the medium behind the surface, if it is the surface of a body and the scene has media.
    #[inline(always)]
    fn interior(&self, _d: D, _surface: &Surface<D>) -> Option<D::U> {
        None
    }

    /// Whether the surface bends wavelengths differently.
    #[inline(always)]
    fn disperses(&self) -> bool {
        false
    }

    /// Whether textures are filtered over what a ray stands for.
    #[inline(always)]
    fn filters(&self) -> bool {
        false
    }

    /// Evaluates the inputs at a point, seen from the unit direction `wo`; may replace the shading normal.
    fn shade<'a>(
        &'a self,
        d: D,
        surface: &mut Surface<D>,
        wo: Vec3<D::F>,
    ) -> Shading<D::F, impl Bsdf<D> + 'a>
    where
        D: 'a;
}

/// The index of a medium in a material's parameter block.
#[inline(always)]
pub fn medium<D: Domain>(d: D, surface: &Surface<D>, offset: u32) -> D::U {
    d.load(Buffer::Params, surface.params + d.uint(offset))
}

/// Emission that leaves from the front only.
#[inline(always)]
pub fn front_only<D: Domain>(d: D, surface: &Surface<D>, emission: Color<D::F>) -> Color<D::F> {
    emission.only(d, surface.front)
}
