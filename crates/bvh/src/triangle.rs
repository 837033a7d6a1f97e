//! One ray against `N` triangles: the watertight shear test.
//!
//! S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. Vertices
//! are moved to the ray's origin and sheared so that the ray runs along z; that is a function of
//! ray and vertex alone, so triangles sharing a vertex see the same point. An edge is then decided
//! by comparing two rounded products, which is exact and antisymmetric in its end points: one of
//! two neighbours, or both, contains the ray. The paper's recomputation in double precision for
//! products that are equal after rounding is not needed: equality counts as inside, for both.
//!
//! Everything up to the early way out is the hot path; the rest runs only for likely hits.

use crate::bounds::{PAD_COORDINATE, PAD_EXTENT};
use crate::bvh::TrianglePacket;
use crate::slab::SlabRay;
use crate::{Culling, Lanes, Ray};

/// A ray prepared for triangle tests.
pub(crate) struct ShearRay<S: Lanes<N>, const N: usize> {
    /// The axes that become x, y and z; z is the direction's greatest.
    axes: [usize; 3],
    /// Origin, in that order.
    org: [S::Float; 3],
    /// `dir.x / dir.z`, `dir.y / dir.z` and `1 / dir.z`.
    shear: [S::Float; 3],
    tmin: S::Float,
}

/// Intersections with a packet.
pub(crate) struct PacketHits<S: Lanes<N>, const N: usize> {
    /// Lanes hit, and those hit from behind, as bits.
    pub(crate) lanes: u32,
    pub(crate) back: u32,
    t: S::Float,
    u: S::Float,
    v: S::Float,
}

impl<S: Lanes<N>, const N: usize> ShearRay<S, N> {
    #[inline(always)]
    pub(crate) fn new(simd: S, ray: &Ray, tmin: f32) -> ShearRay<S, N> {
        let [x, y, z] = ray.dir.map(f32::abs);
        // Two axes swap for negative directions to keep the winding.
        let axes = match (z >= x && z >= y, y >= x) {
            (true, _) if ray.dir[2] < 0.0 => [1, 0, 2],
            (true, _) => [0, 1, 2],
            (false, true) if ray.dir[1] < 0.0 => [0, 2, 1],
            (false, true) => [2, 0, 1],
            (false, false) if ray.dir[0] < 0.0 => [2, 1, 0],
            (false, false) => [1, 2, 0],
        };
        let [kx, ky, kz] = axes;
        ShearRay {
            axes,
            org: [
                simd.splat(ray.org[kx]),
                simd.splat(ray.org[ky]),
                simd.splat(ray.org[kz]),
            ],
            shear: [
                simd.splat(ray.dir[kx] / ray.dir[kz]),
                simd.splat(ray.dir[ky] / ray.dir[kz]),
                simd.splat(1.0 / ray.dir[kz]),
            ],
            tmin: simd.splat(tmin),
        }
    }

