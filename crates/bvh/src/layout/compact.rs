//! A hierarchy of a third of the memory: triangles of a packet share vertices, and leaves share packets.
//!
//! In a [`TrianglePacket`](crate::TrianglePacket) of 16, of which 9 are in use on average, triangles bring 27 corners, which are 10
//! different vertices. A [`CompactPacket`] has 16 vertices, each once, and for each triangle the indices of its corners. The
//! kernels shear the vertices instead of the corners, and then look up three of them in each lane, in a register. So the
//! numbers that decide a hit are the same, bit for bit.
//!
//! What a leaf leaves of its packet is taken by its neighbours: a test of the packet takes as long for
//! one leaf's triangles as for those of several, and a hit that it finds beyond the leaf's box is a hit. Leaves whose
//! triangles have more vertices than their packet has room for get more packets than they had, which costs more than smaller
//! leaves would: [`build_compact`](crate::build_compact) plans them so.
//!
//! Measured (`benches/README.md`): 0.34 to 0.5 of the memory, 0.99 to 1.1 of the speed. For fewer lanes there is no such instruction.

use std::collections::VecDeque;
use std::fmt;
use std::mem::{align_of, offset_of, size_of};
use std::ops::Range;

use rayon::prelude::*;

use crate::bounds::Bounds;
use crate::layout::bvh::{Bvh, BvhView};
use crate::layout::child::Child;
use crate::layout::node::WideNode;
use crate::layout::packet::Packet;
use crate::layout::packet::sealed::Sealed;
use crate::layout::triangle_packet::TrianglePacket;
use crate::simd::Width;

/// Triangles, and vertices, of a packet.
pub(crate) const LANES: usize = 16;
/// Nodes, one after the other in the order of the hierarchy, whose leaves share packets.
const TOGETHER: usize = 256;
/// So many packets are looked at for room.
const MOST_OPEN: usize = 32;
/// Set in the corners of an unused lane.
const UNUSED: u16 = 1 << 15;

/// At most 16 triangles on at most 16 vertices.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct CompactPacket {
    /// `[axis][vertex]`; NaN behind the last.
    pub vertices: [[f32; 16]; 3],
    /// Triangle indices, as in [`TrianglePacket::prim_ids`].
    pub prim_ids: [u32; 16],
    /// The indices of each triangle's corners, four bits each, the first in the lowest. The high bit is set in lanes
    /// that are not used.
    pub corners: [u16; 16],
}

/// Bytes: half a line of the caches at the end. A `TrianglePacket<16>` has ten.
const _: () = assert!(
    size_of::<CompactPacket>() == 288
        && align_of::<CompactPacket>() == 32
        && offset_of!(CompactPacket, prim_ids) == 192
        && offset_of!(CompactPacket, corners) == 256
);

impl CompactPacket {
    const VACANT: CompactPacket = CompactPacket {
        vertices: [[f32::NAN; LANES]; 3],
        prim_ids: [u32::MAX; LANES],
        corners: [UNUSED; LANES],
    };
}

impl Sealed for CompactPacket {}

impl Packet<16> for CompactPacket {
    #[inline(always)]
    fn prim_ids(&self) -> &[u32; 16] {
        &self.prim_ids
    }

    #[inline(always)]
    fn coordinate(&self, lane: usize, corner: usize, axis: usize) -> f32 {
        let vertex = self.corners[lane % LANES] >> (4 * (corner % 3));
        self.vertices[axis % 3][usize::from(vertex) % LANES]
    }

    #[inline(always)]
    fn used<S: Width<16>>(&self, simd: S) -> u32 {
        !simd.high_bits(&self.corners)
    }

    #[inline(always)]
    fn in_lanes<S: Width<16>>(
        &self,
        simd: S,
        moved: impl Fn(&[[f32; 16]; 3]) -> [S::Float; 3],
    ) -> [[S::Float; 3]; 3] {
        simd.look_up(moved(&self.vertices), &self.corners)
    }
}

/// As [`Bvh`], with packets that share. It answers the same through [`view`](CompactBvh::view) and the kernels.
#[derive(Clone, Debug)]
pub struct CompactBvh<const N: usize> {
    nodes: Vec<WideNode<N>>,
    packets: Vec<CompactPacket>,
}

/// A leaf would need more packets than its parent can name: it has more than 64 triangles, as no built hierarchy has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LeafTooLarge {
    /// The parent.
    pub node: usize,
    /// The leaf's slot.
    pub slot: usize,
}

