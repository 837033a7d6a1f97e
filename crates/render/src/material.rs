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

/// A normal map's texel as a normal in the shading frame: 2·rgb − 1, x and y scaled (glTF 2.0, section 3.9.3).
#[inline(always)]
pub fn decode_normal<D: Domain>(d: D, rgb: Color<D::F>, scale: D::F) -> Vec3<D::F> {
    let [x, y, z] = [rgb.x, rgb.y, rgb.z].map(|c| d.fma(c, d.lit(2.0), d.lit(-1.0)));
    Vec3 {
        x: x * scale,
        y: y * scale,
        z,
    }
}

/// An anisotropy map's texel as a direction in the shading frame: 2·rg − 1, turned by an angle of this cosine and sine
/// (KHR_materials_anisotropy).
#[inline(always)]
pub fn decode_tangent<D: Domain>(d: D, rgb: Color<D::F>, [cos, sin]: [D::F; 2]) -> [D::F; 2] {
    let [x, y] = [rgb.x, rgb.y].map(|c| d.fma(c, d.lit(2.0), d.lit(-1.0)));
    [d.fma(x, cos, -(y * sin)), d.fma(x, sin, y * cos)]
}
