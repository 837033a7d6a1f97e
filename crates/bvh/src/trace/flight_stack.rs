//! The subtrees that a ray in flight has yet to visit.
//!
//! Differs from [`Stack`](crate::trace::stack::Stack) in what it branches on. All touched children are
//! pushed, then one is popped; as long as they are a few, how many makes no difference. And the bottom is
//! made of entries that every ray finds in the end.

use std::mem::MaybeUninit;

use crate::layout::child::Child;
use crate::layout::validate::MAX_DEPTH;
use crate::simd::{Stored, Width};
use crate::trace::goal::Goal;
use crate::trace::sorting_network::{MOST_KEYS, sort};

/// Entries of the bottom: as many as are looked at together.
const BOTTOM: usize = 4;
/// So many touched children are pushed without a branch.
const FEW: usize = 4;
/// Three lines of the caches more than a power of two, so that the stacks of several rays do not compete
/// for the same sets of a cache.
const CAPACITY: usize = MAX_DEPTH * 16 + 24;

/// Entry distance in the high half, child in the low half: as distances are not negative, their bits sort
/// like the numbers.
///
/// Its length is kept by whoever owns it, as the last call left it. Entries below are initialised, and the
/// lowest are the bottom's.
pub(crate) struct FlightStack([MaybeUninit<u64>; CAPACITY]);

/// What a stack gives.
pub(crate) struct Popped {
    pub(crate) child: Child,
    /// Nothing was left; the child is vacant.
    pub(crate) is_bottom: bool,
}

impl Popped {
    #[inline(always)]
    fn new(key: u64, len: u32) -> Popped {
        Popped {
            child: Child(key as u32),
            is_bottom: len < FlightStack::EMPTY,
        }
    }
}

impl FlightStack {
    pub(crate) const UNINIT: FlightStack = FlightStack([const { MaybeUninit::uninit() }; CAPACITY]);
    /// The length without any child.
    pub(crate) const EMPTY: u32 = BOTTOM as u32;

    /// Makes the length [`EMPTY`](FlightStack::EMPTY) true.
    #[inline(always)]
    pub(crate) fn clear(&mut self) {
        // Behind nothing, see `is_behind`.
        const ENTRY: u64 = key(-0.0, Child::VACANT.0);
        for entry in &mut self.0[..BOTTOM] {
            entry.write(ENTRY);
        }
    }

    /// Pushes all touched children, the nearest last; where any hit will do, the first in the builder's
    /// order last.
    ///
    /// # Safety
    /// There must be room for `N` entries, and for [`FEW`]; `touched` must not have bits beyond `N`.
    #[inline(always)]
    pub(crate) unsafe fn push<S: Width<N>, const N: usize, G: Goal>(
        &mut self,
        len: &mut u32,
        simd: S,
        touched: u32,
        entry: S::Float,
        children: &[u32; N],
        keys: &mut Keys,
        _: G,
    ) {
        const {
            // Each level leaves N - 1 siblings behind, the last N for a moment.
            assert!(BOTTOM + MAX_DEPTH * (N - 1) < CAPACITY);
            assert!(BOTTOM + (MAX_DEPTH - 1) * (N - 1) + FEW <= CAPACITY);
            assert!(N + MOST_KEYS <= KEYS && KEYS == u32::BITS as usize);
        }
        let count = touched.count_ones() as usize;
        // SAFETY: the length is at most the capacity.
        let top = unsafe { self.0.as_mut_ptr().add(*len as usize) };
        *len += count as u32;
        if G::ANY {
            let mut rest = touched;
            let last = || {
                // Where none is left, some child, which will be overwritten.
                let slot = 31 - (rest | 1).leading_zeros();
                rest &= !(1 << slot);
                u64::from(children[slot as usize % N])
            };
            // SAFETY: there is room by this function's contract.
            unsafe { write(top, count.max(FEW), last) };
            return;
        }
        let Stored(distances) = &Stored::of(simd, entry);
        for (slot, key_of_slot) in keys.0[..N].iter_mut().enumerate() {
            *key_of_slot = key(distances[slot], children[slot]);
        }
        // Where none is left, slots beyond the node's.
        let mut rest = touched | ((1 << MOST_KEYS) - 1) << N;
        let next = || {
            let slot = rest.trailing_zeros() as usize % KEYS;
            rest &= rest - 1;
            keys.0[slot]
        };
        // SAFETY: there is room by this function's contract. What is sorted has been written.
        unsafe {
            if count <= FEW {
                write_sorted::<FEW>(top, next);
            } else if count <= MOST_KEYS {
                write_sorted::<MOST_KEYS>(top, next);
            } else {
                write(top, count, next);
                let written = std::slice::from_raw_parts_mut(top.cast::<u64>(), count);
                written.sort_unstable_by(|a, b| b.cmp(a));
            }
        }
    }