impl fmt::Display for LeafTooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let LeafTooLarge { node, slot } = self;
        write!(f, "node {node}, slot {slot}: too many triangles in a leaf")
    }
}

impl std::error::Error for LeafTooLarge {}

impl<const N: usize> TryFrom<Bvh<N, 16>> for CompactBvh<N> {
    type Error = LeafTooLarge;

    fn try_from(bvh: Bvh<N, 16>) -> Result<CompactBvh<N>, LeafTooLarge> {
        let Bvh {
            mut nodes, packets, ..
        } = bvh;
        let packed: Vec<Vec<Filling>> = nodes
            .par_chunks_mut(TOGETHER)
            .enumerate()
            .map(|(chunk, nodes)| {
                let mut packing = Packing::default();
                for (index, node) in nodes.iter_mut().enumerate() {
                    packing.place_leaves(TOGETHER * chunk + index, node, &packets)?;
                }
                Ok(packing.fillings)
            })
            .collect::<Result<_, _>>()?;
        drop(packets);
        let mut packets = Vec::with_capacity(packed.iter().map(Vec::len).sum());
        for (nodes, fillings) in nodes.chunks_mut(TOGETHER).zip(packed) {
            let leaves = nodes.iter_mut().flat_map(|node| &mut node.children);
            for child in
                leaves.filter(|child| **child != Child::VACANT.0 && Child(**child).is_leaf())
            {
                let leaf = Child(*child);
                let first = packets.len() + leaf.first_packet();
                *child = Child::leaf(first, leaf.packet_count()).0;
            }
            packets.extend(fillings.into_iter().map(|filling| filling.packet));
        }
        Ok(CompactBvh { nodes, packets })
    }
}

impl<const N: usize> CompactBvh<N> {
    /// What the kernels take.
    #[inline(always)]
    pub fn view(&self) -> BvhView<'_, N, 16, WideNode<N>, CompactPacket> {
        // SAFETY: the nodes are those of a sound hierarchy but for their leaves, whose packets exist.
        unsafe { BvhView::new_unchecked(&self.nodes, &self.packets) }
    }

    /// The nodes, the root first, parents before their children.
    pub fn nodes(&self) -> &[WideNode<N>] {
        &self.nodes
    }

    /// The triangles, node by node.
    pub fn packets(&self) -> &[CompactPacket] {
        &self.packets
    }

    /// The box around everything; empty if there are no triangles.
    pub fn bounds(&self) -> Bounds {
        self.nodes[0].bounds()
    }

    /// Size of nodes and packets.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(self.nodes()) + size_of_val(self.packets())
    }
}

/// A triangle on its way from one packet to another.
#[derive(Clone, Copy)]
struct Triangle {
    /// With its mark.
    prim: u32,
    corners: [[f32; 3]; 3],
}

/// A packet that is being filled.
#[derive(Clone)]
struct Filling {
    packet: CompactPacket,
    vertex_count: usize,
    triangle_count: usize,
}

impl Filling {
    const EMPTY: Filling = Filling {
        packet: CompactPacket::VACANT,
        vertex_count: 0,
        triangle_count: 0,
    };

    /// The index of a vertex with these bits.
    fn find(&self, position: [f32; 3]) -> Option<usize> {
        let rows = &self.packet.vertices;
        let is_here = |vertex: &usize| {
            (0..3).all(|axis| rows[axis][*vertex].to_bits() == position[axis].to_bits())
        };
        (0..self.vertex_count).find(is_here)
    }

    /// How many vertices the triangle would add, if there is room for it.
    fn price(&self, triangle: &Triangle) -> Option<usize> {
        if self.has(triangle) {
            return Some(0);
        }
        let new = triangle
            .corners
            .iter()
            .enumerate()
            .filter(|&(corner, &position)| {
                let before = &triangle.corners[..corner];
                self.find(position).is_none() && !before.iter().any(|other| same(other, &position))
            });
        let count = new.count();
        (self.triangle_count < LANES && self.vertex_count + count <= LANES).then_some(count)
    }

    fn has(&self, triangle: &Triangle) -> bool {
        self.packet.prim_ids[..self.triangle_count].contains(&triangle.prim)
    }

