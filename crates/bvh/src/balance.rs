//! Bounds the depth of the binary tree, and with it that of the traversal's stack.
//!
//! Clustering and reinsertion minimise area, not depth: triangles in a geometric cascade, or all
//! alike, can become a list. Where a subtree would reach too deep it is followed for as long as
//! everything below could still be arranged within the limit, and then replaced by median splits
//! of its references in their present order, which is a spatial one.

use crate::binary::{BinaryNode, BinaryTree};
use crate::bvh::MAX_DEPTH;

/// Where a node of the limited tree comes from.
enum Source {
    /// A node of the given tree, kept.
    Kept(u32),
    /// References to be split at their median.
    Balanced(Vec<u32>),
}

/// A tree over the same references with at most [`MAX_DEPTH`] inner nodes on any path.
///
/// It always exists: the invariant is that the references below a node at level `l` (the root's is
/// zero) number at most 2^(MAX_DEPTH - l), and there are fewer than 2³³ references.
pub(crate) fn limit_depth(tree: BinaryTree) -> BinaryTree {
    let heights = tree.bottom_up(|_| 0usize, |left, right| 1 + left.max(right));
    if heights.first().is_none_or(|&height| height <= MAX_DEPTH) {
        return tree;
    }
    let counts = tree.bottom_up(|_| 1usize, |left, right| left + right);
    let fits = |node: u32, level: usize| levels_needed(counts[node as usize]) + level <= MAX_DEPTH;

    let mut nodes = vec![BinaryNode::Leaf(0)];
    let mut pending = vec![(Source::Kept(0), 0usize, 0usize)];
    while let Some((source, level, target)) = pending.pop() {
        let children = match source {
            Source::Kept(node) => match tree.nodes[node as usize] {
                BinaryNode::Leaf(reference) => Err(reference),
                BinaryNode::Inner(left, right)
                    if heights[node as usize] + level <= MAX_DEPTH
                        || fits(left, level + 1) && fits(right, level + 1) =>
                {
                    Ok((Source::Kept(left), Source::Kept(right)))
                }
                BinaryNode::Inner(..) => Ok(halves(tree.references_below(node))),
            },
            Source::Balanced(references) => match references[..] {
                [reference] => Err(reference),
                _ => Ok(halves(references)),
            },
        };
        nodes[target] = match children {
            Err(reference) => BinaryNode::Leaf(reference),
            Ok((left, right)) => {
                let first = nodes.len();
                nodes.extend([BinaryNode::Leaf(0); 2]);
                pending.push((right, level + 1, first + 1));
                pending.push((left, level + 1, first));
                BinaryNode::Inner(first as u32, first as u32 + 1)
            }
        };
    }
    BinaryTree { nodes }
}

/// Height of a balanced tree over `count` references.
fn levels_needed(count: usize) -> usize {
    count.next_power_of_two().trailing_zeros() as usize
}

fn halves(mut references: Vec<u32>) -> (Source, Source) {
    let right = references.split_off(references.len().div_ceil(2));
    (Source::Balanced(references), Source::Balanced(right))
}
