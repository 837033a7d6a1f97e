//! The most careful build: obvhs' clustering (PLOC), then reinsertion of single references until
//! it gains nothing more.
//!
//! D. Meister, J. Bittner, "Parallel Locally-Ordered Clustering for Bounding Volume Hierarchy
//! Construction", TVCG 24(3), 2018, and "Parallel Reinsertion for Bounding Volume Hierarchy
//! Optimization", Eurographics 2018.

use std::ops::Range;

use glam::Vec3A;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use rayon::prelude::*;

use crate::bounds::Bounds;
use crate::build::balance::limit_depth;
use crate::build::binary::{BinaryNode, BinaryTree, push_preorder};
use crate::build::mesh::Mesh;
use crate::build::presplit::split_references;
use crate::build::reference::Reference;

/// A tree over references to the triangles `prims`: obvhs' preset `very_slow_build`, with one
/// reference for each leaf, since forming larger leaves is the collapse's business.
pub(crate) fn build_tree(mesh: &Mesh<'_>, prims: &[u32]) -> (BinaryTree, Vec<Reference>) {
    if prims.is_empty() {
        return (BinaryTree { nodes: Vec::new() }, Vec::new());
    }
    let references = split_references(mesh, prims);
    let boxes = unit_boxes(&references);
    let (order, groups) = group_alike(&boxes);
    let unlike: Vec<Aabb> = groups
        .iter()
        .map(|group| {
            order[group.clone()]
                .iter()
                .fold(Aabb::empty(), |all, &index| {
                    all.union(&boxes[index as usize])
                })
        })
        .collect();
    let indices = (0..unlike.len() as u32).collect();
    let mut bvh2 = PlocBuilder::new().build(
        PlocSearchDistance::Medium,
        &unlike,
        indices,
        SortPrecision::U128,
        1,
    );
    reinsert(&mut bvh2, 1.0);

    let mut nodes = Vec::with_capacity(2 * references.len());
    let mut ordered = Vec::with_capacity(references.len());
    let mut pending = vec![(Source::WideNode(0), None)];
    while let Some((source, parent)) = pending.pop() {
        let source = match source {
            Source::WideNode(index) if bvh2.nodes[index as usize].is_leaf() => {
                let first = bvh2.nodes[index as usize].first_index as usize;
                Source::Group(groups[bvh2.primitive_indices[first] as usize].clone())
            }
            source => source,
        };
        let leaf = BinaryNode::Leaf(ordered.len() as u32);
        let index = push_preorder(&mut nodes, leaf, parent);
        let (left, right) = match source {
            Source::Group(Range { start, end }) if end - start == 1 => {
                ordered.push(references[order[start] as usize]);
                continue;
            }
            Source::Group(Range { start, end }) => {
                let middle = start.midpoint(end);
                (Source::Group(start..middle), Source::Group(middle..end))
            }
            Source::WideNode(index) => {
                let first = bvh2.nodes[index as usize].first_index;
                (Source::WideNode(first), Source::WideNode(first + 1))
            }
        };
        pending.push((right, Some(index)));
        pending.push((left, None));
    }
    (limit_depth(BinaryTree { nodes }), ordered)
}

/// Where a node of the binary tree comes from.
enum Source {
    /// A node of obvhs' tree.
    WideNode(u32),
    /// References with boxes that are alike, a range of their order.
    Group(Range<usize>),
}

/// The boxes' indices, ordered so that boxes that are alike are neighbours, and the ranges of these.
/// Boxes are alike if they are equal on a grid of [`ALIKE`] of their largest extent.
///
/// obvhs gets one box for each range: PLOC merges mutual nearest neighbours. Among more equal boxes
/// than its search distance it finds none and never ends, and in a stack of nearly equal ones, whose
/// unions round to few different areas, it finds only a few in each pass over all of them.
fn group_alike(boxes: &[Aabb]) -> (Vec<u32>, Vec<Range<usize>>) {
    let keys: Vec<_> = boxes.par_iter().map(grid_corners).collect();
    let key = |index: u32| &keys[index as usize];
    let exact = |index: u32| {
        let bounds = &boxes[index as usize];
        (
            bounds.min.to_array().map(f32::to_bits),
            bounds.max.to_array().map(f32::to_bits),
        )
    };
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    order.par_sort_unstable_by(|&a, &b| {
        key(a)
            .cmp(key(b))
            .then_with(|| exact(a).cmp(&exact(b)))
            .then(a.cmp(&b))
    });
    let mut groups = Vec::new();
    let mut start = 0;
    for alike in order.chunk_by(|&a, &b| key(a) == key(b)) {
        groups.push(start..start + alike.len());
        start += alike.len();
    }
    (order, groups)
}

/// Too little for the surface area heuristic to tell the boxes apart.
const ALIKE: f32 = 1.0 / 8192.0;

