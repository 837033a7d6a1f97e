//! A hierarchy as kernels read it: rows of four numbers, four boxes a node and four triangles a packet.

use residual_bvh::Bvh;
use residual_wgsl::STACK;

use crate::error::Error;

/// A hierarchy in rows.
pub(crate) struct Tree {
    /// Rows of nodes, then rows of packets.
    pub(crate) words: Vec<u32>,
    /// The first row of the packets.
    pub(crate) first_packet: u32,
}

impl Tree {
    /// The rows of a hierarchy.
    ///
    /// # Errors
    /// If a kernel's stack could overflow.
    pub(crate) fn new(bvh: &Bvh<4>) -> Result<Self, Error> {
        let needed = stack_entries(bvh);
        if needed > STACK {
            return Err(Error::TooDeep {
                needed,
                available: STACK,
            });
        }
        let mut words = Vec::with_capacity(bvh.nodes().len() * 28 + bvh.packets().len() * 40);
        for node in bvh.nodes() {
            words.extend(node.bounds.as_flattened().iter().map(|x| x.to_bits()));
            words.extend(node.children);
        }
        let first_packet = words.len() as u32 / 4;
        for packet in bvh.packets() {
            let corners = packet.vertices.as_flattened().as_flattened();
            words.extend(corners.iter().map(|x| x.to_bits()));
            words.extend(packet.prim_ids);
        }
        Ok(Self {
            words,
            first_packet,
        })
    }
}

/// The most entries that wait on the stack at once: three of each node on a way down.
fn stack_entries(bvh: &Bvh<4>) -> usize {
    const LEAF: u32 = 1 << 31;
    let mut depths = vec![0; bvh.nodes().len()];
    // Parents come before their children.
    for (index, node) in bvh.nodes().iter().enumerate() {
        for &child in node.children.iter().filter(|&child| child & LEAF == 0) {
            depths[child as usize] = depths[index] + 1;
        }
    }
    3 * (1 + depths.into_iter().max().unwrap_or(0))
}
