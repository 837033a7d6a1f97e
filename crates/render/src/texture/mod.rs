//! Textures: where the inputs of materials come from.
//!
//! A source gives a colour or a number for a point of a surface. Sources are types, so that a program made of
//! concrete ones contains nothing else; boxed, they are the interpreted tier's nodes. Inputs are evaluated once
//! per point, before the BSDF, and enter it as [`Bound`] values or, interpreted, as [`Input`] numbers.

mod checkerboard;
mod dispersive;
mod filtering;
mod image;
mod params;
mod srgb;
mod texel_format;
mod under_coat;
mod uv_map;
mod wrapping;

pub use checkerboard::Checkerboard;
pub use dispersive::Dispersive;
pub use filtering::{AnyFilter, Bilinear, Filtering, Nearest, Trilinear};
pub use image::Image;
pub use params::{ColorParam, ImageParam, TransformParam};
pub use srgb::{srgb_code, srgb_decoded, srgb_table};
pub use texel_format::{AnyFormat, LinearFloat, LinearHalf, LinearRgba8, SrgbRgba8, TexelFormat};
pub use under_coat::UnderCoat;
pub use uv_map::UvMap;
pub use wrapping::{
    AnyWrap, BlackBorder, Clamp, FlatBorder, MirroredRepeat, Repeat, WhiteBorder, Wrapping,
};

use crate::domain::{Buffer, Domain};
use crate::math::vec3::lit3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// Gives a colour for a point of a surface.
pub trait ColorSource<D: Domain> {
    /// The colour, linear Rec. 709.
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F>;
}

/// Gives a number for a point of a surface.
pub trait ScalarSource<D: Domain> {
    /// The number.
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F;
}

/// A colour or number printed into the program.
#[derive(Clone, Copy, Debug)]
pub struct Const<T>(pub T);

impl<D: Domain> ColorSource<D> for Const<[f32; 3]> {
    #[inline(always)]
    fn color(&self, d: D, _: &Surface<D>) -> Color<D::F> {
        lit3(d, self.0)
    }
}
impl<D: Domain> ScalarSource<D> for Const<f32> {
    #[inline(always)]
    fn scalar(&self, d: D, _: &Surface<D>) -> D::F {
        d.lit(f64::from(self.0))
    }
}

/// A colour or number read from the material's parameter block; the field is the word's offset.
#[derive(Clone, Copy, Debug)]
pub struct Param(pub u32);

impl<D: Domain> ColorSource<D> for Param {
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        let first = surface.params + d.uint(self.0);
        ColorParam::load_at(d, Buffer::Params, first).color
    }
}
impl<D: Domain> ScalarSource<D> for Param {
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        d.load_real(Buffer::Params, surface.params + d.uint(self.0))
    }
}

/// The interpolated vertex colour (`COLOR_0`); as a number, its alpha.
#[derive(Clone, Copy, Debug)]
pub struct VertexColor;

impl<D: Domain> ColorSource<D> for VertexColor {
    #[inline(always)]
    fn color(&self, _: D, surface: &Surface<D>) -> Color<D::F> {
        surface.color
    }
}
impl<D: Domain> ScalarSource<D> for VertexColor {
    #[inline(always)]
    fn scalar(&self, _: D, surface: &Surface<D>) -> D::F {
        surface.alpha
    }
}

/// The product of two sources.
#[derive(Clone, Copy, Debug)]
pub struct Product<A, B>(pub A, pub B);

impl<D: Domain, A: ColorSource<D>, B: ColorSource<D>> ColorSource<D> for Product<A, B> {
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        self.0.color(d, surface) * self.1.color(d, surface)
    }
}
impl<D: Domain, A: ScalarSource<D>, B: ScalarSource<D>> ScalarSource<D> for Product<A, B> {
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        self.0.scalar(d, surface) * self.1.scalar(d, surface)
    }
}

/// 1 where a number is at least another, else 0.
#[derive(Clone, Copy, Debug)]
pub struct AtLeast<A, B>(pub A, pub B);

impl<D: Domain, A: ScalarSource<D>, B: ScalarSource<D>> ScalarSource<D> for AtLeast<A, B> {
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        let is_least = d.le(self.1.scalar(d, surface), self.0.scalar(d, surface));
        d.select(is_least, d.lit(1.0), d.lit(0.0))
    }
}

/// low + (high − low)·at.
#[derive(Clone, Copy, Debug)]
pub struct Between<L, H, A> {
    /// The number where `at` is 0.
    pub low: L,
    /// The number where `at` is 1.
    pub high: H,
    /// Where between the two, in [0, 1].
    pub at: A,
}

impl<D, L, H, A> ScalarSource<D> for Between<L, H, A>
where
    D: Domain,
    L: ScalarSource<D>,
    H: ScalarSource<D>,
    A: ScalarSource<D>,
{
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        let low = self.low.scalar(d, surface);
        let range = self.high.scalar(d, surface) - low;
        d.fma(range, self.at.scalar(d, surface), low)
    }
}

/// A number as a grey colour.
#[derive(Clone, Copy, Debug)]
pub struct Gray<S>(pub S);

impl<D: Domain, S: ScalarSource<D>> ColorSource<D> for Gray<S> {
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        Vec3::splat(self.0.scalar(d, surface))
    }
}

/// An input that was evaluated already.
#[derive(Clone, Copy, Debug)]
pub struct Bound<T>(pub T);

impl<D: Domain> ColorSource<D> for Bound<Vec3<D::F>> {
    #[inline(always)]
    fn color(&self, _: D, _: &Surface<D>) -> Color<D::F> {
        self.0
    }
}

impl<D: Domain> ScalarSource<D> for Bound<D::F> {
    #[inline(always)]
    fn scalar(&self, _: D, _: &Surface<D>) -> D::F {
        self.0
    }
}

/// An input of a boxed program, by index: already evaluated into [`Surface::inputs`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Input(pub usize);

impl<D: Domain> ColorSource<D> for Input {
    #[inline(always)]
    fn color(&self, _: D, surface: &Surface<D>) -> Color<D::F> {
        surface.inputs[self.0]
    }
}
impl<D: Domain> ScalarSource<D> for Input {
    #[inline(always)]
    fn scalar(&self, _: D, surface: &Surface<D>) -> D::F {
        surface.inputs[self.0].x
    }
}
