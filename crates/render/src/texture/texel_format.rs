//! How texels are stored.

use super::srgb;
use crate::domain::{Buffer, Domain};
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};

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
/// Four linear `f16`, none of them negative, infinite or NaN.
#[derive(Clone, Copy, Debug)]
pub struct LinearHalf;
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
/// The lower half of a word as a number: exact, and without numbers below the normal ones of `f32`, which GPUs may take for 0.
#[inline(always)]
fn half<D: Domain>(d: D, word: D::U) -> D::F {
    let bits = word & d.uint(0x7fff);
    let normal = d.from_bits((bits << 13) + d.uint((127 - 15) << 23));
    let small = d.to_real(bits) * d.lit(1.0 / f64::from(1 << 24));
    d.select(d.lt_u(bits, d.uint(1 << 10)), small, normal)
}

impl TexelFormat for LinearHalf {
    #[inline(always)]
    fn words(&self) -> u32 {
        2
    }
    #[inline(always)]
    fn color<D: Domain>(&self, d: D, word: D::U) -> Color<D::F> {
        let [rg, ba] = [0, 1].map(|k| d.load(Buffer::Texels, word + d.uint(k)));
        vec3(half(d, rg), half(d, rg >> 16), half(d, ba))
    }
    #[inline(always)]
    fn channel<D: Domain>(&self, d: D, word: D::U, channel: u32) -> D::F {
        let two = d.load(Buffer::Texels, word + d.uint(channel / 2));
        half(d, two >> (16 * (channel % 2)))
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
    /// [`LinearHalf`].
    LinearHalf,
    /// [`LinearFloat`].
    LinearFloat,
}

impl TexelFormat for AnyFormat {
    #[inline(always)]
    fn words(&self) -> u32 {
        match self {
            Self::SrgbRgba8 => SrgbRgba8.words(),
            Self::LinearRgba8 => LinearRgba8.words(),
            Self::LinearHalf => LinearHalf.words(),
            Self::LinearFloat => LinearFloat.words(),
        }
    }
    #[inline(always)]
    fn color<D: Domain>(&self, d: D, word: D::U) -> Color<D::F> {
        match self {
            Self::SrgbRgba8 => SrgbRgba8.color(d, word),
            Self::LinearRgba8 => LinearRgba8.color(d, word),
            Self::LinearHalf => LinearHalf.color(d, word),
            Self::LinearFloat => LinearFloat.color(d, word),
        }
    }
    #[inline(always)]
    fn channel<D: Domain>(&self, d: D, word: D::U, channel: u32) -> D::F {
        match self {
            Self::SrgbRgba8 => SrgbRgba8.channel(d, word, channel),
            Self::LinearRgba8 => LinearRgba8.channel(d, word, channel),
            Self::LinearHalf => LinearHalf.channel(d, word, channel),
            Self::LinearFloat => LinearFloat.channel(d, word, channel),
        }
    }
}
