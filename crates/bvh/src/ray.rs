//! Rays and hits: the bytes that enter and leave a query.

use std::mem::{offset_of, size_of};

/// The points `org + t dir` for `t` in the closed interval `[tmin, tmax]`.
///
/// A query begins at the origin: a negative `tmin` is read as zero. Distances beyond `f32::MAX` do
/// not exist, so an infinite `tmax` means "any distance".
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Ray {
    /// Origin, in the space of the mesh.
    pub org: [f32; 3],
    /// Nearest distance accepted, in units of `dir`.
    pub tmin: f32,
    /// Direction; it need not have unit length.
    pub dir: [f32; 3],
    /// Farthest distance accepted, in units of `dir`.
    pub tmax: f32,
}

const _: () = assert!(size_of::<Ray>() == 32 && offset_of!(Ray, dir) == 16);

impl Ray {
    /// The ray from `org` along `dir`, as far as it goes: its interval is `[0, ∞]`.
    #[inline(always)]
    pub const fn unbounded(org: [f32; 3], dir: [f32; 3]) -> Ray {
        Ray {
            org,
            tmin: 0.0,
            dir,
            tmax: f32::INFINITY,
        }
    }

    /// Whether the ray can hit anything: finite origin and direction, a direction whose inverse is
    /// finite, and an interval that is not empty.
    #[inline(always)]
    pub fn is_valid(&self) -> bool {
        // Without their signs the bits of numbers sort like the numbers, then infinity, then NaN.
        let greatest = |vector: [f32; 3]| {
            let [x, y, z] = vector.map(|x| x.abs().to_bits());
            x.max(y).max(z)
        };
        let (org, dir) = (greatest(self.org), greatest(self.dir));
        let finite = org.max(dir) <= f32::MAX.to_bits();
        // Below the smallest normal number 1/dir overflows: such a direction is as good as zero.
        finite & (dir >= f32::MIN_POSITIVE.to_bits()) & (self.tmin <= self.tmax)
    }

    /// The greatest component of the direction.
    #[inline(always)]
    pub(crate) fn longest(&self) -> f32 {
        let [x, y, z] = self.dir.map(f32::abs);
        let greater = |a: f32, b: f32| if a > b { a } else { b };
        greater(greater(x, y), z)
    }

    /// The interval that the kernels search.
    #[inline(always)]
    pub(crate) fn interval(&self) -> (f32, f32) {
        interval(self.tmin, self.tmax)
    }
}

/// The interval that the kernels search: `tmin` at least `+0.0`, `tmax` at most `f32::MAX`.
#[inline(always)]
pub(crate) fn interval(tmin: f32, tmax: f32) -> (f32, f32) {
    (
        if tmin > 0.0 { tmin } else { 0.0 },
        if tmax < f32::MAX { tmax } else { f32::MAX },
    )
}

/// Where a ray meets a triangle, at `(1 - u - v) v0 + u v1 + v v2`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Hit {
    /// Distance in units of the ray's direction; the ray's `tmax` on a miss.
    pub t: f32,
    /// Weight of the triangle's second vertex, in \[0, 1\].
    pub u: f32,
    /// Weight of the triangle's third vertex, in \[0, 1\].
    pub v: f32,
    /// Index of the triangle in the mesh; [`Hit::NONE`] on a miss.
    pub prim: u32,
}

const _: () = assert!(size_of::<Hit>() == 16 && offset_of!(Hit, prim) == 12);

impl Hit {
    /// The triangle index that says "no hit".
    pub const NONE: u32 = u32::MAX;

    /// The answer for a ray that meets nothing up to `tmax`.
    #[inline(always)]
    pub fn miss(tmax: f32) -> Hit {
        Hit {
            t: tmax,
            u: 0.0,
            v: 0.0,
            prim: Hit::NONE,
        }
    }

    /// Whether a triangle was hit.
    #[inline(always)]
    pub fn is_hit(&self) -> bool {
        self.prim != Hit::NONE
    }
}
