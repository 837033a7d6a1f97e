//! Image textures: an image, and how it is read.
//!
//! What an image is (its place among the texels, width, height) is data: a row of the material's parameter block.
//! How it is read ([wrapping](super::Wrapping), [filtering](super::Filtering), [format](super::TexelFormat), coordinates) is structure: type parameters, for
//! which the `Any…` enumerations stand in where a renderer is interpreted.
//! Texel centres lie at half-integers; row 0 is at v = 0.

use super::filtering::Filtering;
use super::params::ImageParam;
use super::texel_format::TexelFormat;
use super::uv_map::UvMap;
use super::wrapping::Wrapping;
use super::{ColorSource, ScalarSource};
use crate::domain::{Buffer, Bundle, Domain, One};
use crate::math::Color;
use crate::math::vec3::lit3;
use crate::surface::Surface;

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
    fn sample<D: Domain, S: Bundle<D>>(
        &self,
        d: D,
        surface: &Surface<D>,
        fetch: impl Fn(D::U) -> S,
        constant: impl Fn([f32; 4]) -> S,
        lerp: impl Fn(S, S, D::F) -> S,
    ) -> S {
        let slot = surface.params + d.uint(self.slot);
        let image = ImageParam::load_at(d, Buffer::Params, slot);
        let ImageParam {
            first,
            width,
            height,
            ..
        } = self.filter.level(d, image, &self.uv, surface);
        let (columns, rows) = (d.to_real(width), d.to_real(height));
        let [u, v] = self.uv.apply(d, surface);
        let texel = |x: D::F, y: D::F| {
            let column = d.to_uint(self.wrap.0.wrap(d, x, columns));
            let row = d.to_uint(self.wrap.1.wrap(d, y, rows));
            let words = d.uint(self.format.words());
            let mut texel = fetch(first + (row * width + column) * words);
            let axes = [
                (self.wrap.0.border(), x, columns),
                (self.wrap.1.border(), y, rows),
            ];
            for (border, i, size) in axes {
                if let Some(border) = border {
                    let is_inside = d.le(d.lit(0.0), i) & d.lt(i, size);
                    texel = S::choose(d, is_inside, texel, constant(border));
                }
            }
            texel
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
            |[r, g, b, _]| lit3(d, [r, g, b]),
            |a, b, t| a.lerp(b, t),
        )
    }
}

impl<D: Domain, U: Wrapping, V: Wrapping, F: Filtering, T: TexelFormat> ScalarSource<D>
    for Image<U, V, F, T>
{
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        let One(scalar) = self.sample(
            d,
            surface,
            |word| One(self.format.channel(d, word, self.channel)),
            |border| One(d.lit(f64::from(border[self.channel as usize]))),
            |One(a), One(b), t| One(a + (b - a) * t),
        );
        scalar
    }
}
