//! The tree built from the top by the surface area heuristic, with splits of objects and of space,
//! by as many threads as there are.
//!
//! M. Stich, H. Friedrich, A. Dietrich, "Spatial Splits in Bounding Volume Hierarchies", HPG 2009.
//! Each triangle may be split a number of times that is fixed beforehand. So every node knows how
//! many slots its subtree can need, and nothing depends on which thread is first.

use std::sync::atomic::{AtomicUsize, Ordering};

use glam::Vec3A;
use rayon::prelude::*;

use crate::bounds::Bounds;
use crate::build::balance::levels_needed;
use crate::build::binary::{BinaryNode, BinaryTree};
use crate::build::binning::{MAX_SORTED, best_object_split, object_grid, sort_for_best_split};
use crate::build::fragment::{Box3, Fragment, Summary};
use crate::build::mesh::Mesh;
use crate::build::partition::{Placement, make_room, partition};
use crate::build::reference::Reference;
use crate::build::spatial::{best_spatial_split, placement, spatial_grid};
use crate::layout::validate::MAX_DEPTH;

/// Slots of the largest subtree built as one task.
const TASK: usize = 1 << 12;
/// Overlap of an object split's children, relative to the root's area, from which on splits of
/// space are tried.
const MIN_OVERLAP: f32 = 1e-3;
/// Splits allowed for each triangle on average.
const SPLIT_BUDGET: f64 = 0.5;
/// Splits allowed for one triangle.
const MAX_SPLITS: f64 = 255.0;

/// Whether splits of space are allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Splits {
    Objects,
    ObjectsAndSpace,
}

struct Builder<'a> {
    mesh: Mesh<'a>,
    min_overlap: f32,
    /// Fragments of all subtrees that are done, at most `total` and those that splits have added.
    done: AtomicUsize,
    total: usize,
    report: &'a (dyn Fn(f32) + Sync),
}

/// A subtree in preorder whose references have ascending indices from left to right.
enum Subtree {
    Inner(Box<(Subtree, Subtree)>),
    Chunk(BinaryTree, Vec<Fragment>),
}

/// A tree over the triangles `prims`, and its references from left to right.
pub(crate) fn build_tree(
    mesh: &Mesh<'_>,
    prims: &[u32],
    splits: Splits,
    report: &(dyn Fn(f32) + Sync),
) -> (BinaryTree, Vec<Reference>) {
    if prims.is_empty() {
        return (BinaryTree { nodes: Vec::new() }, Vec::new());
    }
    let guide = Guide::new(mesh, prims);
    let splits = if guide.is_exact() {
        splits
    } else {
        Splits::Objects
    };
    let boxes = |&prim: &u32| guide.bounds(mesh, prim);
    let credits_per_weight = match splits {
        Splits::Objects => 0.0,
        Splits::ObjectsAndSpace => {
            // Summed in chunks, whose order is fixed.
            let sums: Vec<f64> = prims
                .par_chunks(1 << 14)
                .map(|prims| {
                    prims
                        .iter()
                        .map(|prim| splitting_weight(mesh, *prim, &boxes(prim)))
                        .sum()
                })
                .collect();
            let total: f64 = sums.iter().sum();
            if total > 0.0 {
                SPLIT_BUDGET * prims.len() as f64 / total
            } else {
                0.0
            }
        }
    };
    let mut slots: Vec<Fragment> = prims
        .par_iter()
        .map(|prim| {
            let bounds = boxes(prim);
            let credits =
                (splitting_weight(mesh, *prim, &bounds) * credits_per_weight).min(MAX_SPLITS);
            Fragment::new(*prim, &bounds, credits as u32)
        })
        .collect();
    let summary = slots
        .par_chunks(1 << 14)
        .map(Summary::of)
        .reduce(|| Summary::EMPTY, |a, b| a.merge(&b));
    slots.resize(summary.slots(), slots[0]);

    let builder = Builder {
        mesh: *mesh,
        min_overlap: MIN_OVERLAP * summary.bounds.half_area(),
        done: AtomicUsize::new(0),
        total: summary.count,
        report,
    };
    let subtree = builder.subtree(&mut slots, &summary, 0);
    drop(slots);
    flatten(subtree, mesh, &guide)
}

