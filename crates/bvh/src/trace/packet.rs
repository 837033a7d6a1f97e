//! The packet kernel: `R` rays together, against one box or one triangle at once; and the hybrid
//! one, which goes on with single rays where few of a packet's rays agree.
//!
//! A packet's rays have their octant and their order of axes in common, so that which planes are
//! entered and which axes are sheared is known for all: `window.rs` and `columns.rs` sort them so. At a node, the
//! envelope of the packet is tested against all `N` boxes as a single ray would be; then the rays
//! against each box that it touches. At a leaf, what encloses the packet's rays is tested against `P`
//! triangles at once; then the rays against each of the triangles that it may meet: 3 of 16 in a
//! staircase, 11 of 27 in a room whose triangles are as small as pixels.
//!
//! Measured and rejected: all vertices that a packet's triangles share sheared once, and kept in memory
//! for these (1.3 times as long); packets of few active rays walked on to the end (1.05 times); children not tested against
//! each ray, but for what encloses all alone (1.2 to 1.4 times as long where triangles are small).

use std::mem::MaybeUninit;

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::child::Child;
use crate::layout::class::Class;
use crate::layout::packet::Packet;
use crate::layout::ray_packet::{HitPacket, Intervals, RayPacket};
use crate::layout::validate::MAX_DEPTH;
use crate::precision::shear_bounds::ShearBounds;
use crate::precision::triangle::{OneTriangle, Shear};
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::{Stored, Width};
use crate::trace::best_hits::{BestHits, lanes};
use crate::trace::goal::Goal;
use crate::trace::prefetch::prefetch_child;
use crate::trace::single::{query, search};
use crate::trace::slab::Slab;

/// What stays the same for all packets of a stream.
pub(crate) struct PacketKernel<'a, S, const N: usize, const P: usize, Pr, F, B, T, G> {
    pub(crate) simd: S,
    pub(crate) precision: Pr,
    pub(crate) bvh: BvhView<'a, N, P, B, T>,
    pub(crate) filter: &'a F,
    pub(crate) goal: G,
    /// Whether no triangle reaches so far that products of two coordinates could overflow.
    pub(crate) is_moderate: bool,
    /// So many rays of a packet, or fewer, are traced as single rays.
    pub(crate) few: u32,
}

/// A subtree yet to visit.
#[derive(Clone, Copy)]
struct Entry {
    /// Where the packet's envelope enters it.
    distance: f32,
    child: Child,
    /// The rays that touch it.
    rays: u32,
}

/// As in `stack.rs`: each level leaves at most N - 1 siblings behind.
const STACK_CAPACITY: usize = MAX_DEPTH * 16;

impl<'a, S, const N: usize, const P: usize, Pr, F, B, T, G>
    PacketKernel<'a, S, N, P, Pr, F, B, T, G>
