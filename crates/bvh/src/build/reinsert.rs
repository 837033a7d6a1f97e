//! Subtrees moved to where they cost less.
//!
//! D. Meister, J. Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization",
//! Eurographics 2018: all moves of a round are searched at once, in the tree as it is, and carried
//! out one by one, the most profitable first, unless an earlier one has touched the same nodes.

use rayon::prelude::*;

use crate::build::balance::limit_depth;
use crate::build::binary::{BinaryNode, BinaryTree, push_preorder};
use crate::build::fragment::Box3;
use crate::build::reference::Reference;

const NONE: u32 = u32::MAX;

/// Cost of an inner node of the binary tree, in packets: several of them become one wide node.
const NODE_COST: f32 = 0.3;

#[derive(Clone, Copy)]
struct LinkedNode {
    bounds: Box3,
    parent: u32,
    /// [`NONE`] for a leaf or a cluster.
    children: [u32; 2],
    /// The node of the given tree.
    source: u32,
}

#[derive(Clone, Copy)]
struct Move {
    from: u32,
    /// Becomes the sibling.
    to: u32,
    /// By how much the sum of the inner nodes' areas falls.
    gain: f32,
}

/// Where a node of the improved tree comes from.
enum Origin {
    Linked(u32),
    /// A node of the given tree.
    Kept(u32),
}

/// What is known of a subtree of the given tree.
#[derive(Clone, Copy)]
struct Cluster {
    bounds: Box3,
    count: u32,
    cost: f32,
    /// It costs least as a leaf of one packet, so that it moves as a whole.
    is_whole: bool,
}

fn clusters(tree: &BinaryTree, references: &[Reference], packet: u32) -> Vec<Cluster> {
    let vacant = Cluster {
        bounds: Box3::EMPTY,
        count: 0,
        cost: 0.0,
        is_whole: true,
    };
    let mut clusters = vec![vacant; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        clusters[index] = match *node {
            BinaryNode::Leaf(reference) => {
                let bounds = references[reference as usize].bounds;
                let bounds = Box3 {
                    lo: bounds.lo.into(),
                    hi: bounds.hi.into(),
                };
                Cluster {
                    bounds,
                    count: 1,
                    cost: bounds.half_area(),
                    is_whole: true,
                }
            }
            BinaryNode::Inner(left, right) => {
                let (left, right) = (&clusters[left as usize], &clusters[right as usize]);
                let bounds = left.bounds.union(&right.bounds);
                let area = bounds.half_area();
                let count = left.count + right.count;
                let apart = left.cost + right.cost + NODE_COST * area;
                let is_whole = count <= packet && area <= apart;
                Cluster {
                    bounds,
                    count,
                    cost: if is_whole { area } else { apart },
                    is_whole,
                }
            }
        };
    }
    clusters
}

struct LinkedTree {
    nodes: Vec<LinkedNode>,
}

/// Improves the tree: each round tries to move a `share` of the nodes, those of the largest boxes.
/// Up to `packet` references that make a good leaf move together. The references get
/// new indices, ascending from left to right.
pub(crate) fn reinsert(
    tree: BinaryTree,
    references: Vec<Reference>,
    packet: u32,
    shares: &[f32],
) -> (BinaryTree, Vec<Reference>) {
    if references.len() < 4 || shares.is_empty() {
        return (tree, references);
    }
    let clusters = clusters(&tree, &references, packet);
    let mut linked = LinkedTree::new(&tree, &clusters);
    let mut touched = vec![0u32; linked.nodes.len()];
    for (&share, round) in shares.iter().zip(1..) {
        linked.round(share, &mut touched, round);
    }
    let (tree, order) = linked.into_tree(&tree);
    let references = order
        .par_iter()
        .map(|&index| references[index as usize])
        .collect();
    (limit_depth(tree), references)
}

impl LinkedTree {
    fn new(tree: &BinaryTree, clusters: &[Cluster]) -> LinkedTree {
        let mut nodes = Vec::new();
        let mut pending = vec![(0u32, NONE)];
        while let Some((source, parent)) = pending.pop() {
            let index = nodes.len() as u32;
            let cluster = &clusters[source as usize];
            nodes.push(LinkedNode {
                bounds: cluster.bounds,
                parent,
                children: [NONE; 2],
                source,
            });
            if parent != NONE {
                // The left child is pushed before the right one.
                let children = &mut nodes[parent as usize].children;
                children[usize::from(children[0] != NONE)] = index;
            }
            if let (BinaryNode::Inner(left, right), false) =
                (tree.nodes[source as usize], cluster.is_whole)
            {
                pending.extend([(right, index), (left, index)]);
            }
        }
        LinkedTree { nodes }
    }

    fn node(&self, index: u32) -> &LinkedNode {
        &self.nodes[index as usize]
    }

    fn sibling(&self, index: u32) -> u32 {
        let [left, right] = self.node(self.node(index).parent).children;
        if left == index { right } else { left }
    }

