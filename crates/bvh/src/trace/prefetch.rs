//! Fetching what a child holds before the walk gets there.
//!
//! Where the walk goes on takes branches to find out, which are often mispredicted: what is not in
//! the caches had better be under way before. Most of what a ray waits for are the packets.

use crate::layout::boxes::Boxes;
use crate::layout::child::Child;

/// Bytes of a line of the caches.
const LINE: usize = 64;

/// Asks the caches for a child of one of the `nodes`: a node, or the first of a leaf's `items`.
#[inline(always)]
pub(crate) fn prefetch_child<const N: usize, B: Boxes<N>, T>(
    nodes: &[B],
    items: &[T],
    child: Child,
) {
    // One address or the other, and as many lines as the longer needs: no branch.
    let node = nodes.as_ptr().wrapping_add(child.0 as usize).cast::<u8>();
    let item = items.as_ptr().wrapping_add(child.first_packet()).cast();
    let start = if child.is_leaf() { item } else { node };
    for line in 0..size_of::<B>().max(size_of::<T>()).div_ceil(LINE) {
        prefetch_line(start.wrapping_add(LINE * line));
    }
}

/// Asks the caches for the line in which an item begins, for whoever knows long before what it is
/// going to read. Whether there is such an item does not matter.
#[inline(always)]
pub fn prefetch<T>(items: &[T], index: usize) {
    prefetch_line(items.as_ptr().wrapping_add(index).cast());
}

#[inline(always)]
#[cfg(all(target_arch = "x86_64", not(miri)))]
fn prefetch_line(line: *const u8) {
    use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
    // SAFETY: every x86-64 has the instruction, and it does nothing at addresses that cannot be read.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(line.cast()) };
}

/// Elsewhere stable Rust has no name for it.
#[inline(always)]
#[cfg(not(all(target_arch = "x86_64", not(miri))))]
fn prefetch_line(_line: *const u8) {}
