//! How texels are combined, and from which of an image's levels they are.

use super::params::ImageParam;
use super::uv_map::UvMap;
use crate::domain::{Buffer, Domain};
use crate::math::elementary::log2;
use crate::surface::Surface;

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

    /// The level of an image that is read: the image itself, unless there are others to choose from.
    #[inline(always)]
    fn level<D: Domain>(
        &self,
        _d: D,
        image: ImageParam<D>,
        _uv: &UvMap,
        _surface: &Surface<D>,
    ) -> ImageParam<D> {
        image
    }
}

/// The nearest texel.
#[derive(Clone, Copy, Debug)]
pub struct Nearest;
/// Bilinear.
#[derive(Clone, Copy, Debug)]
pub struct Bilinear;
/// Bilinear, in one of the two levels between whose texels the footprint is, by chance: on average, between the two.
#[derive(Clone, Copy, Debug)]
pub struct Trilinear;

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

impl Filtering for Trilinear {
    #[inline(always)]
    fn filter<D: Domain, T: Copy>(
        &self,
        d: D,
        x: D::F,
        y: D::F,
        texel: impl Fn(D::F, D::F) -> T,
        lerp: impl Fn(T, T, D::F) -> T,
    ) -> T {
        Bilinear.filter(d, x, y, texel, lerp)
    }

    /// Of texels as wide as the footprint, λ is the logarithm of how many texels of the image they are wide.
    #[inline(always)]
    fn level<D: Domain>(
        &self,
        d: D,
        image: ImageParam<D>,
        uv: &UvMap,
        surface: &Surface<D>,
    ) -> ImageParam<D> {
        let (width, height) = (d.to_real(image.width), d.to_real(image.height));
        let across = surface.footprint.width;
        let texels = uv.area(d, surface) * width * height * across * across;
        let texels = d.min(d.max(texels, d.lit(1e-30)), d.lit(1e30));
        let level = log2(d, texels) * d.lit(0.5);
        // Each level has half the texels along a side, rounded down, and the last has one.
        let exponent = d.to_bits(d.max(width, height)) >> 23;
        let last = d.to_real(exponent) - d.lit(127.0);
        let level = d.max(d.min(level, last), d.lit(0.0));
        let level = d.min(d.floor(level + surface.footprint.random), last);
        let row = d.to_uint(level) * d.uint(ImageParam::WORDS);
        ImageParam::load_at(d, Buffer::Texels, image.levels + row)
    }
}

/// [`Filtering`] chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AnyFilter {
    /// [`Nearest`].
    Nearest,
    /// [`Bilinear`].
    Bilinear,
    /// [`Trilinear`].
    Trilinear,
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
            Self::Trilinear => Trilinear.filter(d, x, y, texel, lerp),
        }
    }

    #[inline(always)]
    fn level<D: Domain>(
        &self,
        d: D,
        image: ImageParam<D>,
        uv: &UvMap,
        surface: &Surface<D>,
    ) -> ImageParam<D> {
        match self {
            Self::Nearest | Self::Bilinear => image,
            Self::Trilinear => Trilinear.level(d, image, uv, surface),
        }
    }
}
