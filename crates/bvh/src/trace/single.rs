//! The single-ray kernel: `N` boxes, or `P` triangles, at once.

use std::ops::ControlFlow;

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::child::Child;
use crate::layout::packet::Packet;
use crate::precision::triangle::Shear;
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::goal::{AnyHit, ClosestHit, Goal};
use crate::trace::leaf::improve_by_packet;
use crate::trace::slab::Slab;
use crate::trace::traverse::{Visitor, traverse};

/// The nearest hit in the ray's interval that `filter` accepts; of several at the same distance,
/// the one with the smallest triangle index.
#[inline(always)]
pub fn closest_hit<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    ray: &Ray,
    filter: &impl HitFilter,
) -> Hit
where
    S: Width<N> + Width<P>,
{
    query(simd, precision, bvh, ray, filter, ClosestHit)
}

/// Whether there is a hit in the ray's interval that `filter` accepts: exactly when
/// [`closest_hit`] finds one.
#[inline(always)]
pub fn any_hit<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    ray: &Ray,
    filter: &impl HitFilter,
) -> bool
where
    S: Width<N> + Width<P>,
{
    query(simd, precision, bvh, ray, filter, AnyHit).is_hit()
}

/// Either query; where any hit will do, the hit is any.
#[inline(always)]
pub(crate) fn query<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    ray: &Ray,
    filter: &impl HitFilter,
    goal: impl Goal,
) -> Hit
where
    S: Width<N> + Width<P>,
{
    if !ray.is_valid() {
        return Hit::miss(ray.tmax);
    }
    let (tmin, tmax) = ray.interval();
    // SAFETY: the root is there.
    let best = unsafe {
        search(
            simd,
            precision,
            bvh,
            Child::ROOT,
            ray,
            tmin,
            filter,
            goal,
            Hit::miss(tmax),
        )
    };
    if best.is_hit() {
        best
    } else {
        Hit::miss(ray.tmax)
    }
}

/// Improves `best` by what lies below `start`. The ray is valid, `tmin` not negative.
///
/// # Safety
/// `start` must be the hierarchy's root or one of its nodes' children.
#[inline(always)]
pub(crate) unsafe fn search<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    start: Child,
    ray: &Ray,
    tmin: f32,
    filter: &impl HitFilter,
    goal: impl Goal,
    best: Hit,
) -> Hit
where
    S: Width<N> + Width<P>,
{
    let slab = Slab::<S, N>::of_ray(simd, ray, tmin);
    let packets = bvh.packets();
    let mut search = Search::new(simd, precision, packets, ray, tmin, filter, goal, best);
    // SAFETY: the view is structurally valid, and the start is by this function's contract.
    unsafe { traverse(simd, bvh.nodes(), start, &slab, &mut search) };
    search.best
}

/// The search for one ray's hit.
pub(crate) struct Search<'a, S: Width<P>, const P: usize, Pr, T, F, G> {
    simd: S,
    precision: Pr,
    packets: &'a [T],
    shear: Shear<'a, S, P>,
    ray: &'a Ray,
    filter: &'a F,
    goal: G,
    best: Hit,
}

impl<S: Width<P>, const P: usize, Pr: Precision, T: Packet<P>, F: HitFilter, G: Goal> Visitor
    for Search<'_, S, P, Pr, T, F, G>
{
    type Goal = G;
    type Item = T;

    #[inline(always)]
    fn items(&self) -> &[T] {
        self.packets
    }

    #[inline(always)]
    fn tmax(&self) -> f32 {
        self.best.t
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: Child) -> ControlFlow<()> {
        for index in leaf.first_packet()..leaf.first_packet() + leaf.packet_count() {
            // SAFETY: the leaves of a sound hierarchy have packets that exist.
            let packet = unsafe { self.packets.get_unchecked(index) };
            improve_by_packet(
                self.simd,
                self.precision,
                &self.shear,
                packet,
                self.ray,
                self.filter,
                self.goal,
                &mut self.best,
            )?;
        }
        ControlFlow::Continue(())
    }
}

impl<'a, S: Width<P>, const P: usize, Pr: Precision, T: Packet<P>, F: HitFilter, G: Goal>
    Search<'a, S, P, Pr, T, F, G>
{
    /// For a hit better than `best`. The ray is valid, `tmin` not negative.
    #[inline(always)]
    pub(crate) fn new(
        simd: S,
        precision: Pr,
        packets: &'a [T],
        ray: &'a Ray,
        tmin: f32,
        filter: &'a F,
        goal: G,
        best: Hit,
    ) -> Self {
        Search {
            simd,
            precision,
            packets,
            shear: Shear::of_ray(simd, ray, tmin),
            ray,
            filter,
            goal,
            best,
        }
    }
}