/// How much a triangle gains by being split: what the half area of its box exceeds that of a box
/// around a parallelogram in a plane along the axes. Splitting the walls of a room costs more than
/// it gains.
fn splitting_weight(mesh: &Mesh<'_>, prim: u32, bounds: &Box3) -> f64 {
    let [a, b, c] = mesh.vertices(prim).map(Vec3A::from_array);
    let parallelogram = (b - a).cross(c - a).length();
    f64::from((bounds.half_area() - parallelogram).max(0.0)).sqrt()
}

impl Builder<'_> {
    fn subtree(&self, slots: &mut [Fragment], summary: &Summary, level: usize) -> Subtree {
        if summary.slots() <= TASK {
            let mut tree = BinaryTree {
                nodes: Vec::with_capacity(2 * summary.count),
            };
            let mut fragments = Vec::with_capacity(summary.slots());
            self.append(slots, summary, level, &mut tree, &mut fragments);
            let done = fragments.len() + self.done.fetch_add(fragments.len(), Ordering::Relaxed);
            (self.report)((done as f32 / self.total as f32).min(1.0));
            return Subtree::Chunk(tree, fragments);
        }
        let (left, right) = self.split(slots, summary, level);
        let (lefts, rights) = slots.split_at_mut(left.slots());
        let children = rayon::join(
            || self.subtree(lefts, &left, level + 1),
            || self.subtree(rights, &right, level + 1),
        );
        Subtree::Inner(Box::new(children))
    }

    fn append(
        &self,
        slots: &mut [Fragment],
        summary: &Summary,
        level: usize,
        tree: &mut BinaryTree,
        fragments: &mut Vec<Fragment>,
    ) {
        if summary.count == 1 {
            tree.nodes.push(BinaryNode::Leaf(fragments.len() as u32));
            fragments.push(slots[0]);
            return;
        }
        let (left, right) = self.split(slots, summary, level);
        let (lefts, rights) = slots.split_at_mut(left.slots());
        let node = tree.nodes.len();
        tree.nodes.push(BinaryNode::Leaf(0));
        self.append(lefts, &left, level + 1, tree, fragments);
        tree.nodes[node] = BinaryNode::Inner(node as u32 + 1, tree.nodes.len() as u32);
        self.append(rights, &right, level + 1, tree, fragments);
    }

    /// Divides the fragments in two, arranged as [`partition`] does.
    fn split(&self, slots: &mut [Fragment], summary: &Summary, level: usize) -> (Summary, Summary) {
        let count = summary.count;
        // Below this level only balanced trees are sure to keep within the depth.
        if level + 1 + levels_needed(summary.slots()) > MAX_DEPTH {
            return halves(slots, count);
        }
        if count <= MAX_SORTED {
            let middle = sort_for_best_split(&mut slots[..count]);
            return divide(slots, count, middle);
        }
        let grid = object_grid(summary);
        let object = best_object_split(&slots[..count], &grid);
        if summary.credits > 0 {
            let overlap = object.map_or(f32::INFINITY, |split| {
                let overlap = split.left.bounds.intersection(&split.right.bounds);
                if overlap.is_empty() {
                    0.0
                } else {
                    overlap.half_area()
                }
            });
            if overlap > self.min_overlap {
                let grid = spatial_grid(summary);
                let spatial = best_spatial_split(&self.mesh, &slots[..count], &grid);
                let limit = object.map_or(f32::INFINITY, |split| split.cost);
                if let Some(split) = spatial.filter(|split| split.cost < limit) {
                    let (left, right) = partition(slots, count, |fragment| {
                        placement(&self.mesh, &grid, &split, fragment)
                    });
                    if left.count > 0 && right.count > 0 {
                        return (left, right);
                    }
                }
            }
        }
        match object {
            Some(split) => partition(slots, count, |fragment| {
                if grid.object_bins(fragment)[split.axis] < split.bin {
                    Placement::Left
                } else {
                    Placement::Right
                }
            }),
            None => halves(slots, count),
        }
    }
}

/// The first half of the fragments as they lie, and the others.
fn halves(slots: &mut [Fragment], count: usize) -> (Summary, Summary) {
    divide(slots, count, count / 2)
}

