//! The traversal kernel: one ray through a wide hierarchy, nearest child first.
//!
//! Both queries are instances of [`traverse`]. Its order is only a matter of speed: among hits at
//! equal distance the smallest triangle index wins, so a subtree is skipped only if its box is
//! entered strictly behind the best hit.
//!
//! Measured in a prototype and rejected: an early way out between the edge tests; a branch-free
//! rank sort of the children; leaving more than three children unsorted.

use std::mem::MaybeUninit;

use crate::bvh::{Child, MAX_DEPTH, TrianglePacket};
use crate::slab::SlabRay;
use crate::triangle::ShearRay;
use crate::{BvhView, Culling, Hit, HitFilter, Lanes, Ray};

/// The nearest hit in the ray's interval that `filter` accepts; of several at the same distance,
/// the one with the smallest triangle index.
#[inline(always)]
pub fn closest_hit<S: Lanes<N>, const N: usize, F: HitFilter>(
    simd: S,
    bvh: BvhView<'_, N>,
    ray: &Ray,
    filter: &F,
) -> Hit {
    traverse::<S, N, F, false>(simd, bvh, ray, filter)
}

/// Whether there is a hit in the ray's interval that `filter` accepts: exactly when
/// [`closest_hit`] finds one.
#[inline(always)]
pub fn any_hit<S: Lanes<N>, const N: usize, F: HitFilter>(
    simd: S,
    bvh: BvhView<'_, N>,
    ray: &Ray,
    filter: &F,
) -> bool {
    traverse::<S, N, F, true>(simd, bvh, ray, filter).is_hit()
}

#[inline(always)]
fn traverse<S: Lanes<N>, const N: usize, F: HitFilter, const ANY: bool>(
    simd: S,
    bvh: BvhView<'_, N>,
    ray: &Ray,
    filter: &F,
) -> Hit {
    if !ray.is_valid() {
        return Hit::miss(ray.tmax);
    }
    let (tmin, tmax) = ray.interval();
    let slab = SlabRay::<S, N>::new(simd, ray, tmin);
    let shear = ShearRay::<S, N>::new(simd, ray, tmin);
    let mut best = Hit::miss(tmax);
    let mut stack = Stack::<N>::new();
    let mut current = Child(0);
    loop {
        while !current.is_leaf() {
            // SAFETY: the view is structurally valid: the root exists, and children that are not
            // leaves index its nodes.
            let node = unsafe { bvh.nodes().get_unchecked(current.0 as usize) };
            let (entry, exit) = slab.node_interval(simd, node, simd.splat(best.t));
            let touched = simd.bits(simd.le(entry, exit));
            // SAFETY: `touched` has bits in 0..N only. The stack has room for N - 1 entries for
            // each level of the tree, and each of the at most MAX_DEPTH nodes on the path to this
            // one left at most N - 1 behind, since one of its children was descended into.
            current = unsafe { stack.descend::<S, ANY>(simd, touched, entry, &node.children) };
        }
        for index in current.first_packet()..current.first_packet() + current.packet_count() {
            // SAFETY: the view is structurally valid: every leaf's packets exist.
            let packet = unsafe { bvh.packets().get_unchecked(index) };
            let found =
                visit_packet::<S, N, F, ANY>(simd, packet, &slab, &shear, ray, filter, &mut best);
            if ANY && found {
                return best;
            }
        }
        // SAFETY: entries above the bottom have been written, see `Stack`.
        match unsafe { stack.pop::<ANY>(best.t) } {
            Some(child) => current = child,
            None => break,
        }
    }
    if best.is_hit() {
        best
    } else {
        Hit::miss(ray.tmax)
    }
}

/// Improves `best` by the packet's triangles. Returns whether it did.
#[inline(always)]
fn visit_packet<S: Lanes<N>, const N: usize, F: HitFilter, const ANY: bool>(
    simd: S,
    packet: &TrianglePacket<N>,
    slab: &SlabRay<S, N>,
    shear: &ShearRay<S, N>,
    ray: &Ray,
    filter: &F,
    best: &mut Hit,
) -> bool {
    let Some(hits) = shear.packet_hits(simd, packet, slab, simd.splat(best.t), F::CULLING) else {
        return false;
    };
    let (t, u, v) = hits.store(simd);
    let mut found = false;
    let mut lanes = hits.lanes;
    while lanes != 0 {
        // The mask keeps a lane in range for the compiler; hits have bits in 0..N only.
        let lane = lanes.trailing_zeros() as usize % N;
        lanes &= lanes - 1;
        let marked = packet.prim_ids[lane];
        let prim = match F::CULLING {
            Culling::PerTriangle if hits.back >> lane & marked >> 31 == 1 => continue,
            _ => marked & !TrianglePacket::<N>::SINGLE_SIDED,
        };
        let hit = Hit {
            t: t[lane],
            u: u[lane],
            v: v[lane],
            prim,
        };
        let improves = hit.t < best.t || (hit.t == best.t && hit.prim < best.prim);
        if improves && (!F::REJECTS || filter.accept(ray, &hit)) {
            *best = hit;
            found = true;
            if ANY {
                break;
            }
        }
    }
    found
}

