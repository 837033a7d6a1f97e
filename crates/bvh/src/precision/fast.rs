//! The shear test with fused operations throughout.

use crate::filter::Culling;
use crate::inlined::{each, inlined};
use crate::layout::packet::Packet;
use crate::precision::ending::Ending;
use crate::precision::interval::{highest, lowest, product};
use crate::precision::shear_bounds::{ShearBounds, possible_sides};
use crate::precision::shearing::Fused;
use crate::precision::triangle::{LaneHits, Shear, Triangles};
use crate::precision::triangle_test::Precision;
use crate::precision::triangle_test::sealed::Test;
use crate::precision::triangle_test::sides;
use crate::simd::Width;

/// The fastest test. A ray aimed at an edge may slip between the two triangles that share it, and
/// distances to triangles seen edge-on may be off by more than roundings. Answers may differ
/// between instruction sets in the last places.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fast;

impl Precision for Fast {}

impl Test for Fast {
    type Shearing = Fused;

    #[inline(always)]
    fn candidates<S: Width<W>, const W: usize>(
        self,
        simd: S,
        rays: &Shear<'_, S, W>,
        triangles: impl Triangles<S, W>,
        culling: Culling,
    ) -> u32 {
        let corners = triangles.sheared::<Fused>(simd, rays);
        sides(simd, weights(simd, &corners), culling).lanes & triangles.used(simd)
    }

    #[inline(always)]
    fn candidates_of_rays<S: Width<W>, const W: usize>(
        self,
        simd: S,
        rays: &ShearBounds<S, W>,
        packet: &impl Packet<W>,
        culling: Culling,
    ) -> u32 {
        let [a, b, c] = rays.sheared::<Fused>(simd, packet);
        let weights = each(
            [(c, b), (a, c), (b, a)],
            #[inline(always)]
            |(p, q)| {
                let minus = product(simd, p[1], q[0]);
                let ends = inlined(
                    #[inline(always)]
                    |minus: S::Float| {
                        let ([p0, p1], [q0, q1]) = (p[0], q[1]);
                        each(
                            [(p0, q0), (p0, q1), (p1, q0), (p1, q1)],
                            #[inline(always)]
                            |(p, q)| simd.mul_sub(p, q, minus),
                        )
                    },
                );
                [lowest(simd, ends(minus[1])), highest(simd, ends(minus[0]))]
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
        let corners @ [a, b, c] = triangles.sheared::<Fused>(simd, rays);
        let [w, u, v] = weights(simd, &corners);
        let inside = sides(simd, [w, u, v], culling).among(triangles.used(simd));
        if E::EARLY && inside.lanes == 0 {
            return None;
        }
        let inv = simd.div(simd.splat(1.0), simd.add(simd.add(w, u), v));
        let depth = simd.mul_add(v, c[2], simd.mul_add(u, b[2], simd.mul(w, a[2])));
        let hits = LaneHits {
            lanes: inside.lanes,
            back: inside.back,
            t: simd.mul(simd.mul(depth, inv), rays.inv_z),
            u: simd.mul(u, inv),
            v: simd.mul(v, inv),
        };
        hits.within(simd, rays.tmin, tmax, ending)
    }
}

/// Twice the signed areas opposite to each corner.
#[inline(always)]
fn weights<S: Width<W>, const W: usize>(simd: S, &[a, b, c]: &[[S::Float; 3]; 3]) -> [S::Float; 3] {
    let edge = inlined(
        #[inline(always)]
        |p: [S::Float; 3], q: [S::Float; 3]| simd.mul_sub(p[0], q[1], simd.mul(p[1], q[0])),
    );
    [edge(c, b), edge(a, c), edge(b, a)]
}
