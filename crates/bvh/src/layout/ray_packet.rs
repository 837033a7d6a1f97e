//! Packets of rays and hits: in columns, as vector lanes want them.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4};

use crate::bounds::Bounds;
use crate::inlined::{each, inlined};
use crate::layout::class::{Class, ordered};
use crate::ray::{Hit, Ray, interval};
use crate::simd::Width;

/// `R` [`Ray`]s (4, 8, 16 or 32) whose like components lie together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct RayPacket<const R: usize> {
    /// Origins, `[axis][ray]`.
    pub org: [[f32; R]; 3],
    /// Nearest distances accepted.
    pub tmin: [f32; R],
    /// Directions, `[axis][ray]`.
    pub dir: [[f32; R]; 3],
    /// Farthest distances accepted.
    pub tmax: [f32; R],
}

/// The [`Hit`]s of `R` rays, whose like components lie together.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub struct HitPacket<const R: usize> {
    /// Distances; the rays' `tmax` on misses.
    pub t: [f32; R],
    /// Weights of the triangles' second vertices.
    pub u: [f32; R],
    /// Weights of the triangles' third vertices.
    pub v: [f32; R],
    /// Indices of the triangles; [`Hit::NONE`] on misses.
    pub prim: [u32; R],
}

impl<const R: usize> HitPacket<R> {
    /// For rays that hit nothing.
    #[inline(always)]
    pub fn misses(rays: &RayPacket<R>) -> Self {
        HitPacket {
            t: rays.tmax,
            u: [0.0; R],
            v: [0.0; R],
            prim: [Hit::NONE; R],
        }
    }

    /// Replaces the hit of one ray.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, hit: Hit) {
        self.t[lane] = hit.t;
        self.u[lane] = hit.u;
        self.v[lane] = hit.v;
        self.prim[lane] = hit.prim;
    }

    /// Which rays hit anything, as bits.
    #[inline(always)]
    pub fn hits(&self) -> u32 {
        let mut bits = 0;
        for (lane, &prim) in self.prim.iter().enumerate() {
            bits |= u32::from(prim != Hit::NONE) << lane;
        }
        bits
    }

    /// The hit of one ray.
    #[inline(always)]
    pub fn hit(&self, lane: usize) -> Hit {
        Hit {
            t: self.t[lane],
            u: self.u[lane],
            v: self.v[lane],
            prim: self.prim[lane],
        }
    }
}

/// The intervals of a packet's rays.
#[repr(align(64))]
pub(crate) struct Intervals<const R: usize> {
    pub(crate) tmin: [f32; R],
    pub(crate) tmax: [f32; R],
}

/// Between which numbers the origins of a packet's rays and their intervals lie.
pub(crate) struct RayBounds {
    /// The least of each coordinate, and of `tmin`.
    pub(crate) lo: [f32; 4],
    /// The greatest of each coordinate, and of `tmax`.
    pub(crate) hi: [f32; 4],
}

impl<const R: usize> RayPacket<R> {
    /// No rays: all are invalid and hit nothing.
    pub const NONE: Self = RayPacket {
        org: [[0.0; R]; 3],
        tmin: [0.0; R],
        dir: [[0.0; R]; 3],
        tmax: [0.0; R],
    };

    /// Rays in their order; what room is left has rays that hit nothing.
    ///
    /// # Panics
    /// If there are more than `R`.
    pub fn of_rays(rays: &[Ray]) -> Self {
        assert!(rays.len() <= R, "as many rays as lanes, or fewer");
        let mut packet = Self::NONE;
        for (lane, ray) in rays.iter().enumerate() {
            packet.set(lane, ray);
        }
        packet
    }

    /// One ray.
    #[inline(always)]
    pub fn ray(&self, lane: usize) -> Ray {
        let vector = |columns: &[[f32; R]; 3]| columns.each_ref().map(|column| column[lane]);
        Ray {
            org: vector(&self.org),
            tmin: self.tmin[lane],
            dir: vector(&self.dir),
            tmax: self.tmax[lane],
        }
    }

