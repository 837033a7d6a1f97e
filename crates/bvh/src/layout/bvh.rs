//! The hierarchy in memory: its nodes and packets, owned ([`Bvh`]) or seen ([`BvhView`]).

use crate::bounds::Bounds;
use crate::layout::boxes::Boxes;
use crate::layout::node::WideNode;
use crate::layout::packet::Packet;
use crate::layout::triangle_packet::TrianglePacket;
use crate::layout::validate::{InvalidBvh, check_nodes};

/// A bounding volume hierarchy over triangles: `N` children a node (2, 4, 8 or 16), `P` triangles a
/// packet (1, 4, 8 or 16).
#[derive(Clone, Debug)]
pub struct Bvh<const N: usize, const P: usize = N> {
    pub(crate) nodes: Vec<WideNode<N>>,
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
    pub fn nodes(&self) -> &[WideNode<N>] {
        &self.nodes
    }

    /// The triangles, leaf by leaf.
    pub fn packets(&self) -> &[TrianglePacket<P>] {
        &self.packets
    }

    /// The box around everything; empty if there are no triangles.
    pub fn bounds(&self) -> Bounds {
        self.nodes[0].bounds()
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
pub struct BvhView<'a, const N: usize, const P: usize = N, B = WideNode<N>, T = TrianglePacket<P>> {
    nodes: &'a [B],
    packets: &'a [T],
}

impl<'a, const N: usize, const P: usize, B: Boxes<N>, T: Packet<P>> BvhView<'a, N, P, B, T> {
    /// Checks everything that the kernels' memory safety and termination rest on: a root, children
    /// and packets in range, a tree with parents before children, a depth within the stack's bound;
    /// and also that every node's boxes lie inside the box that its parent holds for it.
    pub fn new(nodes: &'a [B], packets: &'a [T]) -> Result<BvhView<'a, N, P, B, T>, InvalidBvh> {
        check_nodes(nodes, packets.len())?;
        Ok(BvhView { nodes, packets })
    }

    /// As [`BvhView::new`], without looking.
    ///
    /// # Safety
    /// [`BvhView::new`] must succeed on these slices, as it does on the nodes and packets of a
    /// [`Bvh`] or a [`crate::QuantizedBvh`].
    #[inline(always)]
    pub unsafe fn new_unchecked(nodes: &'a [B], packets: &'a [T]) -> BvhView<'a, N, P, B, T> {
        BvhView { nodes, packets }
    }

    /// The nodes, the root first.
    #[inline(always)]
    pub fn nodes(&self) -> &'a [B] {
        self.nodes
    }

    /// The triangles, leaf by leaf.
    #[inline(always)]
    pub fn packets(&self) -> &'a [T] {
        self.packets
    }

    /// Whether all coordinates are so far from overflow that products of two are finite.
    #[inline(always)]
    pub(crate) fn is_moderate(&self) -> bool {
        let root = &self.nodes[0];
        (0..N).all(|slot| root.child_bounds(slot).is_moderate())
    }
}
