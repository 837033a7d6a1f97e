//! Rays against triangles: what every precision's test starts from and returns.
//!
//! A test is written once and serves both arrangements: one ray against the triangles of a packet,
//! a triangle a lane, and a packet of rays against one triangle, a ray a lane.

use crate::inlined::{each, inlined};
use crate::layout::class::{Axes, axes};
use crate::layout::packet::Packet;
use crate::layout::ray_packet::RayPacket;
use crate::precision::ending::Ending;
use crate::precision::shearing::Shearing;
use crate::ray::Ray;
use crate::simd::{Stored, Width};

/// A triangle a lane.
pub trait Triangles<S: Width<W>, const W: usize> {
    /// The lanes that hold a triangle, as bits; more may be set where NaN coordinates alone keep rays out.
    fn used(&self, simd: S) -> u32;
    /// The corners in one lane.
    fn corners(&self, lane: usize) -> [[f32; 3]; 3];
    /// The corners in the space where the ray is the z axis; z is not scaled.
    fn sheared<K: Shearing>(&self, simd: S, rays: &Shear<'_, S, W>) -> [[S::Float; 3]; 3];
}

impl<S: Width<W>, const W: usize, T: Packet<W>> Triangles<S, W> for &T {
    #[inline(always)]
    fn used(&self, simd: S) -> u32 {
        Packet::used(*self, simd)
    }

    #[inline(always)]
    fn corners(&self, lane: usize) -> [[f32; 3]; 3] {
        Packet::corners(*self, lane)
    }

    #[inline(always)]
    fn sheared<K: Shearing>(&self, simd: S, rays: &Shear<'_, S, W>) -> [[S::Float; 3]; 3] {
        self.in_lanes(
            simd,
            #[inline(always)]
            |points| {
                rays.sheared::<K>(
                    simd,
                    #[inline(always)]
                    |axis| simd.load(&points[axis % 3]),
                )
            },
        )
    }
}

/// The same triangle in every lane.
pub(crate) struct OneTriangle<'a, T, const P: usize> {
    pub(crate) packet: &'a T,
    pub(crate) lane: usize,
}

impl<S: Width<W>, const W: usize, const P: usize, T: Packet<P>> Triangles<S, W>
    for OneTriangle<'_, T, P>
{
    #[inline(always)]
    fn used(&self, _: S) -> u32 {
        u32::MAX
    }

    #[inline(always)]
    fn corners(&self, _: usize) -> [[f32; 3]; 3] {
        self.packet.corners(self.lane)
    }

    #[inline(always)]
    fn sheared<K: Shearing>(&self, simd: S, rays: &Shear<'_, S, W>) -> [[S::Float; 3]; 3] {
        let corner = inlined(
            #[inline(always)]
            |corner: usize| {
                rays.sheared::<K>(
                    simd,
                    #[inline(always)]
                    |axis| simd.splat(self.packet.coordinate(self.lane, corner, axis)),
                )
            },
        );
        [corner(0), corner(1), corner(2)]
    }
}

/// One ray prepared for triangle tests, as it is kept in memory; see [`Shear`].
#[derive(Clone, Copy)]
pub(crate) struct RayShear {
    org: [f32; 3],
    slope: [f32; 2],
    inv_z: f32,
    axes: [Axis; 3],
}

/// An axis in a byte, of which the compiler knows that it is an index of three.
#[derive(Clone, Copy)]
#[repr(u8)]
enum Axis {
    X,
    Y,
    Z,
}

impl Axis {
    #[inline(always)]
    fn index(self) -> usize {
        let index = self as usize;
        // SAFETY: there are three. The compiler forgets it when it loads three at once, and would divide.
        unsafe { std::hint::assert_unchecked(index < 3) };
        index
    }
}

impl RayShear {
    #[inline(always)]
    pub(crate) fn new(ray: &Ray) -> RayShear {
        const AXES: [Axis; 3] = [Axis::X, Axis::Y, Axis::Z];
        let [kx, ky, kz] = axes(ray);
        RayShear {
            org: [ray.org[kx], ray.org[ky], ray.org[kz]],
            slope: [ray.dir[kx] / ray.dir[kz], ray.dir[ky] / ray.dir[kz]],
            inv_z: 1.0 / ray.dir[kz],
            axes: [AXES[kx], AXES[ky], AXES[kz]],
        }
    }
}

/// Rays with the same order of axes, prepared for triangle tests: a translation and a shear take
/// each to the z axis.
///
/// S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013.
pub struct Shear<'a, S: Width<W>, const W: usize> {
    axes: Axes,
    /// Origin, in that order.
    org: [S::Float; 3],
    /// `dir.x / dir.z` and `dir.y / dir.z`.
    slope: [S::Float; 2],
    /// `1 / dir.z`.
    pub(crate) inv_z: S::Float,
    pub(crate) tmin: S::Float,
    rays: Rays<'a, W>,
}

