//! The binary tree over references, as plain topology.

use std::ops::Range;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BinaryNode {
    /// Index of a reference.
    Leaf(u32),
    /// Indices of both children. The left one follows its parent, the right one the left subtree.
    Inner(u32, u32),
}

/// Nodes in preorder, whose references have ascending indices from left to right; without references there are no
/// nodes.
pub(crate) struct BinaryTree {
    pub(crate) nodes: Vec<BinaryNode>,
}

impl BinaryTree {
    /// The references below a node that has `count` of them.
    pub(crate) fn references_below(&self, mut node: u32, count: u32) -> Range<usize> {
        loop {
            match self.nodes[node as usize] {
                BinaryNode::Leaf(first) => return first as usize..first as usize + count as usize,
                BinaryNode::Inner(left, _) => node = left,
            }
        }
    }

    /// A value for each node, from the index of its reference or from both children's values.
    pub(crate) fn bottom_up<T: Copy + Default>(
        &self,
        leaf: impl Fn(u32) -> T,
        inner: impl Fn(T, T) -> T,
    ) -> Vec<T> {
        let mut values = vec![T::default(); self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate().rev() {
            values[index] = match *node {
                BinaryNode::Leaf(reference) => leaf(reference),
                BinaryNode::Inner(left, right) => {
                    inner(values[left as usize], values[right as usize])
                }
            };
        }
        values
    }
}

/// A node whose children come later: pushes it, and tells the parent of which it is the right child.
pub(crate) fn push_preorder(
    nodes: &mut Vec<BinaryNode>,
    node: BinaryNode,
    parent: Option<u32>,
) -> u32 {
    let index = nodes.len() as u32;
    nodes.push(node);
    if let Some(parent) = parent {
        nodes[parent as usize] = BinaryNode::Inner(parent + 1, index);
    }
    index
}
