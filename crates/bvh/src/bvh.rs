//! The hierarchy in memory: wide nodes and packets of triangles, as the kernels read them.

use std::mem::{align_of, offset_of, size_of};

use crate::validate::{InvalidBvh, check_structure};
use crate::{Bounds, Boxes};

/// Levels of inner nodes on the longest path, the root's included. The builder keeps to it and
/// [`BvhView::new`] checks it, so that the traversal's stack cannot overflow.
pub(crate) const MAX_DEPTH: usize = 64;

/// Marks a triangle index as single-sided.
pub(crate) const SINGLE_SIDED: u32 = 1 << 31;

/// `N` child boxes and what they hold.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct Node<const N: usize> {
    /// `[lo.x, hi.x, lo.y, hi.y, lo.z, hi.z]`, each `[child]`; an unused slot has the empty box.
    pub bounds: [[f32; N]; 6],
    /// What each box holds: the number of a node; or, with the high bit set, a leaf of (bits 27 to 30) packets from the
    /// packet (lower 27 bits) on. A leaf of no packets is an unused slot.
    pub children: [u32; N],
}

/// `P` triangles, or fewer: unused lanes have NaN vertices, which nothing hits.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct TrianglePacket<const P: usize> {
    /// Corners, `[vertex][axis][lane]`.
    pub vertices: [[[f32; P]; 3]; 3],
    /// Triangle indices; the high bit marks a triangle as single-sided.
    pub prim_ids: [u32; P],
}

/// Bytes: whole cache lines.
macro_rules! assert_layout {
    ($type:ty, $size:literal, $last:ident at $offset:literal) => {
        const _: () = assert!(
            size_of::<$type>() == $size
                && align_of::<$type>() == 64
                && offset_of!($type, $last) == $offset
        );
    };
}
assert_layout!(Node<2>, 64, children at 48);
assert_layout!(Node<4>, 128, children at 96);
assert_layout!(Node<8>, 256, children at 192);
assert_layout!(Node<16>, 448, children at 384);
assert_layout!(TrianglePacket<1>, 64, prim_ids at 36);
assert_layout!(TrianglePacket<4>, 192, prim_ids at 144);
assert_layout!(TrianglePacket<8>, 320, prim_ids at 288);
assert_layout!(TrianglePacket<16>, 640, prim_ids at 576);

impl<const N: usize> Node<N> {
    /// A node without children.
    pub(crate) const VACANT: Node<N> = Node {
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

    pub(crate) fn set_child(&mut self, slot: usize, bounds: &Bounds, child: Child) {
        for axis in 0..3 {
            self.bounds[2 * axis][slot] = bounds.lo[axis];
            self.bounds[2 * axis + 1][slot] = bounds.hi[axis];
        }
        self.children[slot] = child.0;
    }
}

impl<const P: usize> TrianglePacket<P> {
    /// A packet without triangles. NaN fails every comparison, so that unused lanes do not defeat
    /// the kernel's early way out as degenerate zeros would.
    pub(crate) const VACANT: TrianglePacket<P> = TrianglePacket {
        vertices: [[[f32::NAN; P]; 3]; 3],
        prim_ids: [u32::MAX; P],
    };

    /// Writes the corners of one lane.
    pub(crate) fn set_corners(&mut self, lane: usize, corners: [[f32; 3]; 3]) {
        for (rows, corner) in self.vertices.iter_mut().zip(corners) {
            for (row, coordinate) in rows.iter_mut().zip(corner) {
                row[lane] = coordinate;
            }
        }
    }
}

/// A child as stored: the index of a node, or with the high bit set a leaf, `count` packets from
/// `first` on. A leaf of no packets is a vacant slot: entering it is harmless.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct Child(pub(crate) u32);

impl Child {
    const LEAF: u32 = 1 << 31;
    const FIRST_BITS: u32 = 27;
    pub(crate) const MAX_PACKETS: usize = 15;
    pub(crate) const VACANT: Child = Child(Child::LEAF);
    pub(crate) const ROOT: Child = Child(0);

    pub(crate) fn node(index: usize) -> Child {
        assert!(index < Child::LEAF as usize, "too many nodes");
        Child(index as u32)
    }

