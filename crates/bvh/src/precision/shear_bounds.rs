//! A packet of rays against the triangles of a leaf, all at once: which of these any of the rays may hit.
//!
//! The tests of [`Fast`](crate::Fast) and [`Watertight`](crate::Watertight) reject a triangle by the signs of three numbers, which
//! follow from origin and slopes of the ray by a few operations. Each of them rounds, and rounding keeps order: between numbers
//! that are computed from the ends of intervals by the same operations lie all that are computed from numbers within. So what is
//! rejected here for the intervals that hold all rays is rejected for each of the rays, without any slack.

use crate::filter::Culling;
use crate::inlined::inlined;
use crate::layout::class::Axes;
use crate::layout::packet::Packet;
use crate::layout::ray_packet::RayBounds;
use crate::precision::interval::Interval;
use crate::precision::shearing::Shearing;
use crate::precision::triangle::Shear;
use crate::simd::Width;

/// Rays with the same order of axes: what encloses their constants, in every lane.
pub struct ShearBounds<S: Width<W>, const W: usize> {
    axes: Axes,
    org: [Interval<S::Float>; 3],
    slope: [Interval<S::Float>; 2],
}

impl<S: Width<W>, const W: usize> ShearBounds<S, W> {
    #[inline(always)]
    pub(crate) fn enclosing<const R: usize>(
        simd: S,
        bounds: &RayBounds,
        rays: &Shear<'_, S, R>,
    ) -> Self
    where
        S: Width<R>,
    {
        let between = inlined(
            #[inline(always)]
            |lo: f32, hi: f32| {
                [
                    <S as Width<W>>::splat(simd, lo),
                    <S as Width<W>>::splat(simd, hi),
                ]
            },
        );
        let org = inlined(
            #[inline(always)]
            |axis: usize| between(bounds.lo[axis], bounds.hi[axis]),
        );
        let [kx, ky, kz] = rays.axes();
        let [x, y] = rays.slope();
        let lo = <S as Width<R>>::least_of(simd, [x, y, y, y]);
        let hi = <S as Width<R>>::greatest_of(simd, [x, y, y, y]);
        ShearBounds {
            axes: [kx, ky, kz],
            org: [org(kx), org(ky), org(kz)],
            slope: [between(lo[0], hi[0]), between(lo[1], hi[1])],
        }
    }

    /// Between which numbers the corners of a packet's triangles lie, across the rays: `[corner][x or y]`.
    #[inline(always)]
    pub(crate) fn sheared<K: Shearing>(
        &self,
        simd: S,
        packet: &impl Packet<W>,
    ) -> [[Interval<S::Float>; 2]; 3] {
        let bounds = inlined(
            #[inline(always)]
            |points: &[[f32; W]; 3]| {
                let relative = inlined(
                    #[inline(always)]
                    |axis: usize| {
                        let point = simd.load(&points[self.axes[axis] % 3]);
                        let [lo, hi] = self.org[axis];
                        [simd.sub(point, hi), simd.sub(point, lo)]
                    },
                );
                let z = relative(2);
                [
                    K::bounds(simd, relative(0), self.slope[0], z),
                    K::bounds(simd, relative(1), self.slope[1], z),
                ]
            },
        );
        let first = packet.in_lanes(
            simd,
            #[inline(always)]
            |points| {
                let [x, y] = bounds(points);
                [x[0], x[1], y[0]]
            },
        );
        let second = packet.in_lanes(
            simd,
            #[inline(always)]
            |points| {
                let [_, y] = bounds(points);
                [y[1]; 3]
            },
        );
        let corner = inlined(
            #[inline(always)]
            |corner: usize| {
                let [x0, x1, y0] = first[corner];
                [[x0, x1], [y0, second[corner][0]]]
            },
        );
        [corner(0), corner(1), corner(2)]
    }
}

/// The lanes of which the weights between these ends do not say that all rays pass outside, as bits: see
/// [`sides`](crate::precision::triangle_test::sides).
#[inline(always)]
pub(crate) fn possible_sides<S: Width<W>, const W: usize>(
    simd: S,
    [w, u, v]: [Interval<S::Float>; 3],
    culling: Culling,
) -> u32 {
    let zero = simd.splat(0.0);
    let least = simd.min_number(simd.min_number(w[1], u[1]), v[1]);
    let negative = simd.bits(simd.lt(least, zero));
    match culling {
        Culling::Back => !negative,
        Culling::None | Culling::PerTriangle => {
            let greatest = simd.max_number(simd.max_number(w[0], u[0]), v[0]);
            !(negative & simd.bits(simd.lt(zero, greatest)))
        }
    }
}

#[cfg(test)]
mod tests;
