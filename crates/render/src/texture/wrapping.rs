//! How images are read outside of [0, 1].

use crate::domain::Domain;

/// How coordinates outside the image are read.
pub trait Wrapping {
    /// A whole texel number in [0, size) for a whole number `i`. `size` > 0.
    fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F;

    /// What every texel outside of the image is, red to alpha; `None` where the image goes on.
    #[inline(always)]
    fn border(&self) -> Option<[f32; 4]> {
        None
    }
}

/// Tiles.
#[derive(Clone, Copy, Debug)]
pub struct Repeat;
/// Tiles, every other one mirrored.
#[derive(Clone, Copy, Debug)]
pub struct MirroredRepeat;
/// The texels at the edge go on.
#[derive(Clone, Copy, Debug)]
pub struct Clamp;
/// The image is there once, and white around it: a factor on it counts alone.
#[derive(Clone, Copy, Debug)]
pub struct WhiteBorder;
/// The image is there once, and black around it.
#[derive(Clone, Copy, Debug)]
pub struct BlackBorder;
/// The image of directions is there once, and around it the direction is that of the surface.
#[derive(Clone, Copy, Debug)]
pub struct FlatBorder;

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

macro_rules! borders {
    ($($Border:ident = $texel:expr;)*) => {$(
        impl Wrapping for $Border {
            #[inline(always)]
            fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F {
                Clamp.wrap(d, i, size)
            }
            #[inline(always)]
            fn border(&self) -> Option<[f32; 4]> {
                Some($texel)
            }
        }
    )*};
}
borders! {
    WhiteBorder = [1.0; 4];
    BlackBorder = [0.0; 4];
    FlatBorder = [0.5, 0.5, 1.0, 1.0];
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
    /// [`WhiteBorder`].
    WhiteBorder,
    /// [`BlackBorder`].
    BlackBorder,
    /// [`FlatBorder`].
    FlatBorder,
}

macro_rules! each {
    ($any:expr, $wrap:ident => $call:expr; $($Wrap:ident)*) => {
        match $any {
            $(AnyWrap::$Wrap => {
                let $wrap = $Wrap;
                $call
            })*
        }
    };
    ($any:expr, $wrap:ident => $call:expr) => {
        each!($any, $wrap => $call; Repeat MirroredRepeat Clamp WhiteBorder BlackBorder FlatBorder)
    };
}

impl Wrapping for AnyWrap {
    #[inline(always)]
    fn wrap<D: Domain>(&self, d: D, i: D::F, size: D::F) -> D::F {
        each!(self, wrap => wrap.wrap(d, i, size))
    }
    #[inline(always)]
    fn border(&self) -> Option<[f32; 4]> {
        each!(self, wrap => wrap.border())
    }
}
