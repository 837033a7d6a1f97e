//! The binary tree collapsed into `N`-wide nodes and leaves of triangle packets, at the least cost
//! under the surface area heuristic.
//!
//! The dynamic programme is that of H. Ylitie, T. Karras, S. Laine, "Efficient Incoherent Ray
//! Traversal on GPUs Through Compressed Wide BVHs", HPG 2017, section 3.1: bottom-up, for every
//! binary node and every `i < N`, the least cost of representing its subtree by at most `i` wide
//! nodes or leaves.

use glam::Vec3;

use crate::Bvh;
use crate::binary::{BinaryNode, BinaryTree};
use crate::build::{Mesh, Reference};
use crate::bvh::{Child, Node, SINGLE_SIDED, TrianglePacket};
use crate::validate::check_structure;

/// Cost of testing a ray against a packet, in units of testing it against a node.
const PACKET_COST: f32 = 1.0;
/// Packets in the largest leaf considered.
const MAX_LEAF_PACKETS: usize = 4;
const _: () = assert!(MAX_LEAF_PACKETS <= Child::MAX_PACKETS);

/// How best to represent one binary subtree.
#[derive(Clone, Copy)]
struct Plan<const N: usize> {
    /// `cost[i]`, for `i` in `1..N`: with at most `i` roots.
    cost: [f32; N],
    /// How many of those roots the left child gets; none: the plan is the one for `i - 1`, and for
    /// `i = 1` a single root.
    left_roots: [u8; N],
    /// For a single root: how many of its `N` slots the left child gets; none: it is a leaf.
    left_slots: u8,
    /// References below.
    count: u32,
}

/// The wide hierarchy over `references`, which the tree's leaves index.
pub(crate) fn collapse<const N: usize, const P: usize>(
    tree: &BinaryTree,
    references: &[Reference],
    mesh: &Mesh<'_>,
) -> Bvh<N, P> {
    let mut bvh = Bvh {
        nodes: vec![Node::VACANT],
        packets: Vec::new(),
        sah_cost: 0.0,
    };
    if tree.nodes.is_empty() {
        return bvh;
    }
    let bounds = tree.bounds(references);
    let root_area = bounds[0].half_area();
    // The probability that a ray which enters the root enters the node.
    let areas: Vec<f32> = bounds
        .iter()
        .map(|bounds| (bounds.half_area() / root_area) as f32)
        .collect();
    let plans: Vec<Plan<N>> = plan::<N, P>(tree, &areas);

    let surfaces = surfaces(tree, references, mesh);
    // What an any-hit query, which takes children in their order, gains by starting with a child:
    // the probability of a hit in its box over the cost of finding out.
    let urgency = |child: u32| {
        let child = child as usize;
        surfaces[child] / plans[child].cost[1]
    };

    // Wide nodes in preorder: (binary node, wide node). Parents come before their children.
    let mut pending = vec![(0u32, 0usize)];
    let mut cost = 0.0f64;
    while let Some((source, target)) = pending.pop() {
        let mut wide = Node::VACANT;
        cost += f64::from(areas[source as usize]);
        let mut slots = slots_of(tree, &plans, source);
        slots.sort_by(|&a, &b| urgency(b).total_cmp(&urgency(a)));
        for (slot, child) in slots.into_iter().enumerate() {
            let stored = if plans[child as usize].left_slots == 0 {
                let leaf = push_leaf(&mut bvh.packets, tree, child, references, mesh);
                let tests = PACKET_COST * leaf.packet_count() as f32;
                cost += f64::from(tests * areas[child as usize]);
                leaf
            } else {
                bvh.nodes.push(Node::VACANT);
                pending.push((child, bvh.nodes.len() - 1));
                Child::node(bvh.nodes.len() - 1)
            };
            wide.set_child(slot, &bounds[child as usize], stored);
        }
        bvh.nodes[target] = wide;
    }
    bvh.sah_cost = cost as f32;
    check_structure(&bvh.nodes, &bvh.packets).expect("the builder keeps the kernels' contract");
    bvh
}