    /// The triangles hit at a distance in `[tmin, tmax]`, from the sides that `culling` leaves.
    /// (Marks of single triangles are the caller's business: see [`PacketHits::back`].)
    #[inline(always)]
    pub(crate) fn packet_hits(
        &self,
        simd: S,
        packet: &TrianglePacket<N>,
        slab: &SlabRay<S, N>,
        tmax: S::Float,
        culling: Culling,
    ) -> Option<PacketHits<S, N>> {
        let a = self.to_ray_space(simd, &packet.v0);
        let b = self.to_ray_space(simd, &packet.v1);
        let c = self.to_ray_space(simd, &packet.v2);

        // Twice the signed areas opposite to each vertex are these products' differences.
        let edges = [
            (simd.mul(c[0], b[1]), simd.mul(c[1], b[0])),
            (simd.mul(a[0], c[1]), simd.mul(a[1], c[0])),
            (simd.mul(b[0], a[1]), simd.mul(b[1], a[0])),
        ];
        let [e0, e1, e2] = edges;
        let front = simd.bits(simd.and(
            simd.and(simd.le(e0.1, e0.0), simd.le(e1.1, e1.0)),
            simd.le(e2.1, e2.0),
        ));
        let back = match culling {
            Culling::Back => 0,
            Culling::None | Culling::PerTriangle => simd.bits(simd.and(
                simd.and(simd.le(e0.0, e0.1), simd.le(e1.0, e1.1)),
                simd.le(e2.0, e2.1),
            )),
        };
        let inside = front | back;
        if inside == 0 {
            return None;
        }

        let weights = edges.map(|(p, q)| simd.sub(p, q));
        let determinant = simd.add(simd.add(weights[0], weights[1]), weights[2]);
        // Normalised before they meet the distances: products of three lengths underflow early.
        let [w, u, v] = weights.map(|weight| simd.div(weight, determinant));
        let depth = |vertex: [S::Float; 3]| simd.mul(vertex[2], self.shear[2]);
        let t = simd.add(
            simd.add(simd.mul(w, depth(a)), simd.mul(u, depth(b))),
            simd.mul(v, depth(c)),
        );
        let size = simd.abs(determinant);
        let sound = simd.and(
            simd.and(
                simd.lt(simd.splat(0.0), size),
                simd.lt(size, simd.splat(f32::INFINITY)),
            ),
            simd.le(t, t),
        );

        // Inside the triangle's padded box, and t with it: `bounds.rs` says why.
        let (lo, hi) = padded_bounds(simd, packet);
        let (entry, exit) = slab.box_interval(simd, lo, hi);
        let t = simd.min_number(simd.max_number(t, entry), exit);
        let within = simd.and(
            simd.and(simd.le(entry, exit), simd.le(self.tmin, t)),
            simd.le(t, tmax),
        );
        let lanes = inside & simd.bits(simd.and(sound, within));
        (lanes != 0).then_some(PacketHits {
            lanes,
            back,
            t,
            u,
            v,
        })
    }

    /// Vertices relative to the origin, sheared so that the ray is the z axis. z is not yet
    /// scaled.
    #[inline(always)]
    fn to_ray_space(&self, simd: S, vertex: &[[f32; N]; 3]) -> [S::Float; 3] {
        let relative = |axis: usize| {
            // SAFETY: `axes` is a permutation of 0, 1 and 2, and private to this module.
            let row = unsafe { vertex.get_unchecked(self.axes[axis]) };
            simd.sub(simd.load(row), self.org[axis])
        };
        let z = relative(2);
        [
            simd.sub(relative(0), simd.mul(self.shear[0], z)),
            simd.sub(relative(1), simd.mul(self.shear[1], z)),
            z,
        ]
    }
}

impl<S: Lanes<N>, const N: usize> PacketHits<S, N> {
    /// `(t, u, v)` of every lane; meaningful for the lanes hit.
    #[inline(always)]
    pub(crate) fn store(&self, simd: S) -> ([f32; N], [f32; N], [f32; N]) {
        let (mut t, mut u, mut v) = ([0.0; N], [0.0; N], [0.0; N]);
        simd.store(self.t, &mut t);
        simd.store(self.u, &mut u);
        simd.store(self.v, &mut v);
        (t, u, v)
    }
}

/// [`crate::Bounds::padded`] of each triangle's bounds, with the same roundings.
#[inline(always)]
fn padded_bounds<S: Lanes<N>, const N: usize>(
    simd: S,
    packet: &TrianglePacket<N>,
) -> ([S::Float; 3], [S::Float; 3]) {
    let (mut lo, mut hi) = ([simd.splat(0.0); 3], [simd.splat(0.0); 3]);
    for axis in 0..3 {
        let a = simd.load(&packet.v0[axis]);
        let b = simd.load(&packet.v1[axis]);
        let c = simd.load(&packet.v2[axis]);
        lo[axis] = simd.min_number(simd.min_number(a, b), c);
        hi[axis] = simd.max_number(simd.max_number(a, b), c);
    }
    let extent = |axis: usize| simd.sub(hi[axis], lo[axis]);
    let greatest = simd.max_number(simd.max_number(extent(0), extent(1)), extent(2));
    let pad_extent = simd.mul(greatest, simd.splat(PAD_EXTENT));
    for axis in 0..3 {
        let pad = |x: S::Float| {
            simd.add(
                pad_extent,
                simd.mul(simd.abs(x), simd.splat(PAD_COORDINATE)),
            )
        };
        (lo[axis], hi[axis]) = (
            simd.sub(lo[axis], pad(lo[axis])),
            simd.add(hi[axis], pad(hi[axis])),
        );
    }
    (lo, hi)
}
