//! What a query costs: the steps of the single-ray walk, counted as it takes them.

use std::ops::ControlFlow;

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::child::Child;
use crate::layout::packet::Packet;
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::goal::ClosestHit;
use crate::trace::single::Search;
use crate::trace::slab::Slab;
use crate::trace::traverse::{Visitor, traverse};

/// The steps of one ray's walk through a hierarchy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TraversalCost {
    /// Nodes whose `N` boxes were tested, the root included.
    pub nodes: u32,
    /// Packets whose `P` triangles were tested.
    pub packets: u32,
}

/// What [`closest_hit`](crate::closest_hit) visits until it knows the answer.
///
/// A valid ray tests the root's boxes at least; one that is not [valid](Ray::is_valid) visits
/// nothing. A shorter interval never costs more.
#[inline(always)]
pub fn traversal_cost<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    ray: &Ray,
    filter: &impl HitFilter,
) -> TraversalCost
where
    S: Width<N> + Width<P>,
{
    let cost = TraversalCost::default();
    if !ray.is_valid() {
        return cost;
    }
    let (tmin, tmax) = ray.interval();
    let (packets, best) = (bvh.packets(), Hit::miss(tmax));
    let visitor = Search::new(
        simd, precision, packets, ray, tmin, filter, ClosestHit, best,
    );
    let mut counted = Counted { visitor, cost };
    let slab = Slab::<S, N>::of_ray(simd, ray, tmin);
    // SAFETY: the view is structurally valid, and the root is there.
    unsafe { traverse(simd, bvh.nodes(), Child::ROOT, &slab, &mut counted) };
    counted.cost
}

/// A visitor, and the cost of its walk so far. It visits all packets of its leaves.
struct Counted<V> {
    visitor: V,
    cost: TraversalCost,
}

impl<V: Visitor> Visitor for Counted<V> {
    type Goal = V::Goal;
    type Item = V::Item;

    #[inline(always)]
    fn items(&self) -> &[V::Item] {
        self.visitor.items()
    }

    #[inline(always)]
    fn tmax(&self) -> f32 {
        self.visitor.tmax()
    }

    #[inline(always)]
    fn node(&mut self) {
        self.cost.nodes += 1;
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: Child) -> ControlFlow<()> {
        self.cost.packets += leaf.packet_count() as u32;
        self.visitor.leaf(leaf)
    }
}
