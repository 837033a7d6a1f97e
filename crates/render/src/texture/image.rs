//! Image textures: nearest and bilinear, repeated, mirrored or clamped, in three texel formats.
//!
//! What an image is (its place among the texels, width, height) is data: a row of the material's parameter block.
//! How it is read (wrapping, filtering, format, coordinates) is structure: type parameters, for
//! which the `Any…` enumerations stand in where a renderer is interpreted.
//! Texel centres lie at half-integers; row 0 is at v = 0.

use super::params::{ImageParam, TransformParam};
use super::srgb;
use super::{ColorSource, ScalarSource};
use crate::domain::{Buffer, Domain};
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// How coordinates outside the image are read.
pub trait Wrapping {
    /// A whole texel number in [0, size) for a whole number `i`. `size` > 0.
    fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F;
}

/// Tiles.
#[derive(Clone, Copy, Debug)]
pub struct Repeat;
/// Tiles, every other one mirrored.
#[derive(Clone, Copy, Debug)]
pub struct MirroredRepeat;
/// The border goes on.
#[derive(Clone, Copy, Debug)]
pub struct Clamp;

/// i mod size for whole numbers. The quotient is rounded, so the result is clamped for |i| ≥ 2²⁴ and NaN.
#[inline(always)]
fn modulo<D: Domain>(d: D, i: D::F, size: D::F) -> D::F {
    let r = i - d.floor(i / size) * size;
    d.max(d.min(r, size - d.lit(1.0)), d.lit(0.0))
}

impl Wrapping for Repeat {
    #[inline(always)]
    fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F {
        modulo(d, i, size)
    }
}
impl Wrapping for MirroredRepeat {
    #[inline(always)]
    fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F {
        let double = size + size;
        let r = modulo(d, i, double);
        d.min(r, double - d.lit(1.0) - r)
    }
}
impl Wrapping for Clamp {
    #[inline(always)]
    fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F {
        d.max(d.min(i, size - d.lit(1.0)), d.lit(0.0))
    }
}

/// [`Wrapping`] chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AnyWrap {
    /// [`Repeat`].
    Repeat,
    /// [`MirroredRepeat`].
    MirroredRepeat,
    /// [`Clamp`].
    Clamp,
}

impl Wrapping for AnyWrap {
    #[inline(always)]
    fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F {
        match self {
            Self::Repeat => Repeat.wrap(d, i, size),
            Self::MirroredRepeat => MirroredRepeat.wrap(d, i, size),
            Self::Clamp => Clamp.wrap(d, i, size),
        }
    }
}

/// How a texel is stored.
pub trait TexelFormat {
    /// Words a texel.
    fn words(&self) -> u32;
    /// Red, green and blue of the texel that starts at a word.
    fn color<D: Domain>(&self, d: D, word: D::U) -> Color<D::F>;
    /// One channel, 0 red … 3 alpha, of the texel that starts at a word.
    fn channel<D: Domain>(&self, d: D, word: D::U, channel: u32) -> D::F;
}

/// Four bytes; colour is sRGB-encoded, alpha linear.
#[derive(Clone, Copy, Debug)]
pub struct SrgbRgba8;
/// Four linear bytes.
#[derive(Clone, Copy, Debug)]
pub struct LinearRgba8;
/// Four linear `f32`.
#[derive(Clone, Copy, Debug)]
pub struct LinearFloat;

#[inline(always)]
fn byte<D: Domain>(d: D, texel: D::U, channel: u32) -> D::U {
    (texel >> (8 * channel)) & d.uint(0xff)
}
#[inline(always)]
fn unorm<D: Domain>(d: D, texel: D::U, channel: u32) -> D::F {
    d.to_real(byte(d, texel, channel)) * d.lit(1.0 / 255.0)
}

