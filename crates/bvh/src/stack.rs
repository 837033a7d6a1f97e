//! The subtrees that a traversal has yet to visit.
//!
//! Measured in a prototype and rejected: a branch-free rank sort of the children; leaving more than
//! three children unsorted. Measured here and rejected: four children in
//! registers, by exchanges without branches: up to 10 % slower or within the noise. Alone, sorting
//! networks (Bose and Nelson's, Batcher's) of four to eight keys in random order take a third to two
//! thirds of the time of this insertion, but more for nearly sorted keys; beyond four they were not
//! tried in a traversal.

use std::mem::MaybeUninit;

use crate::Lanes;
use crate::bvh::{Child, MAX_DEPTH};

/// Subtrees yet to visit, nearest on top: entry distance in the high half, child in the low half.
/// Distances are not negative, so their bits sort like the numbers.
///
/// Entries below `len` are initialised.
pub(crate) struct Stack<const N: usize> {
    entries: [MaybeUninit<u64>; STACK_CAPACITY],
    len: usize,
}

const STACK_CAPACITY: usize = MAX_DEPTH * 16;

impl<const N: usize> Stack<N> {
    #[inline(always)]
    pub(crate) fn new() -> Stack<N> {
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
    pub(crate) unsafe fn descend<S: Lanes<N>>(
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

    /// Leaves all touched children but the first on the stack, in reverse, and returns the first,
    /// or an empty leaf if none is touched: the order that the builder chose for any-hit queries.
    /// Their distance is taken for zero.
    ///
    /// # Safety
    /// As for [`descend`](Stack::descend).
    #[inline(always)]
    pub(crate) unsafe fn descend_unsorted(&mut self, touched: u32, children: &[u32; N]) -> Child {
        if touched == 0 {
            return Child::VACANT;
        }
        let mut rest = touched & (touched - 1);
        while rest != 0 {
            let slot = 31 - rest.leading_zeros();
            rest &= !(1 << slot);
            // SAFETY: slots are positions of bits of `touched`, below N, and there is room for N
            // entries, by this function's contract.
            unsafe { self.push(u64::from(*children.get_unchecked(slot as usize))) };
        }
        // SAFETY: as above.
        Child(unsafe { *children.get_unchecked(touched.trailing_zeros() as usize) })
    }

    /// The nearest subtree that is not entered behind `tmax`.
    ///
    /// # Safety
    /// Entries below `len` must be initialised, which every method maintains.
    #[inline(always)]
    pub(crate) unsafe fn pop(&mut self, tmax: f32) -> Option<Child> {
        while self.len > 0 {
            self.len -= 1;
            // SAFETY: this was below `len` until now.
            let key = unsafe { self.entries.get_unchecked(self.len).assume_init() };
            if f32::from_bits((key >> 32) as u32) <= tmax {
                return Some(Child(key as u32));
            }
        }
        None
    }
}