    fn round(&mut self, share: f32, touched: &mut [u32], round: u32) {
        let count = (self.nodes.len() as f32 * share) as usize;
        let mut candidates: Vec<(u32, u32)> = self
            .nodes
            .par_iter()
            .enumerate()
            .skip(1)
            .map(|(index, node)| (!node.bounds.half_area().max(0.0).to_bits(), index as u32))
            .collect();
        if count < candidates.len() {
            candidates.select_nth_unstable(count);
            candidates.truncate(count);
        }
        candidates.sort_unstable_by_key(|c| c.1);
        let mut moves: Vec<Move> = candidates
            .par_iter()
            .with_min_len(64)
            .map_init(Vec::new, |stack, &(_, node)| self.best_move(node, stack))
            .filter(|found| found.gain > 0.0)
            .collect();
        moves.par_sort_unstable_by(|a, b| b.gain.total_cmp(&a.gain).then(a.from.cmp(&b.from)));
        for Move { from, to, .. } in moves {
            let involved = [
                from,
                to,
                self.node(from).parent,
                self.node(to).parent,
                self.sibling(from),
            ];
            if involved.iter().any(|&node| touched[node as usize] == round)
                || self.is_below(to, from)
            {
                continue;
            }
            involved
                .iter()
                .for_each(|&node| touched[node as usize] = round);
            self.carry_out(from, to);
        }
    }

    fn is_below(&self, mut node: u32, ancestor: u32) -> bool {
        while node != NONE {
            if node == ancestor {
                return true;
            }
            node = self.node(node).parent;
        }
        false
    }

    /// Where a node is best moved to, leaving its parent to join the node and its new sibling.
    fn best_move(&self, from: u32, stack: &mut Vec<(f32, u32)>) -> Move {
        let bounds = self.node(from).bounds;
        let area = bounds.half_area();
        let parent = self.node(from).parent;
        let mut best = Move {
            from,
            to: NONE,
            gain: 0.0,
        };
        // What removing the node saves on the path up to the pivot.
        let mut saved = self.node(parent).bounds.half_area();
        let mut pivot = parent;
        let mut sibling = self.sibling(from);
        let mut remaining = self.node(sibling).bounds;
        loop {
            stack.push((saved, sibling));
            while let Some((saved, node)) = stack.pop() {
                if saved - area <= best.gain {
                    continue;
                }
                let target = self.node(node);
                let gain = saved - target.bounds.union(&bounds).half_area();
                if gain > best.gain {
                    best = Move {
                        from,
                        to: node,
                        gain,
                    };
                }
                let [left, right] = target.children;
                let saved = gain + target.bounds.half_area();
                if left != NONE && saved - area > best.gain {
                    stack.push((saved, left));
                    stack.push((saved, right));
                }
            }
            if pivot != parent {
                remaining = remaining.union(&self.node(sibling).bounds);
                saved += self.node(pivot).bounds.half_area() - remaining.half_area();
            }
            if pivot == 0 {
                break;
            }
            sibling = self.sibling(pivot);
            pivot = self.node(pivot).parent;
        }
        if best.to != NONE && (best.to == parent || best.to == self.sibling(from)) {
            best.gain = 0.0;
        }
        best
    }

    fn carry_out(&mut self, from: u32, to: u32) {
        let parent = self.node(from).parent;
        let grandparent = self.node(parent).parent;
        let sibling = self.sibling(from);
        if grandparent == NONE {
            // The root's children stay: the root must not move.
            return;
        }
        self.replace_child(grandparent, parent, sibling);
        self.refit(grandparent);
        let above = self.node(to).parent;
        self.replace_child(above, to, parent);
        self.nodes[parent as usize].children = [to, from];
        self.nodes[to as usize].parent = parent;
        self.nodes[from as usize].parent = parent;
        self.refit(parent);
    }

    fn replace_child(&mut self, parent: u32, old: u32, new: u32) {
        let children = &mut self.nodes[parent as usize].children;
        children[usize::from(children[1] == old)] = new;
        self.nodes[new as usize].parent = parent;
    }

    fn refit(&mut self, mut node: u32) {
        while node != NONE {
            let [left, right] = self.node(node).children;
            let bounds = self.node(left).bounds.union(&self.node(right).bounds);
            self.nodes[node as usize].bounds = bounds;
            node = self.node(node).parent;
        }
    }

    /// The tree in preorder, and the references from left to right.
    fn into_tree(self, tree: &BinaryTree) -> (BinaryTree, Vec<u32>) {
        let mut nodes = Vec::with_capacity(tree.nodes.len());
        let mut order = Vec::with_capacity(tree.nodes.len() / 2 + 1);
        let mut pending = vec![(Origin::Linked(0), None)];
        while let Some((origin, parent)) = pending.pop() {
            let leaf = BinaryNode::Leaf(order.len() as u32);
            let index = push_preorder(&mut nodes, leaf, parent);
            let origin = match origin {
                Origin::Linked(node) if self.node(node).children[0] == NONE => {
                    Origin::Kept(self.node(node).source)
                }
                origin => origin,
            };
            let children = match origin {
                Origin::Linked(node) => self.node(node).children.map(Origin::Linked),
                Origin::Kept(node) => match tree.nodes[node as usize] {
                    BinaryNode::Inner(left, right) => [left, right].map(Origin::Kept),
                    BinaryNode::Leaf(reference) => {
                        order.push(reference);
                        continue;
                    }
                },
            };
            let [left, right] = children;
            pending.push((right, Some(index)));
            pending.push((left, None));
        }
        (BinaryTree { nodes }, order)
    }
}
