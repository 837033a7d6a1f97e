//! A packet of rays in columns, as vector lanes want them.

use crate::slab::{LEAST, Octant};
use crate::triangle::Axes;
use crate::{Lanes, Ray};

/// `R` valid rays.
#[derive(Clone, Copy)]
pub(crate) struct Columns<const R: usize> {
    /// `[axis][ray]`
    pub(crate) org: [[f32; R]; 3],
    /// `[axis][ray]`
    pub(crate) dir: [[f32; R]; 3],
    /// Not negative.
    pub(crate) tmin: [f32; R],
    pub(crate) tmax: [f32; R],
}

impl<const R: usize> Columns<R> {
    /// The rays that `members` number. What room is left repeats the first; its interval is empty.
    #[inline(always)]
    pub(crate) fn gather(rays: &[Ray], members: &[u16]) -> Columns<R> {
        let mut columns = Columns {
            org: [[0.0; R]; 3],
            dir: [[0.0; R]; 3],
            tmin: [0.0; R],
            tmax: [-1.0; R],
        };
        for lane in 0..R {
            let member = members[if lane < members.len() { lane } else { 0 }];
            let ray = &rays[member as usize];
            for axis in 0..3 {
                columns.org[axis][lane] = ray.org[axis];
                columns.dir[axis][lane] = ray.dir[axis];
            }
            let (tmin, tmax) = ray.interval();
            columns.tmin[lane] = tmin;
            if lane < members.len() {
                columns.tmax[lane] = tmax;
            }
        }
        columns
    }

    /// How far the directions spread: the greatest difference of their slopes, which lie in
    /// [-1, 1] for rays with this order of axes.
    #[inline(always)]
    pub(crate) fn spread(&self, [kx, ky, kz]: Axes) -> f32 {
        let spread = |axis: usize| {
            let mut slopes = [0.0; R];
            for (lane, slope) in slopes.iter_mut().enumerate() {
                *slope = self.dir[axis][lane] / self.dir[kz][lane];
            }
            greatest(slopes) - least(slopes)
        };
        spread(kx).max(spread(ky))
    }

    /// The inverse directions, as for single rays.
    #[inline(always)]
    pub(crate) fn inverse<S: Lanes<R>>(&self, simd: S, octant: Octant) -> [S::Float; 3] {
        let size = [0, 1, 2].map(|axis| simd.abs(simd.load(&self.dir[axis])));
        let longest = simd.max_number(simd.max_number(size[0], size[1]), size[2]);
        let least = simd.mul(longest, simd.splat(LEAST));
        [0, 1, 2].map(|axis| {
            let one = simd.splat(if octant[axis] { -1.0 } else { 1.0 });
            simd.div(one, simd.max_number(size[axis], least))
        })
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
