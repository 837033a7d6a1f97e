//! The hierarchy in memory: wide nodes and packets of triangles, as the kernels read them.

use std::mem::{align_of, offset_of, size_of};

use crate::Bounds;
use crate::validate::{InvalidBvh, check_structure};

/// Levels of inner nodes on the longest path, the root's included. The builder keeps to it and
/// [`BvhView::new`] checks it, so that the traversal's stack cannot overflow.
pub(crate) const MAX_DEPTH: usize = 64;

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

/// `N` triangles, or fewer: unused lanes have NaN vertices, which nothing hits.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct TrianglePacket<const N: usize> {
    /// First vertices, `[axis][lane]`.
    pub v0: [[f32; N]; 3],
    /// Second vertices, `[axis][lane]`.
    pub v1: [[f32; N]; 3],
    /// Third vertices, `[axis][lane]`.
    pub v2: [[f32; N]; 3],
    /// Triangle indices; the high bit marks a triangle as single-sided.
    pub prim_ids: [u32; N],
}

macro_rules! assert_layout {
    ($n:literal, $node_size:literal, $packet_size:literal) => {
        const _: () = assert!(
            size_of::<Node<$n>>() == $node_size
                && align_of::<Node<$n>>() == 64
                && offset_of!(Node<$n>, children) == 24 * $n
        );
        const _: () = assert!(
            size_of::<TrianglePacket<$n>>() == $packet_size
                && align_of::<TrianglePacket<$n>>() == 64
                && offset_of!(TrianglePacket<$n>, v1) == 12 * $n
                && offset_of!(TrianglePacket<$n>, v2) == 24 * $n
                && offset_of!(TrianglePacket<$n>, prim_ids) == 36 * $n
        );
    };
}
assert_layout!(4, 128, 192);
assert_layout!(8, 256, 320);
assert_layout!(16, 448, 640);

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

impl<const N: usize> TrianglePacket<N> {
    /// Marks a triangle index as single-sided.
    pub(crate) const SINGLE_SIDED: u32 = 1 << 31;

    /// A packet without triangles. NaN fails every comparison, so that unused lanes do not defeat
    /// the kernel's early way out as degenerate zeros would.
    pub(crate) const VACANT: TrianglePacket<N> = TrianglePacket {
        v0: [[f32::NAN; N]; 3],
        v1: [[f32::NAN; N]; 3],
        v2: [[f32::NAN; N]; 3],
        prim_ids: [u32::MAX; N],
    };
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

/// A bounding volume hierarchy over triangles: `N` children a node, `N` triangles a packet.
#[derive(Clone, Debug)]
pub struct Bvh<const N: usize> {
    pub(crate) nodes: Vec<Node<N>>,
    pub(crate) packets: Vec<TrianglePacket<N>>,
    pub(crate) sah_cost: f32,
}

impl<const N: usize> Bvh<N> {
    /// What the kernels take.
    #[inline(always)]
    pub fn view(&self) -> BvhView<'_, N> {
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
    pub fn packets(&self) -> &[TrianglePacket<N>] {
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
pub struct BvhView<'a, const N: usize> {
    nodes: &'a [Node<N>],
    packets: &'a [TrianglePacket<N>],
}

impl<'a, const N: usize> BvhView<'a, N> {
    /// Checks everything that the kernels' memory safety and termination rest on: a root, children
    /// and packets in range, a tree with parents before children, a depth within the stack's bound;
    /// and also that every node's boxes lie inside the box that its parent holds for it.
    pub fn new(
        nodes: &'a [Node<N>],
        packets: &'a [TrianglePacket<N>],
    ) -> Result<BvhView<'a, N>, InvalidBvh> {
        check_structure(nodes, packets)?;
        Ok(BvhView { nodes, packets })
    }

    /// As [`BvhView::new`], without looking.
    ///
    /// # Safety
    /// [`BvhView::new`] must succeed on these slices, as it does on the nodes and packets of a
    /// [`Bvh`].
    #[inline(always)]
    pub unsafe fn new_unchecked(
        nodes: &'a [Node<N>],
        packets: &'a [TrianglePacket<N>],
    ) -> BvhView<'a, N> {
        BvhView { nodes, packets }
    }

    /// The nodes, the root first.
    #[inline(always)]
    pub fn nodes(&self) -> &'a [Node<N>] {
        self.nodes
    }

    /// The triangles, leaf by leaf.
    #[inline(always)]
    pub fn packets(&self) -> &'a [TrianglePacket<N>] {
        self.packets
    }
}
