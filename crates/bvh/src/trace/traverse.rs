//! The walk through a hierarchy, nearest child first. Every kernel is an instance of it.
//!
//! Its order is only a matter of speed: among hits at equal distance the smallest triangle index
//! wins, so a subtree is skipped only if its box is entered strictly behind the best hit.

use std::ops::ControlFlow;

use crate::layout::boxes::Boxes;
use crate::layout::child::Child;
use crate::simd::Width;
use crate::trace::goal::Goal;
use crate::trace::prefetch::prefetch_child;
use crate::trace::slab::Slab;
use crate::trace::stack::Stack;

/// So many of a node's touched children are prefetched. More would be too many: those behind a hit
/// are never visited.
const PREFETCHED: usize = 2;

/// What happens at leaves.
pub(crate) trait Visitor {
    /// What the walk is for.
    type Goal: Goal;
    /// What leaves hold.
    type Item;

    /// All of it.
    fn items(&self) -> &[Self::Item];
    /// The farthest distance of interest, which may shrink.
    fn tmax(&self) -> f32;
    /// A node's boxes are about to be tested.
    #[inline(always)]
    fn node(&mut self) {}
    /// Breaks if nothing else needs to be visited.
    fn leaf(&mut self, leaf: Child) -> ControlFlow<()>;
}

/// How rays are tested against the boxes of a node.
pub(crate) trait BoxTest<S: Width<N>, const N: usize> {
    /// The children whose boxes are touched before `tmax`, as bits, and where they are entered.
    fn touched_children(&self, simd: S, node: &impl Boxes<N>, tmax: f32) -> (u32, S::Float);
}

/// All at once.
impl<S: Width<N>, const N: usize> BoxTest<S, N> for Slab<S, N> {
    #[inline(always)]
    fn touched_children(&self, simd: S, node: &impl Boxes<N>, tmax: f32) -> (u32, S::Float) {
        Slab::touched_children(self, simd, node, tmax)
    }
}

/// Visits the leaves below `start` whose boxes `test` touches.
///
/// # Safety
/// The nodes must be sound, as [`crate::BvhView::new`] checks, and `start` one of their children
/// or the root.
#[inline(always)]
pub(crate) unsafe fn traverse<S: Width<N>, const N: usize, B: Boxes<N>, V: Visitor>(
    simd: S,
    nodes: &[B],
    start: Child,
    test: &impl BoxTest<S, N>,
    visitor: &mut V,
) {
    let mut stack = Stack::<N>::new();
    let mut current = start;
    loop {
        while !current.is_leaf() {
            // SAFETY: children that are not leaves index the nodes, by this function's contract.
            let node = unsafe { nodes.get_unchecked(current.0 as usize) };
            visitor.node();
            let (touched, entry) = test.touched_children(simd, node, visitor.tmax());
            // Unsafe code relies on these bits, so no test is trusted with them.
            let touched = touched & (u32::MAX >> (32 - N));
            let mut rest = touched;
            for _ in 0..PREFETCHED {
                if rest == 0 {
                    break;
                }
                // The remainder keeps a slot in range for the compiler.
                let slot = rest.trailing_zeros() as usize % N;
                rest &= rest - 1;
                prefetch_child(nodes, visitor.items(), Child(node.children()[slot]));
            }
            // SAFETY: `touched` has bits in 0..N only. The stack has room for N - 1 entries for
            // each level of the tree, and each of the at most MAX_DEPTH nodes on the path to this
            // one left at most N - 1 behind, since one of its children was descended into.
            current = unsafe {
                if V::Goal::ANY {
                    stack.descend_unsorted(touched, node.children())
                } else {
                    stack.descend(simd, touched, entry, node.children())
                }
            };
        }
        if visitor.leaf(current).is_break() {
            return;
        }
        // SAFETY: entries above the bottom have been written, see `Stack`.
        match unsafe {
            stack.pop(if V::Goal::ANY {
                f32::INFINITY
            } else {
                visitor.tmax()
            })
        } {
            Some(child) => current = child,
            None => return,
        }
    }
}
