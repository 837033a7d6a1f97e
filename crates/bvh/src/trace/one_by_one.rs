//! The kernel without SIMD: one box, or one triangle, at a time. It is what the others are compared with:
//! the same walk, and the same tests in one lane.

use std::ops::ControlFlow;

use crate::bounds::Bounds;
use crate::filter::{HitFilter, improve};
use crate::layout::boxes::Boxes;
use crate::layout::boxes::sealed::Sealed;
use crate::layout::bvh::BvhView;
use crate::layout::child::Child;
use crate::layout::packet::Packet;
use crate::precision::ending::Early;
use crate::precision::triangle::{OneTriangle, Shear};
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::{Stored, Width};
use crate::trace::goal::{AnyHit, ClosestHit, Goal};
use crate::trace::slab::Slab;
use crate::trace::stream::Kernel;
use crate::trace::traverse::{BoxTest, Visitor, traverse};

/// One ray, one box: without SIMD, for comparison. As without lanes nothing is fused, [`Fast`] may
/// give other last places than the other kernels.
///
/// [`Fast`]: crate::Fast
#[derive(Clone, Copy, Debug, Default)]
pub struct OneByOne;

impl<S, const N: usize, const P: usize> Kernel<S, N, P> for OneByOne
where
    S: Width<N> + Width<P>,
{
    #[inline(always)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), hits.len(), "a hit for each ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = query(simd, precision, bvh, ray, filter, ClosestHit);
        }
    }

    #[inline(always)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
        for (ray, occluded) in rays.iter().zip(occluded) {
            *occluded = query(simd, precision, bvh, ray, filter, AnyHit).is_hit();
        }
    }
}

#[inline(always)]
fn query<S: Width<N>, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    ray: &Ray,
    filter: &impl HitFilter,
    goal: impl Goal,
) -> Hit {
    if !ray.is_valid() {
        return Hit::miss(ray.tmax);
    }
    let (tmin, tmax) = ray.interval();
    let mut search = Search {
        simd,
        precision,
        packets: bvh.packets(),
        shear: Shear::<S, 1>::of_ray(simd, ray, tmin),
        ray,
        filter,
        goal,
        best: Hit::miss(tmax),
    };
    let test = BoxByBox(Slab::<S, 1>::of_ray(simd, ray, tmin));
    // SAFETY: the view is structurally valid, and the root is there.
    unsafe { traverse(simd, bvh.nodes(), Child::ROOT, &test, &mut search) };
    if search.best.is_hit() {
        search.best
    } else {
        Hit::miss(ray.tmax)
    }
}

/// The boxes of a node one after the other.
struct BoxByBox<S: Width<1>>(Slab<S, 1>);

impl<S: Width<N>, const N: usize> BoxTest<S, N> for BoxByBox<S> {
    #[inline(always)]
    fn touched_children(&self, simd: S, node: &impl Boxes<N>, tmax: f32) -> (u32, S::Float) {
        let mut touched = 0;
        let mut distances = [0.0; N];
        for (slot, distance) in distances.iter_mut().enumerate() {
            if Child(node.children()[slot]) == Child::VACANT {
                continue;
            }
            let (touches, entry) = self.0.touched_children(simd, &OneBox { node, slot }, tmax);
            touched |= touches << slot;
            let mut lane = [0.0];
            <S as Width<1>>::store(simd, entry, &mut lane);
            [*distance] = lane;
        }
        (touched & node.used(), simd.load(&distances))
    }
}

/// One box of a node, as a node of one box.
#[derive(Clone, Copy, Debug)]
struct OneBox<'a, B, const N: usize> {
    node: &'a B,
    slot: usize,
}

impl<B, const N: usize> Sealed for OneBox<'_, B, N> {}

// SAFETY: the child is one of a node that gives the same children each time.
unsafe impl<B: Boxes<N>, const N: usize> Boxes<1> for OneBox<'_, B, N> {
    #[inline(always)]
    fn children(&self) -> &[u32; 1] {
        std::array::from_ref(&self.node.children()[self.slot])
    }

    #[inline(always)]
    fn used(&self) -> u32 {
        self.node.used() >> self.slot
    }

    #[inline(always)]
    unsafe fn plane<S: Width<1>>(&self, simd: S, axis: usize, row: usize) -> S::Float {
        simd.splat(self.node.plane_of(self.slot, axis, row))
    }

    #[inline(always)]
    fn plane_of(&self, _: usize, axis: usize, row: usize) -> f32 {
        self.node.plane_of(self.slot, axis, row)
    }

    fn child_bounds(&self, _: usize) -> Bounds {
        self.node.child_bounds(self.slot)
    }
}

/// The search for one ray's hit.
struct Search<'a, S: Width<1>, const P: usize, Pr, T, F, G> {
    simd: S,
    precision: Pr,
    packets: &'a [T],
    shear: Shear<'a, S, 1>,
    ray: &'a Ray,
    filter: &'a F,
    goal: G,
    best: Hit,
}

impl<S: Width<1>, const P: usize, Pr: Precision, T: Packet<P>, F: HitFilter, G: Goal> Visitor
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
        let first = leaf.first_packet();
        for packet in &self.packets[first..first + leaf.packet_count()] {
            for (lane, &prim) in packet.prim_ids().iter().enumerate() {
                if prim == u32::MAX {
                    break;
                }
                let triangle = OneTriangle { packet, lane };
                let tmax = self.simd.splat(self.best.t);
                let test =
                    self.precision
                        .test(self.simd, &self.shear, triangle, tmax, F::CULLING, Early);
                let Some(test) = test else { continue };
                let [Stored([t]), Stored([u]), Stored([v])] = test.store(self.simd);
                let hit = Hit { t, u, v, prim };
                if improve(&mut self.best, hit, test.back != 0, self.ray, self.filter) {
                    self.goal.found()?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}
