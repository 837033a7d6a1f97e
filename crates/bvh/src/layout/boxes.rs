//! What the kernels read of a node: `N` boxes and what they hold, stored as they are
//! ([`crate::WideNode`]) or in fewer bits ([`crate::QuantizedNode`]).

use std::fmt::Debug;

use crate::bounds::Bounds;
use crate::simd::Width;

/// A layout of nodes that the kernels can traverse: [`WideNode`](crate::WideNode) and
/// [`QuantizedNode`](crate::QuantizedNode), and nothing else.
///
/// Planes have the indices of the rows of a [`WideNode`](crate::WideNode)'s bounds: `2 * axis`, and one
/// more for the upper.
///
/// # Safety
/// [`children`](Boxes::children) must give the same array each time: what [`BvhView::new`] has found
/// sound is traversed without further checks.
///
/// [`BvhView::new`]: crate::BvhView::new
pub unsafe trait Boxes<const N: usize>: sealed::Sealed + Copy + Debug + Send + Sync {
    /// What each box holds, as in [`WideNode::children`](crate::WideNode::children).
    fn children(&self) -> &[u32; N];

    /// The slots that hold anything, as bits; more may be set where the box alone keeps rays out.
    fn used(&self) -> u32;

    /// One plane of each box; NaN where the box does not end.
    ///
    /// # Safety
    /// `row` must be one of the two of this axis.
    unsafe fn plane<S: Width<N>>(&self, simd: S, axis: usize, row: usize) -> S::Float;

    /// The same plane of one box. `row` is of this axis.
    fn plane_of(&self, slot: usize, axis: usize, row: usize) -> f32;

    /// One box; empty in an unused slot.
    fn child_bounds(&self, slot: usize) -> Bounds;
}

pub(crate) mod sealed {
    /// Keeps other layouts out.
    pub trait Sealed {}
}
