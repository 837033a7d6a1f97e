//! The phased kernel: many rays in flight on one thread, which take like steps together.
//!
//! A ray alone waits: for memory, for the end of a chain of operations, for a branch that was
//! mispredicted. Here every ray has a slot with its constants, its best hit and its stack, and in each
//! phase all rays that stand at the same kind of thing take their step: at a node, at a packet of
//! triangles, at their end. Steps of different rays do not depend on each other, so that the processor
//! overlaps them; they do without branches that are hard to predict, since all rays would wait for one;
//! and what a ray reads next is on its way to the caches while others take their steps.
//!
//! Measured and rejected: all rays in turn, each a step of whatever kind (no gain: the branches are what
//! they were); 16 or 64 slots instead of 32 (1 to 2 % slower); fewer lines prefetched for nodes than for
//! packets (2 %); all packets of a leaf in one step (4 %).

use std::hint::select_unpredictable;

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::child::Child;
use crate::layout::packet::Packet;
use crate::precision::triangle::{RayShear, Shear};
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::flight_stack::{FlightStack, Keys, Popped};
use crate::trace::goal::Goal;
use crate::trace::leaf::improve_evenly;
use crate::trace::prefetch::prefetch_child;
use crate::trace::slab::{RaySlab, Slab};

/// Rays in flight: a power of two, so that a remainder keeps the index of a slot in range.
const SLOTS: usize = 32;

/// A ray in flight: two lines of the caches.
#[derive(Clone, Copy)]
#[repr(align(64))]
struct Flight {
    slab: RaySlab,
    shear: RayShear,
    tmin: f32,
    best: Hit,
    /// Index of the ray in its stream.
    ray: u32,
    /// Where it stands: at a node, or at the first packet of a leaf.
    current: Child,
    /// Length of its stack.
    stacked: u32,
}

const _: () = assert!(size_of::<Flight>() == 128);

impl Flight {
    /// At the root.
    #[inline(always)]
    fn new<S: Width<4>>(simd: S, ray: &Ray, index: usize) -> Flight {
        let (tmin, tmax) = ray.interval();
        Flight {
            slab: RaySlab::new(simd, ray),
            shear: RayShear::new(ray),
            tmin,
            best: Hit::miss(tmax),
            ray: index as u32,
            current: Child::ROOT,
            stacked: FlightStack::EMPTY,
        }
    }
}

/// Slots whose rays stand at the same kind of thing.
struct WorkList {
    slots: [u8; SLOTS],
    len: usize,
}

impl WorkList {
    const EMPTY: WorkList = WorkList {
        slots: [0; SLOTS],
        len: 0,
    };

    /// Appends the slot if it belongs here, without a branch. A slot is in one list only, so there is room.
    #[inline(always)]
    fn put_if(&mut self, belongs: bool, slot: usize) {
        self.slots[self.len % SLOTS] = slot as u8;
        self.len += usize::from(belongs);
    }

    #[inline(always)]
    fn get(&self, position: usize) -> usize {
        usize::from(self.slots[position % SLOTS]) % SLOTS
    }
}

/// What the slots' rays stand at.
struct Work {
    nodes: WorkList,
    leaves: WorkList,
    ends: WorkList,
}

impl Work {
    #[inline(always)]
    fn put(&mut self, slot: usize, next: &Popped) {
        let is_leaf = next.child.is_leaf();
        self.nodes.put_if(!is_leaf, slot);
        self.leaves.put_if(is_leaf & !next.is_bottom, slot);
        self.ends.put_if(next.is_bottom, slot);
    }
}

/// What stays the same for all rays of a stream.
pub(crate) struct PhasedKernel<'a, S, const N: usize, const P: usize, Pr, F, B, T, G> {
    pub(crate) simd: S,
    pub(crate) precision: Pr,
    pub(crate) bvh: BvhView<'a, N, P, B, T>,
    pub(crate) filter: &'a F,
    pub(crate) goal: G,
}