impl TexelFormat for SrgbRgba8 {
    #[inline(always)]
    fn words(&self) -> u32 {
        1
    }
    #[inline(always)]
    fn color<D: Domain>(&self, d: D, word: D::U) -> Color<D::F> {
        let texel = d.load(Buffer::Texels, word);
        let [r, g, b] = [0, 1, 2].map(|k| srgb::decode(d, byte(d, texel, k)));
        vec3(r, g, b)
    }
    #[inline(always)]
    fn channel<D: Domain>(&self, d: D, word: D::U, channel: u32) -> D::F {
        let texel = d.load(Buffer::Texels, word);
        if channel == 3 {
            unorm(d, texel, 3)
        } else {
            srgb::decode(d, byte(d, texel, channel))
        }
    }
}
impl TexelFormat for LinearRgba8 {
    #[inline(always)]
    fn words(&self) -> u32 {
        1
    }
    #[inline(always)]
    fn color<D: Domain>(&self, d: D, word: D::U) -> Color<D::F> {
        let texel = d.load(Buffer::Texels, word);
        let [r, g, b] = [0, 1, 2].map(|k| unorm(d, texel, k));
        vec3(r, g, b)
    }
    #[inline(always)]
    fn channel<D: Domain>(&self, d: D, word: D::U, channel: u32) -> D::F {
        unorm(d, d.load(Buffer::Texels, word), channel)
    }
}
impl TexelFormat for LinearFloat {
    #[inline(always)]
    fn words(&self) -> u32 {
        4
    }
    #[inline(always)]
    fn color<D: Domain>(&self, d: D, word: D::U) -> Color<D::F> {
        let [texel] = d.load_rows(Buffer::Texels, word);
        Vec3::from_row(d, texel)
    }
    #[inline(always)]
    fn channel<D: Domain>(&self, d: D, word: D::U, channel: u32) -> D::F {
        d.load_real(Buffer::Texels, word + d.uint(channel))
    }
}

/// [`TexelFormat`] chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AnyFormat {
    /// [`SrgbRgba8`].
    SrgbRgba8,
    /// [`LinearRgba8`].
    LinearRgba8,
    /// [`LinearFloat`].
    LinearFloat,
}

impl TexelFormat for AnyFormat {
    #[inline(always)]
    fn words(&self) -> u32 {
        match self {
            Self::SrgbRgba8 => SrgbRgba8.words(),
            Self::LinearRgba8 => LinearRgba8.words(),
            Self::LinearFloat => LinearFloat.words(),
        }
    }
    #[inline(always)]
    fn color<D: Domain>(&self, d: D, word: D::U) -> Color<D::F> {
        match self {
            Self::SrgbRgba8 => SrgbRgba8.color(d, word),
            Self::LinearRgba8 => LinearRgba8.color(d, word),
            Self::LinearFloat => LinearFloat.color(d, word),
        }
    }
    #[inline(always)]
    fn channel<D: Domain>(&self, d: D, word: D::U, channel: u32) -> D::F {
        match self {
            Self::SrgbRgba8 => SrgbRgba8.channel(d, word, channel),
            Self::LinearRgba8 => LinearRgba8.channel(d, word, channel),
            Self::LinearFloat => LinearFloat.channel(d, word, channel),
        }
    }
}

/// How texels are combined.
pub trait Filtering {
    /// Combines `texel(x, y)`, which takes whole, unwrapped texel numbers, at the continuous position (x, y).
    fn filter<D: Domain, T: Copy>(
        &self,
        d: D,
        x: D::F,
        y: D::F,
        texel: impl Fn(D::F, D::F) -> T,
        lerp: impl Fn(T, T, D::F) -> T,
    ) -> T;
}

/// The nearest texel.
#[derive(Clone, Copy, Debug)]
pub struct Nearest;
/// Bilinear.
#[derive(Clone, Copy, Debug)]
pub struct Bilinear;

impl Filtering for Nearest {
    #[inline(always)]
    fn filter<D: Domain, T: Copy>(
        &self,
        d: D,
        x: D::F,
        y: D::F,
        texel: impl Fn(D::F, D::F) -> T,
        _: impl Fn(T, T, D::F) -> T,
    ) -> T {
        texel(d.floor(x), d.floor(y))
    }
}
impl Filtering for Bilinear {
    #[inline(always)]
    fn filter<D: Domain, T: Copy>(
        &self,
        d: D,
        x: D::F,
        y: D::F,
        texel: impl Fn(D::F, D::F) -> T,
        lerp: impl Fn(T, T, D::F) -> T,
    ) -> T {
        let (x, y) = (x - d.lit(0.5), y - d.lit(0.5));
        let (x0, y0) = (d.floor(x), d.floor(y));
        let (x1, y1) = (x0 + d.lit(1.0), y0 + d.lit(1.0));
        let top = lerp(texel(x0, y0), texel(x1, y0), x - x0);
        let bottom = lerp(texel(x0, y1), texel(x1, y1), x - x0);
        lerp(top, bottom, y - y0)
    }
}

