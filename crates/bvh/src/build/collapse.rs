//! The binary tree collapsed into `N`-wide nodes and leaves of triangle packets, at the least cost
//! under the surface area heuristic.
//!
//! The dynamic programme is that of H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1: bottom-up, for every
//! binary node and every `i < N`, the least cost of representing its subtree by at most `i` wide
//! nodes or leaves.

use std::ops::Range;

use glam::Vec3;
use rayon::prelude::*;

use crate::bounds::Bounds;
use crate::build::binary::{BinaryNode, BinaryTree};
use crate::build::leaf_size::{LeafSize, MAX_LEAF_PACKETS};
use crate::build::mesh::Mesh;
use crate::build::reference::Reference;
use crate::layout::bvh::Bvh;
use crate::layout::child::Child;
use crate::layout::node::WideNode;
use crate::layout::triangle_packet::{SINGLE_SIDED, TrianglePacket};
use crate::layout::validate::check_nodes;

/// Cost of testing a ray against a packet, in units of testing it against a node.
pub(crate) const PACKET_COST: f32 = 1.0;
/// Binary nodes of the largest subtree planned as one task.
const TASK: usize = 1 << 13;
const _: () = assert!(MAX_LEAF_PACKETS <= Child::MAX_PACKETS);

/// How best to represent one binary subtree.
#[derive(Clone, Copy)]
struct Plan<const N: usize> {
    bounds: Bounds,
    /// As a single root.
    cost: f32,
    /// Twice the triangles' area; of a triangle with several references, each has a share.
    surface: f32,
    /// References below.
    count: u32,
    /// How many of at most `i` roots, for `i` in `2..N`, the left child gets; none: the plan is the
    /// one for `i - 1`, and for `i = 1` a single root.
    left_roots: [u8; N],
    /// For a single root: how many of its `N` slots the left child gets; none: it is a leaf.
    left_slots: u8,
}

impl<const N: usize> Plan<N> {
    const LEAF: Plan<N> = Plan {
        bounds: Bounds::EMPTY,
        cost: 0.0,
        surface: 0.0,
        count: 1,
        left_roots: [0; N],
        left_slots: 0,
    };
}

/// `cost[i]`, for `i` in `1..N`: of a subtree represented with at most `i` roots.
type Costs<const N: usize> = [f32; N];

/// The wide hierarchy over `references`, which the tree's leaves index.
pub(crate) fn collapse<const N: usize, const P: usize, L: LeafSize<P>>(
    tree: &BinaryTree,
    references: &[Reference],
    mesh: &Mesh<'_>,
) -> Bvh<N, P> {
    let mut bvh = Bvh {
        nodes: vec![WideNode::VACANT],
        packets: Vec::new(),
        sah_cost: 0.0,
    };
    if tree.nodes.is_empty() {
        return bvh;
    }
    let planner = Planner {
        tree,
        references,
        mesh,
        parts: &parts_of(references),
        root_area: bounds_of(references).half_area(),
    };
    let mut plans: Vec<Plan<N>> = vec![Plan::LEAF; tree.nodes.len()];
    planner.plan::<N, P, L>(0, &mut plans);
    // The probability that a ray which enters the root enters the node.
    let area = |node: u32| planner.relative_area(&plans[node as usize].bounds);

    let mut leaves = Leaves::default();
    // Wide nodes in preorder: (binary node, wide node). Parents come before their children.
    let mut pending = vec![(0u32, 0usize)];
    let mut cost = 0.0f64;
    while let Some((source, target)) = pending.pop() {
        let mut wide = WideNode::VACANT;
        cost += f64::from(area(source));
        let (mut slots, used) = slots_of(tree, &plans, source);
        // Any-hit queries take children in their order. They gain most by starting with those of
        // the greatest probability of a hit in the box for the cost of finding out.
        let urgency = |child: u32| plans[child as usize].surface / plans[child as usize].cost;
        slots[..used].sort_by(|&a, &b| urgency(b).total_cmp(&urgency(a)));
        for (slot, &child) in slots[..used].iter().enumerate() {
            let plan = &plans[child as usize];
            let stored = if plan.left_slots == 0 {
                let below = tree.references_below(child, plan.count);
                let leaf = leaves.push::<P>(&references[below]);
                let tests = PACKET_COST * leaf.packet_count() as f32;
                cost += f64::from(tests * area(child));
                leaf
            } else {
                bvh.nodes.push(WideNode::VACANT);
                pending.push((child, bvh.nodes.len() - 1));
                Child::node(bvh.nodes.len() - 1)
            };
            wide.set_child(slot, &plan.bounds, stored);
        }
        bvh.nodes[target] = wide;
    }
    bvh.sah_cost = cost as f32;
    bvh.packets = leaves
        .packets
        .par_iter()
        .map(|packet| packet_of(&leaves.prims[packet.clone()], mesh))
        .collect();
    check_nodes(&bvh.nodes, bvh.packets.len()).expect("the builder keeps the kernels' contract");
    bvh
}

