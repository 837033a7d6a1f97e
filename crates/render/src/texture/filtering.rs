//! How texels are combined.

use crate::domain::Domain;

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