/// Subtrees yet to visit, nearest on top: entry distance in the high half, child in the low half.
/// Distances are not negative, so their bits sort like the numbers.
///
/// Entries below `len` are initialised.
struct Stack<const N: usize> {
    entries: [MaybeUninit<u64>; STACK_CAPACITY],
    len: usize,
}

const STACK_CAPACITY: usize = MAX_DEPTH * 16;

impl<const N: usize> Stack<N> {
    #[inline(always)]
    fn new() -> Stack<N> {
        // Each level leaves N - 1 siblings behind; sorting holds one more for a moment.
        const { assert!(STACK_CAPACITY > MAX_DEPTH * (N - 1)) };
        Stack {
            entries: [const { MaybeUninit::uninit() }; STACK_CAPACITY],
            len: 0,
        }
    }

    /// # Safety
    /// `len` must be less than the capacity.
    #[inline(always)]
    unsafe fn push(&mut self, key: u64) {
        // SAFETY: `len` is in range by this function's contract.
        unsafe { self.entries.get_unchecked_mut(self.len) }.write(key);
        self.len += 1;
    }

    /// # Safety
    /// `index` must be less than `len`.
    #[inline(always)]
    unsafe fn get(&self, index: usize) -> u64 {
        // SAFETY: entries below `len` are in range and initialised.
        unsafe { self.entries.get_unchecked(index).assume_init() }
    }

    /// Leaves all touched children but the nearest on the stack, in descending order, and returns
    /// the nearest, or an empty leaf if none is touched.
    ///
    /// Up to three children, the usual case, are sorted in registers; more by insertion.
    ///
    /// # Safety
    /// `touched` must not have bits beyond `N`, and there must be room for `N` entries.
    #[inline(always)]
    unsafe fn descend<S: Lanes<N>, const ANY: bool>(
        &mut self,
        simd: S,
        mut touched: u32,
        entry: S::Float,
        children: &[u32; N],
    ) -> Child {
        if touched == 0 {
            return Child::VACANT;
        }
        let mut take = || {
            let slot = touched.trailing_zeros() as usize;
            touched &= touched - 1;
            (slot, touched == 0)
        };
        let child = |slot: usize| {
            // SAFETY: slots are positions of bits of `touched`, below N by this function's contract.
            unsafe { *children.get_unchecked(slot) }
        };

        let (slot, last) = take();
        if last {
            return Child(child(slot));
        }
        let mut distances = [0.0f32; N];
        simd.store(entry, &mut distances);
        let key = |slot: usize| {
            // SAFETY: slots are below N.
            let distance = unsafe { *distances.get_unchecked(slot) };
            (distance.to_bits() as u64) << 32 | child(slot) as u64
        };
        let first = key(slot);
        let (slot, last) = take();
        let second = key(slot);
        let (near, far) = (first.min(second), first.max(second));
        if last {
            // SAFETY: room for N entries.
            unsafe { self.push(far) };
            return Child(near as u32);
        }
        let (slot, mut last) = take();
        let third = key(slot);
        let (middle, far) = (far.min(third), far.max(third));
        let (near, middle) = (near.min(middle), near.max(middle));
        let base = self.len;
        // SAFETY: room for N entries, of which at most one for each touched child is written. The
        // insertion's indices lie in base..len.
        unsafe {
            self.push(far);
            self.push(middle);
            if last {
                return Child(near as u32);
            }
            self.push(near);
            while !last {
                let slot;
                (slot, last) = take();
                let key = key(slot);
                let mut place = self.len;
                self.push(key);
                while place > base && self.get(place - 1) < key {
                    let moved = self.get(place - 1);
                    self.entries.get_unchecked_mut(place).write(moved);
                    place -= 1;
                }
                self.entries.get_unchecked_mut(place).write(key);
            }
            self.len -= 1;
            Child(self.get(self.len) as u32)
        }
    }

    /// The nearest subtree that is not entered behind `tmax`.
    ///
    /// # Safety
    /// Entries below `len` must be initialised, which every method maintains.
    #[inline(always)]
    unsafe fn pop<const ANY: bool>(&mut self, tmax: f32) -> Option<Child> {
        while self.len > 0 {
            self.len -= 1;
            // SAFETY: this was below `len` until now.
            let key = unsafe { self.entries.get_unchecked(self.len).assume_init() };
            if ANY || f32::from_bits((key >> 32) as u32) <= tmax {
                return Some(Child(key as u32));
            }
        }
        None
    }
}
