//! How corners are moved to the space in which a ray is the z axis.

use crate::simd::Width;

/// [`Rounded`] or [`Fused`].
pub trait Shearing {
    /// A coordinate `x` across the ray, after the shear of this slope: it depends on these numbers alone, so
    /// triangles that share a corner see the same point.
    fn sheared<S: Width<W>, const W: usize>(
        simd: S,
        x: S::Float,
        slope: S::Float,
        z: S::Float,
    ) -> S::Float;
}

/// Every operation rounds.
#[derive(Clone, Copy)]
pub struct Rounded;

/// In one operation, which gives it negated.
#[derive(Clone, Copy)]
pub struct Fused;

impl Shearing for Rounded {
    #[inline(always)]
    fn sheared<S: Width<W>, const W: usize>(
        simd: S,
        x: S::Float,
        slope: S::Float,
        z: S::Float,
    ) -> S::Float {
        simd.sub(x, simd.mul(slope, z))
    }
}

impl Shearing for Fused {
    #[inline(always)]
    fn sheared<S: Width<W>, const W: usize>(
        simd: S,
        x: S::Float,
        slope: S::Float,
        z: S::Float,
    ) -> S::Float {
        simd.mul_sub(slope, z, x)
    }
}