    /// Pushes what is left of a leaf without its first packet, if anything is.
    ///
    /// # Safety
    /// There must be room for an entry.
    #[inline(always)]
    pub(crate) unsafe fn push_rest(&mut self, len: &mut u32, leaf: Child) {
        // SAFETY: there is room by this function's contract.
        let top = unsafe { self.0.get_unchecked_mut(*len as usize) };
        top.write(u64::from(leaf.without_first_packet().0));
        *len += u32::from(leaf.packet_count() > 1);
    }

    /// Takes the top entry of those that are not entered behind `tmax`; where any hit will do, of all.
    ///
    /// # Safety
    /// The stack must not have given its bottom.
    #[inline(always)]
    pub(crate) unsafe fn pop<G: Goal>(&self, len: &mut u32, tmax: f32, _: G) -> Popped {
        loop {
            // SAFETY: the bottom was not given yet. It is behind nothing, so that the loop ends there if not
            // before.
            let key = unsafe { self.take(len) };
            if G::ANY || !is_behind(key, tmax) {
                return Popped::new(key, *len);
            }
        }
    }

    /// Takes the top entry.
    ///
    /// # Safety
    /// There must be one.
    #[inline(always)]
    unsafe fn take(&self, len: &mut u32) -> u64 {
        *len -= 1;
        // SAFETY: entries below the length are initialised.
        unsafe { self.0.get_unchecked(*len as usize).assume_init() }
    }

    /// As [`pop`](FlightStack::pop), without a branch on how many of the top entries are behind, as long as it
    /// is a few: a new hit has some behind it.
    ///
    /// # Safety
    /// As for [`pop`](FlightStack::pop).
    #[inline(always)]
    pub(crate) unsafe fn pop_evenly<G: Goal>(&self, len: &mut u32, tmax: f32, _: G) -> Popped {
        if !G::ANY {
            loop {
                let first = *len as usize - BOTTOM;
                let mut near = 0;
                // One by one: a vector would have to wait for entries that are on their way to the cache.
                for index in 0..BOTTOM {
                    // SAFETY: entries below the length are initialised, and there are as many, since the
                    // bottom was not given yet.
                    let key = unsafe { self.0.get_unchecked(first + index).assume_init() };
                    near |= u32::from(!is_behind(key, tmax)) << index;
                }
                if near != 0 {
                    *len = first as u32 + (u32::BITS - near.leading_zeros());
                    break;
                }
                // None of the bottom's is among them, since it is behind nothing.
                *len = first as u32;
            }
        }
        // SAFETY: there is one, if only the bottom's.
        let key = unsafe { self.take(len) };
        Popped::new(key, *len)
    }
}

/// Whether the entry is behind `tmax`, by their bits as integers: they sort like the numbers where these are not
/// negative, and of all bits the bottom's are the least.
#[inline(always)]
fn is_behind(key: u64, tmax: f32) -> bool {
    // Adding zero makes one zero of both: a ray that starts on a triangle hits it at either.
    (key >> 32) as i32 > (tmax + 0.0).to_bits() as i32
}

/// Room for the keys of a node's slots. The others are less than all of them, for no child is the root.
#[repr(align(64))]
pub(crate) struct Keys([u64; KEYS]);

/// As many as bits in a mask of slots.
const KEYS: usize = 32;

impl Keys {
    pub(crate) const NONE: Keys = Keys([0; KEYS]);
}

#[inline(always)]
const fn key(distance: f32, child: u32) -> u64 {
    (distance.to_bits() as u64) << 32 | child as u64
}

/// # Safety
/// There must be room for so many keys.
#[inline(always)]
unsafe fn write(top: *mut MaybeUninit<u64>, count: usize, mut next: impl FnMut() -> u64) {
    for index in 0..count {
        // SAFETY: there is room by this function's contract.
        unsafe { (*top.add(index)).write(next()) };
    }
}

/// Writes so many keys in descending order.
///
/// # Safety
/// There must be room for them.
#[inline(always)]
unsafe fn write_sorted<const COUNT: usize>(
    top: *mut MaybeUninit<u64>,
    mut next: impl FnMut() -> u64,
) {
    let mut keys: [u64; COUNT] = std::array::from_fn(|_| next());
    sort(&mut keys);
    // SAFETY: there is room by this function's contract; bytes that may be uninitialised are as long.
    unsafe { top.cast::<[u64; COUNT]>().write(keys) };
}
