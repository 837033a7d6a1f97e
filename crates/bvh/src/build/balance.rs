//! Bounds the depth of the binary tree, and with it that of the traversal's stack.
//!
//! Reinsertion minimises area, not depth: triangles in a geometric cascade can become a list. Where a
//! subtree would reach too deep it is followed for as long as everything below could still be
//! arranged within the limit, and then replaced by median splits of its references in their present
//! order, which is a spatial one.

use std::ops::Range;

use crate::build::binary::{BinaryNode, BinaryTree, push_preorder};
use crate::layout::validate::MAX_DEPTH;

/// Where a node of the limited tree comes from.
enum Source {
    /// A node of the given tree, kept.
    Kept(u32),
    /// References to be split at their median.
    Balanced(Range<u32>),
}

/// A tree over the same references with at most [`MAX_DEPTH`] inner nodes on any path.
///
/// It always exists: the invariant is that the references below a node at level `l` (the root's is
/// zero) number at most 2^(MAX_DEPTH - l), and there are fewer than 2³³ references.
pub(crate) fn limit_depth(tree: BinaryTree) -> BinaryTree {
    let heights = tree.bottom_up(|_| 0u32, |left, right| 1 + left.max(right));
    if heights
        .first()
        .is_none_or(|&height| height as usize <= MAX_DEPTH)
    {
        return tree;
    }
    let counts = tree.bottom_up(|_| 1u32, |left, right| left + right);
    let fits = |node: u32, level: usize| {
        levels_needed(counts[node as usize] as usize) + level <= MAX_DEPTH
    };

    let mut nodes = Vec::with_capacity(tree.nodes.len());
    let mut pending = vec![(Source::Kept(0), 0usize, None)];
    while let Some((source, level, parent)) = pending.pop() {
        let children = match source {
            Source::Kept(node) => match tree.nodes[node as usize] {
                BinaryNode::Leaf(reference) => Err(reference),
                BinaryNode::Inner(left, right)
                    if heights[node as usize] as usize + level <= MAX_DEPTH
                        || fits(left, level + 1) && fits(right, level + 1) =>
                {
                    Ok((Source::Kept(left), Source::Kept(right)))
                }
                BinaryNode::Inner(..) => {
                    let below = tree.references_below(node, counts[node as usize]);
                    Ok(halves(below.start as u32..below.end as u32))
                }
            },
            Source::Balanced(references) if references.len() == 1 => Err(references.start),
            Source::Balanced(references) => Ok(halves(references)),
        };
        let node = BinaryNode::Leaf(children.as_ref().err().copied().unwrap_or(0));
        let index = push_preorder(&mut nodes, node, parent);
        if let Ok((left, right)) = children {
            pending.push((right, level + 1, Some(index)));
            pending.push((left, level + 1, None));
        }
    }
    BinaryTree { nodes }
}

/// Height of a balanced tree over `count` references.
pub(crate) fn levels_needed(count: usize) -> usize {
    count.next_power_of_two().trailing_zeros() as usize
}

fn halves(references: Range<u32>) -> (Source, Source) {
    let middle = references.start + (references.end - references.start).div_ceil(2);
    (
        Source::Balanced(references.start..middle),
        Source::Balanced(middle..references.end),
    )
}
