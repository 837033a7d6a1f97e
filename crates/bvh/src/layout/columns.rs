//! A packet of rays in columns, as vector lanes want them.

use crate::layout::class::{Class, ordered};
use crate::ray::{Ray, interval};
use crate::simd::Width;

/// `R` rays.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Columns<const R: usize> {
    /// `[axis][ray]`
    pub(crate) org: [[f32; R]; 3],
    /// `[axis][ray]`
    pub(crate) dir: [[f32; R]; 3],
    pub(crate) tmin: [f32; R],
    pub(crate) tmax: [f32; R],
}

impl<const R: usize> Columns<R> {
    /// The rays whose indices are `members`. What room is left repeats the first.
    #[inline(always)]
    pub(crate) fn gather(rays: &[Ray], members: &[u16]) -> Columns<R> {
        let mut columns = Columns {
            org: [[0.0; R]; 3],
            dir: [[0.0; R]; 3],
            tmin: [0.0; R],
            tmax: [0.0; R],
        };
        for lane in 0..R {
            let member = members[if lane < members.len() { lane } else { 0 }];
            let ray = &rays[member as usize];
            for axis in 0..3 {
                columns.org[axis][lane] = ray.org[axis];
                columns.dir[axis][lane] = ray.dir[axis];
            }
            columns.tmin[lane] = ray.tmin;
            columns.tmax[lane] = ray.tmax;
        }
        columns
    }

    /// The class of all rays, if they are valid and have one.
    #[inline(always)]
    pub(crate) fn class<S: Width<R>>(&self, simd: S) -> Option<Class> {
        let all = u32::MAX >> (32 - R);
        let uniform = |lanes: u32| (lanes == 0 || lanes == all).then_some(lanes != 0);

        let largest = simd.splat(f32::MAX);
        let load = |column: &[f32; R]| simd.load(column);
        let size = [0, 1, 2].map(|axis| simd.abs(load(&self.dir[axis])));
        let finite = |size: S::Float| simd.bits(simd.le(size, largest));
        let mut valid = simd.bits(simd.le(load(&self.tmin), load(&self.tmax)));
        for (&size, org) in size.iter().zip(&self.org) {
            valid &= finite(size) & finite(simd.abs(load(org)));
        }
        let longest = simd.max_number(simd.max_number(size[0], size[1]), size[2]);
        valid &= simd.bits(simd.le(simd.splat(f32::MIN_POSITIVE), longest));
        if valid != all {
            return None;
        }

        let not_less = |a: usize, b: usize| simd.bits(simd.le(size[b], size[a]));
        let greatest = if uniform(not_less(2, 0) & not_less(2, 1))? {
            2
        } else {
            usize::from(uniform(not_less(1, 0))?)
        };
        let zero = simd.splat(0.0);
        let negative = |axis: usize| uniform(simd.bits(simd.lt(load(&self.dir[axis]), zero)));
        let octant = [negative(0)?, negative(1)?, negative(2)?];
        Some(Class {
            octant,
            axes: ordered(greatest, octant[greatest]),
        })
    }

    /// Clips the intervals to what the kernels search, see [`Ray::interval`], and empties those
    /// behind the first `count`.
    #[inline(always)]
    pub(crate) fn clip(&mut self, count: usize) {
        for lane in 0..R {
            let (tmin, tmax) = interval(self.tmin[lane], self.tmax[lane]);
            self.tmin[lane] = tmin;
            self.tmax[lane] = if lane < count { tmax } else { -1.0 };
        }
    }
}

/// The least of `R` numbers, `R` a power of two.
#[inline(always)]
pub(crate) fn least<const R: usize>(mut values: [f32; R]) -> f32 {
    let mut half = R / 2;
    while half > 0 {
        for i in 0..half {
            if values[i + half] < values[i] {
                values[i] = values[i + half];
            }
        }
        half /= 2;
    }
    values[0]
}

/// The greatest of `R` numbers, `R` a power of two.
#[inline(always)]
pub(crate) fn greatest<const R: usize>(mut values: [f32; R]) -> f32 {
    let mut half = R / 2;
    while half > 0 {
        for i in 0..half {
            if values[i + half] > values[i] {
                values[i] = values[i + half];
            }
        }
        half /= 2;
    }
    values[0]
}