/// Twice the triangles' area below each node; of a triangle with several references, each has a
/// share.
fn surfaces(tree: &BinaryTree, references: &[Reference], mesh: &Mesh<'_>) -> Vec<f32> {
    let last = references.iter().map(|reference| reference.prim).max();
    let mut parts = vec![0.0f32; last.map_or(0, |prim| prim as usize + 1)];
    for reference in references {
        parts[reference.prim as usize] += 1.0;
    }
    let share = |reference: u32| {
        let prim = references[reference as usize].prim;
        let [a, b, c] = mesh.vertices(prim).map(Vec3::from);
        (b - a).cross(c - a).length() / parts[prim as usize]
    };
    tree.bottom_up(share, |left, right| left + right)
}

fn plan<const N: usize, const P: usize>(tree: &BinaryTree, areas: &[f32]) -> Vec<Plan<N>> {
    let unplanned = Plan {
        cost: [0.0; N],
        left_roots: [0; N],
        left_slots: 0,
        count: 1,
    };
    let mut plans = vec![unplanned; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        plans[index] = match *node {
            BinaryNode::Leaf(_) => Plan {
                cost: [PACKET_COST * areas[index]; N],
                ..unplanned
            },
            BinaryNode::Inner(left, right) => {
                plan_inner::<N, P>(&plans[left as usize], &plans[right as usize], areas[index])
            }
        };
    }
    plans
}

fn plan_inner<const N: usize, const P: usize>(
    left: &Plan<N>,
    right: &Plan<N>,
    area: f32,
) -> Plan<N> {
    // The best distribution of `roots` among the children: its cost and the left child's share.
    let distribute = |roots: usize| {
        (1..roots)
            .map(|share| (left.cost[share] + right.cost[roots - share], share as u8))
            .fold((f32::INFINITY, 0), |best, next| {
                if next.0 < best.0 { next } else { best }
            })
    };
    let count = left.count.saturating_add(right.count);
    let packets = (count as usize).div_ceil(P);
    let leaf_cost = if packets <= MAX_LEAF_PACKETS {
        PACKET_COST * packets as f32 * area
    } else {
        f32::INFINITY
    };
    let (children_cost, left_slots) = distribute(N);
    let node_cost = area + children_cost;

    let mut plan = Plan {
        cost: [0.0; N],
        left_roots: [0; N],
        left_slots,
        count,
    };
    plan.cost[1] = node_cost;
    if leaf_cost <= node_cost {
        plan.cost[1] = leaf_cost;
        plan.left_slots = 0;
    }
    for roots in 2..N {
        let (cost, share) = distribute(roots);
        plan.cost[roots] = plan.cost[roots - 1];
        if cost < plan.cost[roots] {
            plan.cost[roots] = cost;
            plan.left_roots[roots] = share;
        }
    }
    plan
}

/// The binary nodes that become the children of the wide node made from `node`. Only a root that
/// holds everything in one leaf has itself as its child.
fn slots_of<const N: usize>(tree: &BinaryTree, plans: &[Plan<N>], node: u32) -> Vec<u32> {
    let share = plans[node as usize].left_slots as usize;
    let (BinaryNode::Inner(left, right), 1..) = (tree.nodes[node as usize], share) else {
        return vec![node];
    };
    let mut slots = Vec::with_capacity(N);
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
            _ => slots.push(node),
        }
    }
    slots
}

/// Writes the triangles below a binary node, each once, and returns the leaf that holds them.
fn push_leaf<const P: usize>(
    packets: &mut Vec<TrianglePacket<P>>,
    tree: &BinaryTree,
    node: u32,
    references: &[Reference],
    mesh: &Mesh<'_>,
) -> Child {
    let mut prims: Vec<u32> = tree
        .references_below(node)
        .into_iter()
        .map(|reference| references[reference as usize].prim)
        .collect();
    prims.sort_unstable();
    prims.dedup();
    let first = packets.len();
    packets.extend(prims.chunks(P).map(|prims| packet_of(prims, mesh)));
    Child::leaf(first, packets.len() - first)
}

fn packet_of<const P: usize>(prims: &[u32], mesh: &Mesh<'_>) -> TrianglePacket<P> {
    let mut packet = TrianglePacket::VACANT;
    for (lane, &prim) in prims.iter().enumerate() {
        for (rows, vertex) in packet.vertices.iter_mut().zip(mesh.vertices(prim)) {
            for (row, coordinate) in rows.iter_mut().zip(vertex) {
                row[lane] = coordinate;
            }
        }
        let mark = if mesh.is_single_sided(prim) {
            SINGLE_SIDED
        } else {
            0
        };
        packet.prim_ids[lane] = prim | mark;
    }
    packet
}
