//! The shear test as its authors meant it, without its double-precision fallback.
//!
//! Moving the vertices to the ray's origin and shearing them is a function of ray and vertex
//! alone, so triangles sharing a vertex see the same point. An edge is then decided by comparing
//! two rounded products, through the sign of their difference, which is exact and antisymmetric in
//! its end points: one of two neighbours, or both, contains the ray. The paper's recomputation in double precision for
//! products that are equal after rounding is not needed: equality counts as inside, for both.

use glam::DVec3;

use crate::bounds::Bounds;
use crate::filter::Culling;
use crate::inlined::{each, inlined};
use crate::layout::packet::Packet;
use crate::precision::ending::Ending;
use crate::precision::interval::product;
use crate::precision::shear_bounds::{ShearBounds, possible_sides};
use crate::precision::shearing::Rounded;
use crate::precision::triangle::{LaneHits, Shear, Triangles};
use crate::precision::triangle_test::Precision;
use crate::precision::triangle_test::sealed::Test;
use crate::precision::triangle_test::sides;
use crate::ray::Ray;
use crate::simd::Width;

/// Closed meshes have no holes: what a ray misses on one side of an edge, it hits on the other.
/// The same bits on every instruction set.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Watertight;

impl Precision for Watertight {}

/// How many times larger than twice the triangle's area the products may be whose differences are
/// the areas of its parts, until the hit counts as ill-conditioned: a triangle seen edge-on.
/// `bounds.rs` says how the boxes' padding follows from it.
const CONDITION: f32 = 32.0;
/// Areas near the underflow are not to be trusted either.
const SMALLEST: f32 = 1e-30;

impl Test for Watertight {
    type Shearing = Rounded;

    #[inline(always)]
    fn candidates<S: Width<W>, const W: usize>(
        self,
        simd: S,
        rays: &Shear<'_, S, W>,
        triangles: impl Triangles<S, W>,
        culling: Culling,
    ) -> u32 {
        let corners = triangles.sheared::<Rounded>(simd, rays);
        let weights = each(
            products(simd, &corners),
            #[inline(always)]
            |(p, q)| simd.sub(p, q),
        );
        sides(simd, weights, culling).lanes & triangles.used(simd)
    }

    #[inline(always)]
    fn candidates_of_rays<S: Width<W>, const W: usize>(
        self,
        simd: S,
        rays: &ShearBounds<S, W>,
        packet: &impl Packet<W>,
        culling: Culling,
    ) -> u32 {
        let [a, b, c] = rays.sheared::<Rounded>(simd, packet);
        let weights = each(
            [(c, b), (a, c), (b, a)],
            #[inline(always)]
            |(p, q)| {
                let (plus, minus) = (product(simd, p[0], q[1]), product(simd, p[1], q[0]));
                [simd.sub(plus[0], minus[1]), simd.sub(plus[1], minus[0])]
            },
        );
        possible_sides(simd, weights, culling)
    }

    #[inline(always)]
    fn test<S: Width<W>, const W: usize, E: Ending>(
        self,
        simd: S,
        rays: &Shear<'_, S, W>,
        triangles: impl Triangles<S, W>,
        tmax: S::Float,
        culling: Culling,
        ending: E,
    ) -> Option<LaneHits<S, W>> {
        let corners @ [a, b, c] = triangles.sheared::<Rounded>(simd, rays);
        let edges = products(simd, &corners);
        let [w, u, v] = each(
            edges,
            #[inline(always)]
            |(p, q)| simd.sub(p, q),
        );
        let mut inside = sides(simd, [w, u, v], culling).among(triangles.used(simd));
        if E::EARLY && inside.lanes == 0 {
            return None;
        }

        // Everything from here on is for likely hits.
        let determinant = simd.add(simd.add(w, u), v);
        // Not NaN.
        inside.lanes &= simd.bits(simd.le(determinant, determinant));
        let inv = simd.div(simd.splat(1.0), determinant);
        let [w, u, v] = each(
            [w, u, v],
            #[inline(always)]
            |weight| simd.mul(weight, inv),
        );
        let depth = simd.add(
            simd.add(simd.mul(w, a[2]), simd.mul(u, b[2])),
            simd.mul(v, c[2]),
        );
        let mut hits = LaneHits {
            lanes: inside.lanes,
            back: inside.back,
            t: simd.mul(depth, rays.inv_z),
            u,
            v,
        };

        let size = inlined(
            #[inline(always)]
            |(p, q): (S::Float, S::Float)| simd.add(simd.abs(p), simd.abs(q)),
        );
        let sizes = simd.add(simd.add(size(edges[0]), size(edges[1])), size(edges[2]));
        let well = simd.lt(
            simd.add(sizes, simd.splat(SMALLEST)),
            simd.mul(simd.abs(determinant), simd.splat(CONDITION)),
        );
        let ill = inside.lanes & !simd.bits(well);
        if ill != 0 {
            hits.mend(simd, ill, |lane| {
                ill_conditioned_hit(&rays.ray(lane), &triangles.corners(lane))
            });
        }
        hits.within(simd, rays.tmin, tmax, ending)
    }
}

/// The products whose differences are twice the signed areas opposite to each vertex. With gradual underflow a
/// difference has the sign of the comparison; flushed to zero it counts as inside, for both neighbours.
#[inline(always)]
fn products<S: Width<W>, const W: usize>(
    simd: S,
    &[a, b, c]: &[[S::Float; 3]; 3],
) -> [(S::Float, S::Float); 3] {
    let products = inlined(
        #[inline(always)]
        |p: [S::Float; 3], q: [S::Float; 3]| (simd.mul(p[0], q[1]), simd.mul(p[1], q[0])),
    );
    [products(c, b), products(a, c), products(b, a)]
}

/// `[t, u, v]` of a ray that passes inside the triangle, when `f32` cannot say where: computed in
/// `f64`, the distance then moved to where the ray passes through the triangle's padded box. NaN
/// if it is nowhere, or beside the box.
#[cold]
#[inline(never)]
fn ill_conditioned_hit(ray: &Ray, corners: &[[f32; 3]; 3]) -> [f32; 3] {
    let (entry, exit) = Bounds::of_padded_triangle(corners).passage(ray);
    let [t, u, v] = line_meets_plane(ray, corners);
    if t.is_finite() && entry <= exit {
        [t.max(entry).min(exit), u, v]
    } else {
        [f32::NAN; 3]
    }
}

/// `[t, u, v]` of a line that passes inside the triangle, or at most by a rounding outside, in
/// `f64`; not finite if it lies in the triangle's plane.
fn line_meets_plane(ray: &Ray, corners: &[[f32; 3]; 3]) -> [f32; 3] {
    let dir = DVec3::from(ray.dir.map(f64::from));
    let org = DVec3::from(ray.org.map(f64::from));
    let [a, b, c] = corners.map(|corner| DVec3::from(corner.map(f64::from)) - org);
    let weights = [c.cross(b), a.cross(c), b.cross(a)].map(|normal| normal.dot(dir));
    let side = weights.iter().sum::<f64>().signum();
    let [w, u, v] = weights.map(|weight| (side * weight).max(0.0));
    let sum = w + u + v;
    let depth = (w * a.dot(dir) + u * b.dot(dir) + v * c.dot(dir)) / dir.length_squared();
    [depth / sum, u / sum, v / sum].map(|x| x as f32)
}
