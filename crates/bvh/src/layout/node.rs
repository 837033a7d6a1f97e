//! A wide node as it is: `N` boxes in columns.

use std::mem::{align_of, offset_of, size_of};

use crate::bounds::Bounds;
use crate::layout::boxes::Boxes;
use crate::layout::boxes::sealed::Sealed;
use crate::layout::child::Child;
use crate::simd::Width;

/// `N` child boxes and what they hold.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct WideNode<const N: usize> {
    /// `[lo.x, hi.x, lo.y, hi.y, lo.z, hi.z]`, each `[child]`; an unused slot has the empty box.
    pub bounds: [[f32; N]; 6],
    /// What each box holds: the index of a node; or, with the high bit set, a leaf: bits 27 to 30 are the
    /// count of its packets, the lower 27 bits the index of the first. A leaf of no packets is an unused slot.
    pub children: [u32; N],
}

/// Bytes: whole cache lines.
macro_rules! assert_layout {
    ($n:literal: $size:literal, children at $offset:literal) => {
        const _: () = assert!(
            size_of::<WideNode<$n>>() == $size
                && align_of::<WideNode<$n>>() == 64
                && offset_of!(WideNode<$n>, children) == $offset
        );
    };
}
assert_layout!(2: 64, children at 48);
assert_layout!(4: 128, children at 96);
assert_layout!(8: 256, children at 192);
assert_layout!(16: 448, children at 384);
impl<const N: usize> WideNode<N> {
    /// A node without children.
    pub(crate) const VACANT: WideNode<N> = WideNode {
        bounds: [
            [f32::INFINITY; N],
            [f32::NEG_INFINITY; N],
            [f32::INFINITY; N],
            [f32::NEG_INFINITY; N],
            [f32::INFINITY; N],
            [f32::NEG_INFINITY; N],
        ],
        children: [Child::VACANT.0; N],
    };

    /// The box of one slot.
    pub fn child_bounds(&self, slot: usize) -> Bounds {
        Bounds {
            lo: [0, 2, 4].map(|row| self.bounds[row][slot]),
            hi: [1, 3, 5].map(|row| self.bounds[row][slot]),
        }
    }

    /// The box around all of them.
    pub(crate) fn bounds(&self) -> Bounds {
        (0..N).fold(Bounds::EMPTY, |bounds, slot| {
            bounds.union(&self.child_bounds(slot))
        })
    }

    pub(crate) fn set_child(&mut self, slot: usize, bounds: &Bounds, child: Child) {
        for axis in 0..3 {
            self.bounds[2 * axis][slot] = bounds.lo[axis];
            self.bounds[2 * axis + 1][slot] = bounds.hi[axis];
        }
        self.children[slot] = child.0;
    }
}

impl<const N: usize> Sealed for WideNode<N> {}

// SAFETY: the children are a field.
unsafe impl<const N: usize> Boxes<N> for WideNode<N> {
    #[inline(always)]
    fn children(&self) -> &[u32; N] {
        &self.children
    }

    #[inline(always)]
    fn used(&self) -> u32 {
        u32::MAX
    }

    #[inline(always)]
    unsafe fn plane<S: Width<N>>(&self, simd: S, _axis: usize, row: usize) -> S::Float {
        // SAFETY: there are six rows, by this function's contract.
        simd.load(unsafe { self.bounds.get_unchecked(row) })
    }

    #[inline(always)]
    fn plane_of(&self, slot: usize, _axis: usize, row: usize) -> f32 {
        self.bounds[row % 6][slot % N]
    }

    fn child_bounds(&self, slot: usize) -> Bounds {
        WideNode::child_bounds(self, slot)
    }
}