impl<S, const N: usize, const P: usize, Pr, F, B, T, G> PhasedKernel<'_, S, N, P, Pr, F, B, T, G>
where
    S: Width<N> + Width<P>,
    Pr: Precision,
    F: HitFilter,
    B: Boxes<N>,
    T: Packet<P>,
    G: Goal,
{
    /// Finds the hit of each ray; `answer` gets its index and the hit, in whatever order.
    #[inline(always)]
    pub(crate) fn trace(&self, rays: &[Ray], mut answer: impl FnMut(usize, Hit)) {
        let nobody = Ray::unbounded([0.0; 3], [1.0; 3]);
        let mut flights = [Flight::new(self.simd, &nobody, 0); SLOTS];
        let mut stacks = [FlightStack::UNINIT; SLOTS];
        let mut keys = Keys::NONE;
        let mut work = Work {
            nodes: WorkList::EMPTY,
            leaves: WorkList::EMPTY,
            ends: WorkList::EMPTY,
        };

        // Rays take their slots. One that is invalid needs none.
        let mut waiting = rays.iter().enumerate();
        for slot in 0..SLOTS {
            let launched = self.launch(&mut waiting, &mut answer);
            work.nodes.put_if(launched.is_some(), slot);
            if let Some(flight) = launched {
                flights[slot] = flight;
                stacks[slot].clear();
            }
        }
        while work.nodes.len + work.leaves.len > 0 {
            // Slots are put where others have been taken from before.
            for position in 0..std::mem::take(&mut work.nodes.len) {
                let slot = work.nodes.get(position);
                // SAFETY: the ray stands at a node of the hierarchy.
                let next = unsafe { self.node(&mut flights[slot], &mut stacks[slot], &mut keys) };
                work.put(slot, &next);
            }
            for position in 0..std::mem::take(&mut work.leaves.len) {
                let slot = work.leaves.get(position);
                // SAFETY: the ray stands at a leaf of the hierarchy.
                let next = unsafe { self.packet(rays, &mut flights[slot], &mut stacks[slot]) };
                work.put(slot, &next);
            }
            for position in 0..std::mem::take(&mut work.ends.len) {
                let slot = work.ends.get(position);
                let Flight { ray, best, .. } = flights[slot];
                let ray = ray as usize;
                let hit = if best.is_hit() {
                    best
                } else {
                    Hit::miss(rays[ray].tmax)
                };
                answer(ray, hit);
                let launched = self.launch(&mut waiting, &mut answer);
                work.nodes.put_if(launched.is_some(), slot);
                if let Some(flight) = launched {
                    flights[slot] = flight;
                    stacks[slot].clear();
                }
            }
        }
    }

    /// The next valid ray at its start; those before it miss.
    #[inline(always)]
    fn launch<'r>(
        &self,
        waiting: &mut impl Iterator<Item = (usize, &'r Ray)>,
        answer: &mut impl FnMut(usize, Hit),
    ) -> Option<Flight> {
        for (index, ray) in waiting {
            if ray.is_valid() {
                return Some(Flight::new(self.simd, ray, index));
            }
            answer(index, Hit::miss(ray.tmax));
        }
        None
    }

    /// Tests the boxes of a node and goes on to the next node or leaf.
    ///
    /// # Safety
    /// The ray must stand at a node of the hierarchy, and its stack be the one that it came with.
    #[inline(always)]
    unsafe fn node(&self, flight: &mut Flight, stack: &mut FlightStack, keys: &mut Keys) -> Popped {
        let slab = Slab::<S, N>::of_prepared(self.simd, &flight.slab, flight.tmin);
        // SAFETY: children that are not leaves index the nodes of a sound hierarchy.
        let node = unsafe { self.bvh.nodes().get_unchecked(flight.current.0 as usize) };
        let (touched, entry) = slab.touched_children(self.simd, node, flight.best.t);
        // Unsafe code relies on these bits, so no test is trusted with them.
        let touched = touched & (u32::MAX >> (32 - N));
        let len = &mut flight.stacked;
        // SAFETY: the stack has room for N - 1 entries for each level of the tree and for what a push writes
        // beyond: each of the at most MAX_DEPTH - 1 nodes above this one left at most N - 1 behind, since
        // one of its children was popped. The ray did not come to its end, so the bottom was not popped.
        let next = unsafe {
            stack.push(
                len,
                self.simd,
                touched,
                entry,
                node.children(),
                keys,
                self.goal,
            );
            stack.pop(len, flight.best.t, self.goal)
        };
        self.go_to(flight, &next);
        next
    }

    /// Tests the triangles of the packet and goes on to the next packet, node or leaf.
    ///
    /// # Safety
    /// The ray must stand at a leaf of the hierarchy, and its stack be the one that it came with.
    #[inline(always)]
    unsafe fn packet(&self, rays: &[Ray], flight: &mut Flight, stack: &mut FlightStack) -> Popped {
        let leaf = flight.current;
        // SAFETY: what is left of the leaf takes the place of the leaf, which was popped.
        unsafe { stack.push_rest(&mut flight.stacked, leaf) };
        if leaf.packet_count() > 0 {
            let ray = &rays[flight.ray as usize];
            // SAFETY: the leaves of a sound hierarchy have packets that exist.
            let packet = unsafe { self.bvh.packets().get_unchecked(leaf.first_packet()) };
            let found = improve_evenly(
                self.simd,
                self.precision,
                &Shear::of_prepared(self.simd, &flight.shear, ray, flight.tmin),
                packet,
                ray,
                self.filter,
                self.goal,
                &mut flight.best,
            );
            flight.stacked =
                select_unpredictable(found.is_break(), FlightStack::EMPTY, flight.stacked);
        }
        // SAFETY: the ray did not come to its end, so the bottom was not popped.
        let next = unsafe { stack.pop_evenly(&mut flight.stacked, flight.best.t, self.goal) };
        self.go_to(flight, &next);
        next
    }

    #[inline(always)]
    fn go_to(&self, flight: &mut Flight, next: &Popped) {
        prefetch_child(self.bvh.nodes(), self.bvh.packets(), next.child);
        flight.current = next.child;
    }
}