    /// Adds a triangle for which there is room, unless it is here already.
    fn add(&mut self, triangle: &Triangle) {
        if self.has(triangle) {
            return;
        }
        let mut corners = 0;
        for (corner, &position) in triangle.corners.iter().enumerate() {
            let vertex = self.find(position).unwrap_or_else(|| {
                let new = self.vertex_count;
                for (row, x) in self.packet.vertices.iter_mut().zip(position) {
                    row[new] = x;
                }
                self.vertex_count += 1;
                new
            });
            corners |= (vertex as u16) << (4 * corner);
        }
        self.packet.prim_ids[self.triangle_count] = triangle.prim;
        self.packet.corners[self.triangle_count] = corners;
        self.triangle_count += 1;
    }

    /// This packet with all these triangles too, if there is room for them.
    fn with(&self, triangles: &[Triangle]) -> Option<Filling> {
        // Only those that are here already would fit, too: rare, and not looked for.
        if self.triangle_count + triangles.len() > LANES {
            return None;
        }
        let mut filling = self.clone();
        for triangle in triangles {
            filling.price(triangle)?;
            filling.add(triangle);
        }
        Some(filling)
    }
}

/// Whether two points have the same bits: zeros of either sign are two, whose tests may differ in the sign of a zero.
fn same(a: &[f32; 3], b: &[f32; 3]) -> bool {
    a.map(f32::to_bits) == b.map(f32::to_bits)
}

/// The packets of some nodes' leaves.
#[derive(Default)]
struct Packing {
    fillings: Vec<Filling>,
    /// Indices of those that have room, a few of the last.
    open: VecDeque<usize>,
}

impl Packing {
    /// Packs the triangles of a node's leaves, and has its children name the packets.
    fn place_leaves<const N: usize>(
        &mut self,
        index: usize,
        node: &mut WideNode<N>,
        packets: &[TrianglePacket<16>],
    ) -> Result<(), LeafTooLarge> {
        let mut leaves: Vec<(usize, Vec<Triangle>)> = (0..N)
            .filter(|&slot| Child(node.children[slot]).is_leaf())
            .map(|slot| (slot, triangles_of(Child(node.children[slot]), packets)))
            .collect();
        // What is large first: it leaves room for what is small.
        leaves.sort_by_key(|(_, triangles)| std::cmp::Reverse(triangles.len()));
        for (slot, triangles) in leaves {
            let names = self.place(triangles);
            if names.len() > Child::MAX_PACKETS {
                return Err(LeafTooLarge { node: index, slot });
            }
            node.children[slot] = if names.is_empty() {
                Child::VACANT.0
            } else {
                Child::leaf(names.start, names.len()).0
            };
        }
        Ok(())
    }

    /// Finds room for a leaf's triangles. Returns the indices of their packets.
    fn place(&mut self, mut triangles: Vec<Triangle>) -> Range<usize> {
        let first = self.fillings.len();
        if triangles.is_empty() {
            return first..first;
        }
        // In what others have left, where it shares the most.
        let shared = self
            .open
            .iter()
            .filter_map(|&index| Some((index, self.fillings[index].with(&triangles)?)))
            .min_by_key(|(index, filling)| {
                filling.vertex_count - self.fillings[*index].vertex_count
            });
        if let Some((index, filling)) = shared {
            self.fillings[index] = filling;
            return index..index + 1;
        }
        if let Some(filling) = Filling::EMPTY.with(&triangles) {
            self.push(filling);
            return first..first + 1;
        }
        // In several packets, each of which grows by what adds the fewest vertices.
        let mut filling = Filling::EMPTY;
        while !triangles.is_empty() {
            let cheapest = (0..triangles.len())
                .filter_map(|index| Some((index, filling.price(&triangles[index])?)))
                .min_by_key(|&(_, price)| price);
            match cheapest {
                Some((index, _)) => filling.add(&triangles.remove(index)),
                None => self.push(std::mem::replace(&mut filling, Filling::EMPTY)),
            }
        }
        self.push(filling);
        first..self.fillings.len()
    }

    fn push(&mut self, filling: Filling) {
        if self.open.len() == MOST_OPEN {
            self.open.pop_front();
        }
        self.open.push_back(self.fillings.len());
        self.fillings.push(filling);
    }
}

/// The triangles of a leaf.
fn triangles_of(leaf: Child, packets: &[TrianglePacket<16>]) -> Vec<Triangle> {
    let first = leaf.first_packet();
    let packets = &packets[first..first + leaf.packet_count()];
    let lanes = packets.iter().flat_map(|packet| {
        let lanes = packet.prim_ids.iter().enumerate();
        lanes.map(move |(lane, &prim)| Triangle {
            prim,
            corners: Packet::corners(packet, lane),
        })
    });
    lanes.filter(|triangle| triangle.prim != u32::MAX).collect()
}
