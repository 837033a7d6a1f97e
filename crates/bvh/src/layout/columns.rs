//! A packet of rays in columns, as vector lanes want them.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4};

use crate::bounds::Bounds;
use crate::inlined::{each, inlined};
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

    /// Rays in their order.
    #[inline(always)]
    pub(crate) fn of<S: Width<R>>(simd: S, rays: &[Ray; R]) -> Columns<R> {
        let mut columns = Columns {
            org: [[0.0; R]; 3],
            dir: [[0.0; R]; 3],
            tmin: [0.0; R],
            tmax: [0.0; R],
        };
        let (groups, _) = rays.as_chunks::<4>();
        for (group, [a, b, c, d]) in groups.iter().enumerate() {
            let row = |[x, y, z]: [f32; 3], last: f32| [x, y, z, last];
            let org = |ray: &Ray| row(ray.org, ray.tmin);
            let dir = |ray: &Ray| row(ray.dir, ray.tmax);
            let lanes = 4 * group..4 * group + 4;
            let [x, y, z, tmin] = transposed(simd, [org(a), org(b), org(c), org(d)]);
            columns.org[0][lanes.clone()].copy_from_slice(&x);
            columns.org[1][lanes.clone()].copy_from_slice(&y);
            columns.org[2][lanes.clone()].copy_from_slice(&z);
            columns.tmin[lanes.clone()].copy_from_slice(&tmin);
            let [x, y, z, tmax] = transposed(simd, [dir(a), dir(b), dir(c), dir(d)]);
            columns.dir[0][lanes.clone()].copy_from_slice(&x);
            columns.dir[1][lanes.clone()].copy_from_slice(&y);
            columns.dir[2][lanes.clone()].copy_from_slice(&z);
            columns.tmax[lanes].copy_from_slice(&tmax);
        }
        columns
    }

    /// The class of all rays, if they are valid and have one.
    #[inline(always)]
    pub(crate) fn class<S: Width<R>>(&self, simd: S) -> Option<Class> {
        let all = u32::MAX >> (32 - R);
        let uniform = |lanes: u32| (lanes == 0 || lanes == all).then_some(lanes != 0);

        let largest = simd.splat(f32::MAX);
        let load = inlined(
            #[inline(always)]
            |column: &[f32; R]| simd.load(column),
        );
        let size = each(
            [0, 1, 2_usize],
            #[inline(always)]
            |axis| simd.abs(load(&self.dir[axis])),
        );
        let finite = inlined(
            #[inline(always)]
            |size: S::Float| simd.bits(simd.le(size, largest)),
        );
        let mut valid = simd.bits(simd.le(load(&self.tmin), load(&self.tmax)));
        for (&size, org) in size.iter().zip(&self.org) {
            valid &= finite(size) & finite(simd.abs(load(org)));
        }
        let longest = simd.max_number(simd.max_number(size[0], size[1]), size[2]);
        valid &= simd.bits(simd.le(simd.splat(f32::MIN_POSITIVE), longest));
        if valid != all {
            return None;
        }

        let not_less = inlined(
            #[inline(always)]
            |a: usize, b: usize| simd.bits(simd.le(size[b], size[a])),
        );
        let greatest = if uniform(not_less(2, 0) & not_less(2, 1))? {
            2
        } else {
            usize::from(uniform(not_less(1, 0))?)
        };
        let zero = simd.splat(0.0);
        let negative = inlined(
            #[inline(always)]
            |axis: usize| uniform(simd.bits(simd.lt(load(&self.dir[axis]), zero))),
        );
        let octant = [negative(0)?, negative(1)?, negative(2)?];
        Some(Class {
            octant,
            axes: ordered(greatest, octant[greatest]),
        })
    }

    /// As [`Bounds::is_moderate`], of the origins.
    #[inline(always)]
    pub(crate) fn is_moderate<S: Width<R>>(&self, simd: S) -> bool {
        let largest = simd.splat(Bounds::MODERATE);
        let is_moderate = inlined(
            #[inline(always)]
            |row: &[f32; R]| simd.bits(simd.lt(simd.abs(simd.load(row)), largest)),
        );
        let [x, y, z] = &self.org;
        is_moderate(x) & is_moderate(y) & is_moderate(z) == u32::MAX >> (32 - R)
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

/// Four rows of four numbers, as columns.
#[inline(always)]
fn transposed<S: Simd>(simd: S, rows: [[f32; 4]; 4]) -> [[f32; 4]; 4] {
    let [a, b, c, d] = rows;
    let row = inlined(
        #[inline(always)]
        |row: [f32; 4]| f32x4::load_array(simd, row),
    );
    let (a, b, c, d) = (row(a), row(b), row(c), row(d));
    let (low, high) = ((a.zip_low(c), b.zip_low(d)), (a.zip_high(c), b.zip_high(d)));
    [
        low.0.zip_low(low.1).into(),
        low.0.zip_high(low.1).into(),
        high.0.zip_low(high.1).into(),
        high.0.zip_high(high.1).into(),
    ]
}