/// The grid's spacing and the box's corners on it, as bits.
fn grid_corners(bounds: &Aabb) -> [u64; 7] {
    let extent = (bounds.max - bounds.min).max_element();
    // A power of two, so that boxes of about the same size share a grid.
    let exponent = f32::from_bits(extent.to_bits() & f32::INFINITY.to_bits());
    let spacing = f64::from(exponent.max(f32::MIN_POSITIVE)) * f64::from(ALIKE);
    let [min, max] = [bounds.min, bounds.max].map(|corner| {
        // Adding zero makes one zero of both.
        corner
            .to_array()
            .map(|x| ((f64::from(x) / spacing).floor() + 0.0).to_bits())
    });
    [
        spacing.to_bits(),
        min[0],
        min[1],
        min[2],
        max[0],
        max[1],
        max[2],
    ]
}

/// obvhs' default sequence of reinsertions, the ratio of nodes considered shrinking with each.
///
/// One at a time, because obvhs searches with a stack of twice `max_depth`, which reinsertion does
/// not keep up to date, and panics if that overflows. A tree that is already a list is left alone.
fn reinsert(bvh2: &mut Bvh2, batch_ratio: f32) {
    const HOPELESS_DEPTH: usize = 1000;
    let mut optimizer = ReinsertionOptimizer::default();
    for divisor in (1..32).step_by(2) {
        let depth = depth(bvh2);
        if depth > HOPELESS_DEPTH {
            return;
        }
        bvh2.max_depth = bvh2.max_depth.max(depth);
        optimizer.run(bvh2, batch_ratio, Some(vec![1.0 / divisor as f32]));
    }
}

fn depth(bvh2: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut pending = vec![(0u32, 1usize)];
    while let Some((index, level)) = pending.pop() {
        deepest = deepest.max(level);
        let node = &bvh2.nodes[index as usize];
        if !node.is_leaf() {
            pending.extend([
                (node.first_index, level + 1),
                (node.first_index + 1, level + 1),
            ]);
        }
    }
    deepest
}

/// The references' boxes, moved and scaled into the unit cube if their areas could otherwise
/// overflow or vanish. They only guide the topology.
fn unit_boxes(references: &[Reference]) -> Vec<Aabb> {
    let finite = |x: f32| x.clamp(f32::MIN, f32::MAX) as f64;
    let all = references
        .iter()
        .fold(Bounds::EMPTY, |all, r| all.union(&r.bounds));
    let extent = (0..3).fold(0.0, |extent, axis| {
        finite(all.hi[axis]).max(-finite(all.lo[axis])).max(extent)
    });
    let (scale, offset) = if (1e-6..1e15).contains(&extent) {
        (1.0, [0.0; 3])
    } else {
        let size = (0..3).fold(0.0, |size: f64, axis| {
            size.max(finite(all.hi[axis]) - finite(all.lo[axis]))
        });
        (1.0 / size, all.lo.map(finite))
    };
    let place = |point: [f32; 3]| {
        let moved = [0, 1, 2].map(|axis| ((finite(point[axis]) - offset[axis]) * scale) as f32);
        Vec3A::from_array(moved)
    };
    references
        .iter()
        .map(|r| Aabb::new(place(r.bounds.lo), place(r.bounds.hi)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square_at(z: f32) -> Aabb {
        Aabb::new(Vec3A::new(-1.0, -1.0, z), Vec3A::new(1.0, 1.0, z))
    }

    #[test]
    fn a_dense_stack_is_few_boxes_in_its_own_order() {
        let boxes: Vec<Aabb> = (0..10_000).map(|i| square_at(i as f32 * 1e-8)).collect();
        let (order, groups) = group_alike(&boxes);
        assert!(groups.len() <= 2, "{} groups", groups.len());
        assert_eq!(order, (0..10_000).collect::<Vec<_>>());
    }

    #[test]
    fn boxes_that_differ_are_not_grouped() {
        let mut boxes: Vec<Aabb> = (0..1000).map(|i| square_at(i as f32 * 1e-3)).collect();
        // The same corner, and half the size.
        boxes.push(Aabb::new(boxes[0].min, Vec3A::ZERO));
        assert_eq!(group_alike(&boxes).1.len(), boxes.len());
    }

    #[test]
    fn every_box_is_in_one_group() {
        let spread = |i: u32| (i.wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 24) as f32;
        let boxes: Vec<Aabb> = (0..3000)
            .map(|i| square_at(spread(i) * 1e-3 - 5e-4))
            .collect();
        let (mut order, groups) = group_alike(&boxes);
        let ends: Vec<usize> = groups.iter().map(|group| group.end).collect();
        let starts: Vec<usize> = groups.iter().map(|group| group.start).collect();
        assert_eq!(starts[0], 0);
        assert_eq!(starts[1..], ends[..ends.len() - 1]);
        assert_eq!(ends.last(), Some(&boxes.len()));
        order.sort_unstable();
        assert_eq!(order, (0..3000).collect::<Vec<_>>());
    }
}