/// The rays as they were given.
#[derive(Clone, Copy)]
enum Rays<'a, const W: usize> {
    /// The same in every lane.
    One(&'a Ray),
    /// A ray a lane.
    Each(&'a RayPacket<W>),
}

impl<'a, S: Width<W>, const W: usize> Shear<'a, S, W> {
    /// One ray, in every lane.
    #[inline(always)]
    pub(crate) fn of_ray(simd: S, ray: &'a Ray, tmin: f32) -> Shear<'a, S, W> {
        Shear::of_prepared(simd, &RayShear::new(ray), ray, tmin)
    }

    /// As [`of_ray`](Shear::of_ray).
    #[inline(always)]
    pub(crate) fn of_prepared(simd: S, shear: &RayShear, ray: &'a Ray, tmin: f32) -> Self {
        let [x, y, z] = shear.org;
        Shear {
            axes: shear.axes.map(Axis::index),
            org: [simd.splat(x), simd.splat(y), simd.splat(z)],
            slope: [simd.splat(shear.slope[0]), simd.splat(shear.slope[1])],
            inv_z: simd.splat(shear.inv_z),
            tmin: simd.splat(tmin),
            rays: Rays::One(ray),
        }
    }

    /// A ray a lane, all with these axes, whose intervals begin at `tmin`.
    #[inline(always)]
    pub(crate) fn of_packet(simd: S, rays: &'a RayPacket<W>, tmin: &[f32; W], axes: Axes) -> Self {
        let [kx, ky, kz] = axes;
        let dir = each(
            axes,
            #[inline(always)]
            |axis| simd.load(&rays.dir[axis]),
        );
        Shear {
            axes,
            org: [
                simd.load(&rays.org[kx]),
                simd.load(&rays.org[ky]),
                simd.load(&rays.org[kz]),
            ],
            slope: [simd.div(dir[0], dir[2]), simd.div(dir[1], dir[2])],
            inv_z: simd.div(simd.splat(1.0), dir[2]),
            tmin: simd.load(tmin),
            rays: Rays::Each(rays),
        }
    }

    /// The order of the axes.
    #[inline(always)]
    pub(crate) fn axes(&self) -> Axes {
        self.axes
    }

    /// `dir.x / dir.z` and `dir.y / dir.z`.
    #[inline(always)]
    pub(crate) fn slope(&self) -> [S::Float; 2] {
        self.slope
    }

    /// The ray in a lane.
    #[inline(always)]
    pub(crate) fn ray(&self, lane: usize) -> Ray {
        match self.rays {
            Rays::One(ray) => *ray,
            Rays::Each(rays) => rays.ray(lane),
        }
    }

    /// A point, given by its coordinate along each axis, in the space where the ray is the z axis; z is not scaled.
    #[inline(always)]
    pub(crate) fn sheared<K: Shearing>(
        &self,
        simd: S,
        point: impl Fn(usize) -> S::Float,
    ) -> [S::Float; 3] {
        let relative = inlined(
            #[inline(always)]
            |axis: usize| simd.sub(point(self.axes[axis]), self.org[axis]),
        );
        let [x, y, z] = [relative(0), relative(1), relative(2)];
        [
            K::sheared(simd, x, self.slope[0], z),
            K::sheared(simd, y, self.slope[1], z),
            z,
        ]
    }
}

/// Which lanes hit, and where.
pub struct LaneHits<S: Width<W>, const W: usize> {
    /// Lanes that hit, as bits.
    pub(crate) lanes: u32,
    /// Lanes hit from behind, as bits; meaningful for those that hit.
    pub(crate) back: u32,
    pub(crate) t: S::Float,
    pub(crate) u: S::Float,
    pub(crate) v: S::Float,
}

impl<S: Width<W>, const W: usize> LaneHits<S, W> {
    /// Only the hits at a distance in `[tmin, tmax]`, if there are any or the test ends as all others.
    #[inline(always)]
    pub(crate) fn within<E: Ending>(
        mut self,
        simd: S,
        tmin: S::Float,
        tmax: S::Float,
        _: E,
    ) -> Option<Self> {
        let within = simd.and(simd.le(tmin, self.t), simd.le(self.t, tmax));
        self.lanes &= simd.bits(within);
        (!E::EARLY || self.lanes != 0).then_some(self)
    }

    /// Replaces `[t, u, v]` in some lanes.
    #[inline(always)]
    pub(crate) fn mend(&mut self, simd: S, lanes: u32, hit: impl Fn(usize) -> [f32; 3]) {
        let [Stored(mut t), Stored(mut u), Stored(mut v)] = self.store(simd);
        for lane in (0..W).filter(|lane| lanes >> lane & 1 == 1) {
            [t[lane], u[lane], v[lane]] = hit(lane);
        }
        (self.t, self.u, self.v) = (simd.load(&t), simd.load(&u), simd.load(&v));
    }

    /// t, u and v of every lane; meaningful for the lanes that hit.
    #[inline(always)]
    pub(crate) fn store(&self, simd: S) -> [Stored<W>; 3] {
        [
            Stored::of(simd, self.t),
            Stored::of(simd, self.u),
            Stored::of(simd, self.v),
        ]
    }
}
