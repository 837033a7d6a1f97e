//! Intervals in lanes: between which numbers the result of an operation lies, from the ends of its operands. Rounding keeps
//! order, so the ends are those of the rounded results.

use crate::simd::Width;

/// The lower and the upper end.
pub(crate) type Interval<F> = [F; 2];

/// Between which numbers the product of two lies.
#[inline(always)]
pub(crate) fn product<S: Width<W>, const W: usize>(
    simd: S,
    a: Interval<S::Float>,
    b: Interval<S::Float>,
) -> Interval<S::Float> {
    let products = [
        simd.mul(a[0], b[0]),
        simd.mul(a[0], b[1]),
        simd.mul(a[1], b[0]),
        simd.mul(a[1], b[1]),
    ];
    [lowest(simd, products), highest(simd, products)]
}

#[inline(always)]
pub(crate) fn lowest<S: Width<W>, const W: usize>(
    simd: S,
    [a, b, c, d]: [S::Float; 4],
) -> S::Float {
    simd.min_number(simd.min_number(a, b), simd.min_number(c, d))
}

#[inline(always)]
pub(crate) fn highest<S: Width<W>, const W: usize>(
    simd: S,
    [a, b, c, d]: [S::Float; 4],
) -> S::Float {
    simd.max_number(simd.max_number(a, b), simd.max_number(c, d))
}
