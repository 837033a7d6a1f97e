//! The subtrees that a traversal has yet to visit.
//!
//! Touched children are sorted by networks, up to eight in registers; more, which are rare, by
//! insertion, since with networks for up to sixteen a kernel is six times as long and no faster.
//! Networks from two children on, in place of insertion from four on, change nothing beyond the
//! noise of 2 % (geometric means over four scenes, one ray at a time: 0.99 to 1.01 of the time at
//! `N` of 8 and 16), but for diffuse rays in Sponza at 16, which take 0.96. Nor does a network for
//! only four, five, six, seven or eight children.
//!
//! Measured in a prototype and rejected: a branch-free rank sort of the children; leaving more than
//! three children unsorted.

use std::mem::MaybeUninit;

use crate::layout::child::Child;
use crate::layout::validate::MAX_DEPTH;
use crate::simd::{Stored, Width};
use crate::trace::sorting_network::{MOST_KEYS, sort};

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
    /// # Safety
    /// `touched` must not have bits beyond `N`, and there must be room for `N` entries.
    #[inline(always)]
    pub(crate) unsafe fn descend<S: Width<N>>(
        &mut self,
        simd: S,
        touched: u32,
        entry: S::Float,
        children: &[u32; N],
    ) -> Child {
        if touched == 0 {
            return Child::VACANT;
        }
        if touched & (touched - 1) == 0 {
            // SAFETY: slots are indices of bits of `touched`, below N by this function's contract.
            return Child(unsafe { *children.get_unchecked(touched.trailing_zeros() as usize) });
        }
        let Stored(distances) = &Stored::of(simd, entry);
        let mut rest = touched;
        let next_key = || {
            let slot = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            // SAFETY: as above, since no more keys are taken than `touched` has bits.
            let (distance, child) =
                unsafe { (distances.get_unchecked(slot), children.get_unchecked(slot)) };
            u64::from(distance.to_bits()) << 32 | u64::from(*child)
        };
        let count = touched.count_ones() as usize;
        // SAFETY: `touched` has `count` bits, at most N, for which there is room.
        unsafe {
            match count {
                2 => self.push_sorted::<2>(next_key),
                3 if N >= 3 => self.push_sorted::<3>(next_key),
                4 if N >= 4 => self.push_sorted::<4>(next_key),
                5 if N >= 5 => self.push_sorted::<5>(next_key),
                6 if N >= 6 => self.push_sorted::<6>(next_key),
                7 if N >= 7 => self.push_sorted::<7>(next_key),
                MOST_KEYS if N >= MOST_KEYS => self.push_sorted::<MOST_KEYS>(next_key),
                _ => self.insert(count, next_key),
            }
        }
    }

    /// Leaves all but the least of `KEYS` keys on the stack, in descending order, and returns the
    /// child of the least.
    ///
    /// # Safety
    /// There must be room for the keys.
    #[inline(always)]
    unsafe fn push_sorted<const KEYS: usize>(
        &mut self,
        mut next_key: impl FnMut() -> u64,
    ) -> Child {
        let mut keys: [u64; KEYS] = std::array::from_fn(|_| next_key());
        sort(&mut keys);
        for &key in &keys[..KEYS - 1] {
            // SAFETY: there is room, by this function's contract.
            unsafe { self.push(key) };
        }
        Child(keys[KEYS - 1] as u32)
    }

    /// As [`push_sorted`](Stack::push_sorted), for any number of keys but zero.
    ///
    /// # Safety
    /// There must be room for the keys.
    #[inline(always)]
    unsafe fn insert(&mut self, count: usize, mut next_key: impl FnMut() -> u64) -> Child {
        let base = self.len;
        // SAFETY: room for the keys; the indices lie in base..len.
        unsafe {
            for _ in 0..count {
                let key = next_key();
                let mut index = self.len;
                self.push(key);
                while index > base && self.get(index - 1) < key {
                    let moved = self.get(index - 1);
                    self.entries.get_unchecked_mut(index).write(moved);
                    index -= 1;
                }
                self.entries.get_unchecked_mut(index).write(key);
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
            // SAFETY: slots are indices of bits of `touched`, below N, and there is room for N
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