    /// Replaces one ray.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        for axis in 0..3 {
            self.org[axis][lane] = ray.org[axis];
            self.dir[axis][lane] = ray.dir[axis];
        }
        self.tmin[lane] = ray.tmin;
        self.tmax[lane] = ray.tmax;
    }

    /// The rays whose indices are `members`. What room is left repeats the first.
    #[inline(always)]
    pub(crate) fn gather(rays: &[Ray], members: &[u16]) -> Self {
        let mut packet = Self::NONE;
        for lane in 0..R {
            let member = members[if lane < members.len() { lane } else { 0 }];
            packet.set(lane, &rays[member as usize]);
        }
        packet
    }

    /// Rays in their order.
    #[inline(always)]
    pub(crate) fn of<S: Width<R>>(simd: S, rays: &[Ray; R]) -> Self {
        let mut columns = Self::NONE;
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

    /// The sizes of the directions' components.
    #[inline(always)]
    fn sizes<S: Width<R>>(&self, simd: S) -> [S::Float; 3] {
        each(
            [0, 1, 2_usize],
            #[inline(always)]
            |axis| simd.abs(simd.load(&self.dir[axis])),
        )
    }

    /// The rays that are [valid](Ray::is_valid), as bits.
    #[inline(always)]
    pub(crate) fn valid<S: Width<R>>(&self, simd: S) -> u32 {
        let largest = simd.splat(f32::MAX);
        let finite = inlined(
            #[inline(always)]
            |size: S::Float| simd.bits(simd.le(size, largest)),
        );
        let size = self.sizes(simd);
        let mut valid = simd.bits(simd.le(simd.load(&self.tmin), simd.load(&self.tmax)));
        for (&size, org) in size.iter().zip(&self.org) {
            valid &= finite(size) & finite(simd.abs(simd.load(org)));
        }
        let longest = simd.max_number(simd.max_number(size[0], size[1]), size[2]);
        valid & simd.bits(simd.le(simd.splat(f32::MIN_POSITIVE), longest))
    }

    /// The class of all rays, if they are valid and have one.
    #[inline(always)]
    pub(crate) fn class<S: Width<R>>(&self, simd: S) -> Option<Class> {
        let all = u32::MAX >> (32 - R);
        if self.valid(simd) != all {
            return None;
        }
        let uniform = |lanes: u32| (lanes == 0 || lanes == all).then_some(lanes != 0);
        let size = self.sizes(simd);
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
            |axis: usize| uniform(simd.bits(simd.lt(simd.load(&self.dir[axis]), zero))),
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

    /// The intervals, clipped to what the kernels search, see [`Ray::interval`], and empty where `active` has no bit.
    #[inline(always)]
    pub(crate) fn intervals(&self, active: u32) -> Intervals<R> {
        let mut intervals = Intervals {
            tmin: [0.0; R],
            tmax: [0.0; R],
        };
        for lane in 0..R {
            let (tmin, tmax) = interval(self.tmin[lane], self.tmax[lane]);
            intervals.tmin[lane] = tmin;
            intervals.tmax[lane] = if active >> lane & 1 == 1 { tmax } else { -1.0 };
        }
        intervals
    }

    /// The bounds of all rays, which are valid, with these intervals.
    #[inline(always)]
    pub(crate) fn bounds<S: Width<R>>(&self, simd: S, intervals: &Intervals<R>) -> RayBounds {
        let [x, y, z] = each(
            [0, 1, 2_usize],
            #[inline(always)]
            |axis| simd.load(&self.org[axis]),
        );
        RayBounds {
            lo: simd.least_of([x, y, z, simd.load(&intervals.tmin)]),
            hi: simd.greatest_of([x, y, z, simd.load(&intervals.tmax)]),
        }
    }

    /// With the first of these rays, of which there is one, in place of all others.
    #[inline(always)]
    pub(crate) fn only(mut self, rays: u32) -> Self {
        let first = self.ray(rays.trailing_zeros() as usize % R);
        for lane in (0..R).filter(|lane| rays >> lane & 1 == 0) {
            self.set(lane, &first);
        }
        self
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