fn divide(slots: &mut [Fragment], count: usize, middle: usize) -> (Summary, Summary) {
    let left = Summary::of(&slots[..middle]);
    let right = Summary::of(&slots[middle..count]);
    make_room(slots, &left, &right);
    (left, right)
}

/// The subtrees one after another.
fn flatten(subtree: Subtree, mesh: &Mesh<'_>, guide: &Guide) -> (BinaryTree, Vec<Reference>) {
    let mut nodes = Vec::new();
    let mut fragments = Vec::new();
    append_subtree(subtree, &mut nodes, &mut fragments);
    let references = fragments
        .par_iter()
        .map(|fragment| reference(fragment, mesh, guide))
        .collect();
    (BinaryTree { nodes }, references)
}

fn append_subtree(subtree: Subtree, nodes: &mut Vec<BinaryNode>, fragments: &mut Vec<Fragment>) {
    let first = nodes.len() as u32;
    match subtree {
        Subtree::Chunk(tree, new) => {
            let first_fragment = fragments.len() as u32;
            nodes.extend(tree.nodes.iter().map(|node| match *node {
                BinaryNode::Leaf(fragment) => BinaryNode::Leaf(first_fragment + fragment),
                BinaryNode::Inner(left, right) => BinaryNode::Inner(first + left, first + right),
            }));
            fragments.extend(new);
        }
        Subtree::Inner(children) => {
            let (left, right) = *children;
            nodes.push(BinaryNode::Leaf(0));
            append_subtree(left, nodes, fragments);
            nodes[first as usize] = BinaryNode::Inner(first + 1, nodes.len() as u32);
            append_subtree(right, nodes, fragments);
        }
    }
}

/// The padded box. A part is padded twice as much, for its clipping may have rounded, but not
/// beyond the box of the whole triangle.
fn reference(fragment: &Fragment, mesh: &Mesh<'_>, guide: &Guide) -> Reference {
    let prim = fragment.prim();
    let whole = Bounds::of_triangle(&mesh.vertices(prim));
    let extent = whole.extent();
    let mut bounds = whole.padded(extent);
    if guide.is_exact() {
        let part = fragment.bounds();
        let part = Bounds {
            lo: part.lo.into(),
            hi: part.hi.into(),
        }
        .padded(2.0 * extent);
        bounds = Bounds {
            lo: [0, 1, 2].map(|axis| bounds.lo[axis].max(part.lo[axis])),
            hi: [0, 1, 2].map(|axis| bounds.hi[axis].min(part.hi[axis])),
        };
    }
    Reference { prim, bounds }
}

/// Maps the scene's coordinates to ones whose areas neither overflow nor vanish.
struct Guide {
    origin: [f64; 3],
    /// One if the coordinates are good as they are.
    scale: f64,
}

impl Guide {
    fn new(mesh: &Mesh<'_>, prims: &[u32]) -> Guide {
        let all = prims
            .par_iter()
            .map(|&prim| Bounds::of_triangle(&mesh.vertices(prim)))
            .reduce(|| Bounds::EMPTY, |a, b| a.union(&b));
        let largest = (0..3).fold(0.0, |x: f32, axis| x.max(all.hi[axis]).max(-all.lo[axis]));
        if (1e-6..1e12).contains(&largest) {
            return Guide {
                origin: [0.0; 3],
                scale: 1.0,
            };
        }
        let size = |axis| f64::from(all.hi[axis]) - f64::from(all.lo[axis]);
        Guide {
            origin: all.lo.map(f64::from),
            scale: 1.0 / size(0).max(size(1)).max(size(2)),
        }
    }

    fn is_exact(&self) -> bool {
        self.scale == 1.0
    }

    fn bounds(&self, mesh: &Mesh<'_>, prim: u32) -> Box3 {
        let bounds = Bounds::of_triangle(&mesh.vertices(prim));
        let place = |point: [f32; 3]| -> Vec3A {
            if self.is_exact() {
                return point.into();
            }
            Vec3A::from_array(std::array::from_fn(|axis| {
                ((f64::from(point[axis]) - self.origin[axis]) * self.scale) as f32
            }))
        };
        Box3 {
            lo: place(bounds.lo),
            hi: place(bounds.hi),
        }
    }
}
