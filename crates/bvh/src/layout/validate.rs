//! The structural check that lets bytes made elsewhere be traversed without bounds checks.

use std::fmt;

use crate::layout::boxes::Boxes;
use crate::layout::child::Child;

/// Levels of inner nodes on the longest path, the root's included. The builder keeps to it and
/// [`check_nodes`] checks it, so that the traversal's stack cannot overflow.
pub(crate) const MAX_DEPTH: usize = 64;

/// Why nodes and packets do not form a hierarchy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InvalidBvh {
    /// There is no root.
    NoNodes,
    /// A child is out of range, precedes its parent, or has a second parent.
    BadChild {
        /// The parent.
        node: usize,
        /// The child's slot.
        slot: usize,
    },
    /// A leaf's packets are out of range.
    BadLeaf {
        /// The parent.
        node: usize,
        /// The leaf's slot.
        slot: usize,
    },
    /// A node lies deeper than the traversal's stack allows.
    TooDeep {
        /// The node.
        node: usize,
    },
    /// A node's boxes reach out of the box that its parent holds for it.
    BadBounds {
        /// The parent.
        node: usize,
        /// The child's slot.
        slot: usize,
    },
}

impl fmt::Display for InvalidBvh {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            InvalidBvh::NoNodes => write!(f, "hierarchy without a root"),
            InvalidBvh::BadChild { node, slot } => {
                write!(
                    f,
                    "node {node}, slot {slot}: not a child of this node alone"
                )
            }
            InvalidBvh::BadLeaf { node, slot } => {
                write!(f, "node {node}, slot {slot}: triangle packets out of range")
            }
            InvalidBvh::TooDeep { node } => {
                write!(f, "node {node}: deeper than {MAX_DEPTH} levels")
            }
            InvalidBvh::BadBounds { node, slot } => {
                write!(
                    f,
                    "node {node}, slot {slot}: box does not contain the child's boxes"
                )
            }
        }
    }
}

impl std::error::Error for InvalidBvh {}

/// For leaves that name some of `packet_count` packets, or of other things. One pass suffices
/// because parents precede their children.
pub(crate) fn check_nodes<const N: usize>(
    nodes: &[impl Boxes<N>],
    packet_count: usize,
) -> Result<(), InvalidBvh> {
    if nodes.is_empty() {
        return Err(InvalidBvh::NoNodes);
    }
    // Level of each node once its parent has been seen, zero before.
    let mut levels = vec![0usize; nodes.len()];
    levels[0] = 1;
    for (index, node) in nodes.iter().enumerate() {
        for slot in 0..N {
            let child = Child(node.children()[slot]);
            if child.is_leaf() {
                if child.first_packet() + child.packet_count() > packet_count {
                    return Err(InvalidBvh::BadLeaf { node: index, slot });
                }
                continue;
            }
            let child = child.0 as usize;
            if child <= index || child >= nodes.len() || levels[child] != 0 {
                return Err(InvalidBvh::BadChild { node: index, slot });
            }
            levels[child] = levels[index] + 1;
            if levels[child] > MAX_DEPTH {
                return Err(InvalidBvh::TooDeep { node: child });
            }
            let bounds = node.child_bounds(slot);
            if !(0..N).all(|inner| bounds.contains(&nodes[child].child_bounds(inner))) {
                return Err(InvalidBvh::BadBounds { node: index, slot });
            }
        }
    }
    Ok(())
}