where
    Pr: Precision,
    F: HitFilter,
    B: Boxes<N>,
    T: Packet<P>,
    G: Goal,
{
    /// Packets, however few of their rays agree.
    #[inline(always)]
    pub(crate) fn new(
        simd: S,
        precision: Pr,
        bvh: BvhView<'a, N, P, B, T>,
        filter: &'a F,
        goal: G,
    ) -> Self {
        PacketKernel {
            simd,
            precision,
            bvh,
            filter,
            goal,
            is_moderate: bvh.is_moderate(),
            few: 0,
        }
    }

    /// Packets until few of their `R` rays agree, then single rays: a quarter of 32 or an eighth take 1.05 of the time.
    #[inline(always)]
    pub(crate) fn hybrid<const R: usize>(
        simd: S,
        precision: Pr,
        bvh: BvhView<'a, N, P, B, T>,
        filter: &'a F,
        goal: G,
    ) -> Self {
        PacketKernel {
            few: 3 * R as u32 / 16,
            ..PacketKernel::new(simd, precision, bvh, filter, goal)
        }
    }

    /// Traces one ray alone.
    #[inline(always)]
    pub(crate) fn single(&self, ray: &Ray) -> Hit
    where
        S: Width<N> + Width<P>,
    {
        query(
            self.simd,
            self.precision,
            self.bvh,
            ray,
            self.filter,
            self.goal,
        )
    }

    /// Traces those of the rays whose bits are set. All are of one class, the others, too.
    #[inline(always)]
    pub(crate) fn trace<const R: usize>(
        &self,
        rays: &RayPacket<R>,
        mut alive: u32,
        class: Class,
        hits: &mut HitPacket<R>,
    ) where
        S: Width<N> + Width<P> + Width<R>,
    {
        let simd = self.simd;
        let intervals = rays.intervals(alive);
        let ray_bounds = rays.bounds(simd, &intervals);
        let Intervals { tmin, tmax } = intervals;
        let envelope = Slab::<S, N>::enclosing(simd, rays, &ray_bounds, class.octant);
        let slab = Slab::<S, R>::of_rays(simd, rays, &tmin, class.octant);
        let shear = Shear::<S, R>::of_packet(simd, rays, &tmin, class.axes);

        let shear_bounds = match self.is_moderate && rays.is_moderate(simd) {
            true => Some(ShearBounds::<S, P>::enclosing(simd, &ray_bounds, &shear)),
            false => None,
        };

        let mut best = BestHits::none(tmax);
        let mut farthest = ray_bounds.hi[3];
        let mut stack = [const { MaybeUninit::<Entry>::uninit() }; STACK_CAPACITY];
        let mut len = 0;
        let mut child = Child::ROOT;
        let mut active = alive;
        loop {
            if active.count_ones() <= self.few {
                for lane in lanes(active) {
                    // SAFETY: this is the root or a child of one of the hierarchy's nodes.
                    let hit = unsafe {
                        search(
                            simd,
                            self.precision,
                            self.bvh,
                            child,
                            &rays.ray(lane),
                            tmin[lane],
                            self.filter,
                            self.goal,
                            best.hit(lane),
                        )
                    };
                    best.set(lane, &hit, self.goal);
                }
                farthest = best.farthest(simd);
            } else if child.is_leaf() {
                if self.leaf(child, &shear, shear_bounds.as_ref(), &mut best) {
                    farthest = best.farthest(simd);
                }
            } else {
                // SAFETY: children that are not leaves index the nodes of a sound hierarchy.
                let node = unsafe { self.bvh.nodes().get_unchecked(child.0 as usize) };
                let (mut touched, entry) = envelope.touched_children(simd, node, farthest);
                let Stored(distances) = Stored::<N>::of(simd, entry);
                let base = len;
                while touched != 0 {
                    // The last first: pushed in reverse, children come in their order.
                    let slot = (31 - touched.leading_zeros()) as usize % N;
                    touched &= !(1 << slot);
                    let touching = active & slab.touching_rays(simd, node, slot, &best.t);
                    if touching == 0 {
                        continue;
                    }
                    let child = Child(node.children()[slot]);
                    prefetch_child(self.bvh.nodes(), self.bvh.packets(), child);
                    let entry = Entry {
                        distance: distances[slot],
                        child,
                        rays: touching,
                    };
                    // Insertion, nearest on top; where any hit will do, the order is the builder's.
                    let mut index = len;
                    while !G::ANY && index > base {
                        // SAFETY: entries below `len` are initialised.
                        let other = unsafe { stack[index - 1].assume_init() };
                        if other.distance >= entry.distance {
                            break;
                        }
                        stack[index].write(other);
                        index -= 1;
                    }
                    stack[index].write(entry);
                    len += 1;
                }
            }
            if G::ANY {
                alive = 0;
                for (lane, &tmax) in best.t.iter().enumerate() {
                    alive |= u32::from(tmax >= 0.0) << lane;
                }
            }
            let next = loop {
                if len == 0 {
                    break None;
                }
                len -= 1;
                // SAFETY: this was below `len` until now.
                let entry = unsafe { stack[len].assume_init() };
                if entry.rays & alive != 0 && entry.distance <= farthest {
                    break Some(entry);
                }
            };
            match next {
                Some(entry) => (child, active) = (entry.child, entry.rays & alive),
                None => break,
            }
        }
        best.finish(rays, hits);
    }

    /// Tests the leaf's triangles. Returns whether there were hits.
    #[inline(always)]
    fn leaf<const R: usize>(
        &self,
        leaf: Child,
        shear: &Shear<'_, S, R>,
        bounds: Option<&ShearBounds<S, P>>,
        best: &mut BestHits<R>,
    ) -> bool
    where
        S: Width<R> + Width<P>,
    {
        let simd = self.simd;
        let mut found = false;
        let first = leaf.first_packet();
        for packet in &self.bvh.packets()[first..first + leaf.packet_count()] {
            let candidates = match bounds {
                None => u32::MAX,
                Some(bounds) => self
                    .precision
                    .candidates_of_rays(simd, bounds, packet, F::CULLING),
            };
            for lane in lanes(candidates & (u32::MAX >> (32 - P))) {
                let prim = packet.prim_ids()[lane % P];
                if prim == u32::MAX {
                    break;
                }
                let triangle = OneTriangle { packet, lane };
                found |= best.improve(
                    simd,
                    self.precision,
                    shear,
                    triangle,
                    prim,
                    self.filter,
                    self.goal,
                );
            }
        }
        found
    }
}
