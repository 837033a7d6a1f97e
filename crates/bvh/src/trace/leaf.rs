//! What a leaf's packet does to a ray's best hit.

use std::hint::select_unpredictable;
use std::ops::ControlFlow;

use crate::filter::{Culling, HitFilter, improve};
use crate::layout::packet::Packet;
use crate::layout::triangle_packet::SINGLE_SIDED;
use crate::precision::ending::{Early, Even};
use crate::precision::triangle::{LaneHits, Shear};
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::{Stored, Width};
use crate::trace::goal::Goal;

/// Improves the best hit by the packet's triangles. Breaks where any hit will do.
#[inline(always)]
pub(crate) fn improve_by_packet<S: Width<P>, const P: usize, F: HitFilter>(
    simd: S,
    precision: impl Precision,
    shear: &Shear<'_, S, P>,
    packet: &impl Packet<P>,
    ray: &Ray,
    filter: &F,
    goal: impl Goal,
    best: &mut Hit,
) -> ControlFlow<()> {
    let tmax = simd.splat(best.t);
    match precision.test(simd, shear, packet, tmax, F::CULLING, Early) {
        Some(hits) => improve_by_lanes(simd, &hits, packet, ray, filter, goal, best),
        None => ControlFlow::Continue(()),
    }
}

/// As [`improve_by_packet`], without a branch on which triangles are hit, as long as it is one or none
/// that is nearest: for a ray whose steps overlap with those of others, all of which would wait for a
/// branch that was mispredicted. Where any hit will do, it is not said which.
#[inline(always)]
pub(crate) fn improve_evenly<S: Width<P>, const P: usize, F: HitFilter, G: Goal>(
    simd: S,
    precision: impl Precision,
    shear: &Shear<'_, S, P>,
    packet: &impl Packet<P>,
    ray: &Ray,
    filter: &F,
    goal: G,
    best: &mut Hit,
) -> ControlFlow<()> {
    let tmax = simd.splat(best.t);
    let Some(hits) = precision.test(simd, shear, packet, tmax, F::CULLING, Even) else {
        return ControlFlow::Continue(());
    };
    let marks_count = matches!(F::CULLING, Culling::PerTriangle);
    if G::ANY {
        if !(F::REJECTS || marks_count && hits.back & hits.lanes != 0) {
            best.prim = select_unpredictable(hits.lanes != 0, 0, best.prim);
            return if hits.lanes == 0 {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            };
        }
    } else if !F::REJECTS {
        let distances = simd.select(hits.lanes, hits.t, simd.splat(f32::INFINITY));
        let nearest = simd.least(distances);
        let at = hits.lanes & simd.bits(simd.le(distances, simd.splat(nearest)));
        // Without a hit, some lane.
        let lane = at.trailing_zeros() as usize % P;
        let prim = packet.prim_ids()[lane];
        // The same hit again, of a triangle that lies in several leaves, changes nothing.
        let is_new = (prim & !SINGLE_SIDED) != best.prim;
        let tie = (at & at.wrapping_sub(1) != 0) | ((nearest == best.t) & is_new);
        let is_marked = marks_count & (prim & SINGLE_SIDED != 0);
        if !(tie | (is_marked & (hits.back & at != 0))) {
            let [_, Stored(u), Stored(v)] = hits.store(simd);
            let is_hit = at != 0;
            best.t = select_unpredictable(is_hit, nearest, best.t);
            best.u = select_unpredictable(is_hit, u[lane], best.u);
            best.v = select_unpredictable(is_hit, v[lane], best.v);
            best.prim = select_unpredictable(is_hit, prim & !SINGLE_SIDED, best.prim);
            return ControlFlow::Continue(());
        }
    }
    improve_by_lanes(simd, &hits, packet, ray, filter, goal, best)
}

/// Improves the best hit by those of the lanes, one after the other. Breaks where any hit will do.
#[inline(always)]
fn improve_by_lanes<S: Width<P>, const P: usize>(
    simd: S,
    hits: &LaneHits<S, P>,
    packet: &impl Packet<P>,
    ray: &Ray,
    filter: &impl HitFilter,
    goal: impl Goal,
    best: &mut Hit,
) -> ControlFlow<()> {
    let [Stored(t), Stored(u), Stored(v)] = hits.store(simd);
    let mut lanes = hits.lanes;
    while lanes != 0 {
        // The remainder keeps a lane in range for the compiler; hits have bits in 0..P only.
        let lane = lanes.trailing_zeros() as usize % P;
        lanes &= lanes - 1;
        let hit = Hit {
            t: t[lane],
            u: u[lane],
            v: v[lane],
            prim: packet.prim_ids()[lane],
        };
        let back = hits.back >> lane & 1 == 1;
        if improve(best, hit, back, ray, filter) {
            goal.found()?;
        }
    }
    ControlFlow::Continue(())
}