/// [`Filtering`] chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AnyFilter {
    /// [`Nearest`].
    Nearest,
    /// [`Bilinear`].
    Bilinear,
}

impl Filtering for AnyFilter {
    #[inline(always)]
    fn filter<D: Domain, T: Copy>(
        &self,
        d: D,
        x: D::F,
        y: D::F,
        texel: impl Fn(D::F, D::F) -> T,
        lerp: impl Fn(T, T, D::F) -> T,
    ) -> T {
        match self {
            Self::Nearest => Nearest.filter(d, x, y, texel, lerp),
            Self::Bilinear => Bilinear.filter(d, x, y, texel, lerp),
        }
    }
}

/// Which texture coordinates are read, and through which affine map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvMap {
    /// 0 or 1.
    pub set: usize,
    /// Offset of a [`TransformParam`] in the parameter block. `None` is the identity.
    pub transform: Option<u32>,
}

impl UvMap {
    #[inline(always)]
    pub(super) fn apply<D: Domain>(&self, d: D, surface: &Surface<D>) -> [D::F; 2] {
        let [u, v] = surface.uv[self.set];
        match self.transform {
            None => [u, v],
            Some(offset) => {
                let first = surface.params + d.uint(offset);
                let transform = TransformParam::load_at(d, Buffer::Params, first);
                let apply = |row: Vec3<D::F>| d.fma(row.x, u, d.fma(row.y, v, row.z));
                [apply(transform.u), apply(transform.v)]
            }
        }
    }
}

/// An image texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Image<U, V, F, T> {
    /// Offset of an [`ImageParam`] in the parameter block.
    pub slot: u32,
    /// Coordinates.
    pub uv: UvMap,
    /// The channel, 0 red … 3 alpha, read when a number is asked for.
    pub channel: u32,
    /// Wrapping along u and v.
    pub wrap: (U, V),
    /// Filter.
    pub filter: F,
    /// Texel format.
    pub format: T,
}

impl<U: Wrapping, V: Wrapping, F: Filtering, T: TexelFormat> Image<U, V, F, T> {
    #[inline(always)]
    fn sample<D: Domain, S: Copy>(
        &self,
        d: D,
        surface: &Surface<D>,
        fetch: impl Fn(D::U) -> S,
        lerp: impl Fn(S, S, D::F) -> S,
    ) -> S {
        let slot = surface.params + d.uint(self.slot);
        let ImageParam {
            first,
            width,
            height,
        } = ImageParam::load_at(d, Buffer::Params, slot);
        let (columns, rows) = (d.to_real(width), d.to_real(height));
        let [u, v] = self.uv.apply(d, surface);
        let texel = |x: D::F, y: D::F| {
            let x = d.to_uint(self.wrap.0.wrap(d, x, columns));
            let y = d.to_uint(self.wrap.1.wrap(d, y, rows));
            fetch(first + (y * width + x) * d.uint(self.format.words()))
        };
        self.filter.filter(d, u * columns, v * rows, texel, lerp)
    }
}

impl<D: Domain, U: Wrapping, V: Wrapping, F: Filtering, T: TexelFormat> ColorSource<D>
    for Image<U, V, F, T>
{
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        self.sample(
            d,
            surface,
            |word| self.format.color(d, word),
            |a, b, t| a.lerp(b, t),
        )
    }
}

impl<D: Domain, U: Wrapping, V: Wrapping, F: Filtering, T: TexelFormat> ScalarSource<D>
    for Image<U, V, F, T>
{
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        let fetch = |word| self.format.channel(d, word, self.channel);
        self.sample(d, surface, fetch, |a, b, t| a + (b - a) * t)
    }
}