struct Planner<'a> {
    tree: &'a BinaryTree,
    references: &'a [Reference],
    mesh: &'a Mesh<'a>,
    /// References of each triangle.
    parts: &'a [u32],
    root_area: f64,
}

impl Planner<'_> {
    /// Plans the subtree of `node`, whose nodes `plans` are. Returns its costs, and what is known of it as a leaf.
    fn plan<const N: usize, const P: usize, L: LeafSize<P>>(
        &self,
        node: u32,
        plans: &mut [Plan<N>],
    ) -> (Costs<N>, L) {
        let (plan, below) = plans.split_first_mut().expect("at least the node itself");
        let (left, right) = match self.tree.nodes[node as usize] {
            BinaryNode::Leaf(reference) => {
                let Reference { prim, bounds } = self.references[reference as usize];
                let corners = self.mesh.vertices(prim);
                let [a, b, c] = corners.map(Vec3::from);
                plan.bounds = bounds;
                plan.surface = (b - a).cross(c - a).length() / self.parts[prim as usize] as f32;
                plan.cost = PACKET_COST * self.relative_area(&plan.bounds);
                return ([plan.cost; N], L::of_triangle(&corners));
            }
            BinaryNode::Inner(left, right) => (left, right),
        };
        let parallel = below.len() > TASK;
        let (lefts, rights) = below.split_at_mut((right - left) as usize);
        let ((left_costs, left_size), (right_costs, right_size)) = if parallel {
            rayon::join(
                || self.plan::<N, P, L>(left, lefts),
                || self.plan::<N, P, L>(right, rights),
            )
        } else {
            (
                self.plan::<N, P, L>(left, lefts),
                self.plan::<N, P, L>(right, rights),
            )
        };
        plan.bounds = lefts[0].bounds.union(&rights[0].bounds);
        plan.surface = lefts[0].surface + rights[0].surface;
        let counts = [lefts[0].count, rights[0].count];
        let size = left_size.join(right_size);
        let costs = plan_inner::<N>(
            plan,
            counts,
            size.packets(),
            &left_costs,
            &right_costs,
            self.relative_area(&plan.bounds),
        );
        (costs, size)
    }

    fn relative_area(&self, bounds: &Bounds) -> f32 {
        (bounds.half_area() / self.root_area) as f32
    }
}