    pub(crate) fn leaf(first: usize, count: usize) -> Child {
        assert!(
            first + count <= 1 << Child::FIRST_BITS,
            "too many triangle packets"
        );
        assert!(count <= Child::MAX_PACKETS);
        Child(Child::LEAF | (count as u32) << Child::FIRST_BITS | first as u32)
    }

    #[inline(always)]
    pub(crate) fn is_leaf(self) -> bool {
        self.0 & Child::LEAF != 0
    }

    #[inline(always)]
    pub(crate) fn first_packet(self) -> usize {
        (self.0 & ((1 << Child::FIRST_BITS) - 1)) as usize
    }

    #[inline(always)]
    pub(crate) fn packet_count(self) -> usize {
        (self.0 >> Child::FIRST_BITS & 15) as usize
    }
}

/// A bounding volume hierarchy over triangles: `N` children a node (2, 4, 8 or 16), `P` triangles a
/// packet (1, 4, 8 or 16).
#[derive(Clone, Debug)]
pub struct Bvh<const N: usize, const P: usize = N> {
    pub(crate) nodes: Vec<Node<N>>,
    pub(crate) packets: Vec<TrianglePacket<P>>,
    pub(crate) sah_cost: f32,
}

impl<const N: usize, const P: usize> Bvh<N, P> {
    /// What the kernels take.
    #[inline(always)]
    pub fn view(&self) -> BvhView<'_, N, P> {
        BvhView {
            nodes: &self.nodes,
            packets: &self.packets,
        }
    }

    /// The nodes, the root first, parents before their children.
    pub fn nodes(&self) -> &[Node<N>] {
        &self.nodes
    }

    /// The triangles, leaf by leaf.
    pub fn packets(&self) -> &[TrianglePacket<P>] {
        &self.packets
    }

    /// The box around everything; empty if there are no triangles.
    pub fn bounds(&self) -> Bounds {
        let root = &self.nodes[0];
        (0..N).fold(Bounds::EMPTY, |bounds, slot| {
            bounds.union(&root.child_bounds(slot))
        })
    }

    /// Expected cost of a random ray that enters the root, by the surface area heuristic, in units
    /// of one node's test.
    pub fn sah_cost(&self) -> f32 {
        self.sah_cost
    }

    /// Size of nodes and packets.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.nodes()) + size_of_val(self.packets())
    }
}

/// A hierarchy whose structure is known to be sound, wherever its bytes came from.
#[derive(Clone, Copy, Debug)]
pub struct BvhView<'a, const N: usize, const P: usize = N, B = Node<N>> {
    nodes: &'a [B],
    packets: &'a [TrianglePacket<P>],
}

impl<'a, const N: usize, const P: usize, B: Boxes<N>> BvhView<'a, N, P, B> {
    /// Checks everything that the kernels' memory safety and termination rest on: a root, children
    /// and packets in range, a tree with parents before children, a depth within the stack's bound;
    /// and also that every node's boxes lie inside the box that its parent holds for it.
    pub fn new(
        nodes: &'a [B],
        packets: &'a [TrianglePacket<P>],
    ) -> Result<BvhView<'a, N, P, B>, InvalidBvh> {
        check_structure(nodes, packets)?;
        Ok(BvhView { nodes, packets })
    }

    /// As [`BvhView::new`], without looking.
    ///
    /// # Safety
    /// [`BvhView::new`] must succeed on these slices, as it does on the nodes and packets of a
    /// [`Bvh`] or a [`crate::QuantizedBvh`].
    #[inline(always)]
    pub unsafe fn new_unchecked(
        nodes: &'a [B],
        packets: &'a [TrianglePacket<P>],
    ) -> BvhView<'a, N, P, B> {
        BvhView { nodes, packets }
    }

    /// The nodes, the root first.
    #[inline(always)]
    pub fn nodes(&self) -> &'a [B] {
        self.nodes
    }

    /// The triangles, leaf by leaf.
    #[inline(always)]
    pub fn packets(&self) -> &'a [TrianglePacket<P>] {
        self.packets
    }
}
