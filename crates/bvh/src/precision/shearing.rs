//! How corners are moved to the space in which a ray is the z axis.

use crate::inlined::inlined;
use crate::precision::interval::{Interval, highest, lowest, product};
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

    /// Between which numbers that lies, from the ends of intervals.
    fn bounds<S: Width<W>, const W: usize>(
        simd: S,
        x: Interval<S::Float>,
        slope: Interval<S::Float>,
        z: Interval<S::Float>,
    ) -> Interval<S::Float>;
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

    #[inline(always)]
    fn bounds<S: Width<W>, const W: usize>(
        simd: S,
        x: Interval<S::Float>,
        slope: Interval<S::Float>,
        z: Interval<S::Float>,
    ) -> Interval<S::Float> {
        let shear = product(simd, slope, z);
        [simd.sub(x[0], shear[1]), simd.sub(x[1], shear[0])]
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

    #[inline(always)]
    fn bounds<S: Width<W>, const W: usize>(
        simd: S,
        x: Interval<S::Float>,
        slope: Interval<S::Float>,
        z: Interval<S::Float>,
    ) -> Interval<S::Float> {
        let ends = inlined(
            #[inline(always)]
            |x: S::Float| {
                [
                    simd.mul_sub(slope[0], z[0], x),
                    simd.mul_sub(slope[0], z[1], x),
                    simd.mul_sub(slope[1], z[0], x),
                    simd.mul_sub(slope[1], z[1], x),
                ]
            },
        );
        [lowest(simd, ends(x[1])), highest(simd, ends(x[0]))]
    }
}