/// `packets` are those that the subtree takes as a leaf, if it may be one.
fn plan_inner<const N: usize>(
    plan: &mut Plan<N>,
    counts: [u32; 2],
    packets: Option<usize>,
    left: &Costs<N>,
    right: &Costs<N>,
    area: f32,
) -> Costs<N> {
    let count = counts[0].saturating_add(counts[1]);
    // No subtree has use for more roots than references.
    let most = counts.map(|count| (count as usize).min(N - 1));
    // The best distribution of `roots` among the children: its cost and the left child's share.
    let distribute = |roots: usize| {
        (roots.saturating_sub(most[1]).max(1)..=most[0].min(roots - 1))
            .map(|share| (left[share] + right[roots - share], share as u8))
            .fold((f32::INFINITY, 0), |best, next| {
                if next.0 < best.0 { next } else { best }
            })
    };
    let leaf_cost = packets.map_or(f32::INFINITY, |packets| PACKET_COST * packets as f32 * area);
    let (children_cost, left_slots) = distribute(N.min(most[0] + most[1]));
    let node_cost = area + children_cost;

    plan.count = count;
    plan.left_slots = left_slots;
    let mut costs = [node_cost; N];
    if leaf_cost <= node_cost {
        costs[1] = leaf_cost;
        plan.left_slots = 0;
    }
    plan.cost = costs[1];
    for roots in 2..N {
        costs[roots] = costs[roots - 1];
        if roots > most[0] + most[1] {
            continue;
        }
        let (cost, share) = distribute(roots);
        if cost < costs[roots] {
            costs[roots] = cost;
            plan.left_roots[roots] = share;
        }
    }
    costs
}

/// How many references each triangle has.
fn parts_of(references: &[Reference]) -> Vec<u32> {
    let last = references.iter().map(|reference| reference.prim).max();
    let mut parts = vec![0; last.map_or(0, |prim| prim as usize + 1)];
    for reference in references {
        parts[reference.prim as usize] += 1;
    }
    parts
}

/// The box around all references.
fn bounds_of(references: &[Reference]) -> Bounds {
    references
        .par_iter()
        .map(|reference| reference.bounds)
        .reduce(|| Bounds::EMPTY, |a, b| a.union(&b))
}

/// The binary nodes that become the children of the wide node made from `node`, and how many they are.
/// Only a root that holds everything in one leaf has itself as its child.
fn slots_of<const N: usize>(tree: &BinaryTree, plans: &[Plan<N>], node: u32) -> ([u32; N], usize) {
    let (mut slots, mut used) = ([node; N], 0);
    let share = plans[node as usize].left_slots as usize;
    let (BinaryNode::Inner(left, right), 1..) = (tree.nodes[node as usize], share) else {
        return (slots, 1);
    };
    let mut pending = vec![(right, N - share), (left, share)];
    while let Some((node, roots)) = pending.pop() {
        let plan = &plans[node as usize];
        let share = (2..=roots)
            .rev()
            .map(|i| (i, plan.left_roots[i]))
            .find(|&(_, left)| left != 0);
        match (tree.nodes[node as usize], share) {
            (BinaryNode::Inner(left, right), Some((roots, share))) => {
                pending.push((right, roots - share as usize));
                pending.push((left, share as usize));
            }
            _ => {
                slots[used] = node;
                used += 1;
            }
        }
    }
    (slots, used)
}

/// The triangles of all leaves, and which of them make a packet.
#[derive(Default)]
struct Leaves {
    prims: Vec<u32>,
    packets: Vec<Range<usize>>,
}

impl Leaves {
    /// Adds a leaf that holds each of the triangles once.
    fn push<const P: usize>(&mut self, references: &[Reference]) -> Child {
        let first = self.prims.len();
        self.prims
            .extend(references.iter().map(|reference| reference.prim));
        self.prims[first..].sort_unstable();
        let mut last = first;
        for next in first + 1..self.prims.len() {
            if self.prims[next] != self.prims[last] {
                last += 1;
                self.prims[last] = self.prims[next];
            }
        }
        self.prims.truncate(last + 1);
        let first_packet = self.packets.len();
        for start in (first..=last).step_by(P) {
            self.packets.push(start..(start + P).min(last + 1));
        }
        Child::leaf(first_packet, self.packets.len() - first_packet)
    }
}

fn packet_of<const P: usize>(prims: &[u32], mesh: &Mesh<'_>) -> TrianglePacket<P> {
    let mut packet = TrianglePacket::VACANT;
    for (lane, &prim) in prims.iter().enumerate() {
        packet.set_corners(lane, mesh.vertices(prim));
        let mark = if mesh.is_single_sided(prim) {
            SINGLE_SIDED
        } else {
            0
        };
        packet.prim_ids[lane] = prim | mark;
    }
    packet
}
