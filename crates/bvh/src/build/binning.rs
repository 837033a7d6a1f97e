//! Splits between whole fragments, by the surface area heuristic over bins of their centres
//! (I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", RT 2007) and of their
//! sizes, and for few fragments over all their orders.
//!
//! Bins of sizes set the walls of a room apart from what is in it: no plane does, and the walls
//! would enlarge nodes at every level.

use glam::Vec3A;
use rayon::prelude::*;

use crate::build::fragment::{Box3, Fragment, Summary};

/// The axes of space, and the axis of sizes.
const AXES: usize = 4;
const SIZE: usize = 3;
pub(crate) const MAX_BINS: usize = 32;
/// Fragments for each task where one node's fragments are shared among threads. Fixed, so that the
/// result does not depend on the threads.
pub(crate) const CHUNK: usize = 1 << 14;
/// Up to so many fragments are sorted instead of binned.
pub(crate) const MAX_SORTED: usize = 16;

/// Equal bins on each axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    origin: Vec3A,
    scale: Vec3A,
    last: f32,
    pub(crate) bins: usize,
    /// Bits of the node's half area, zero to leave out the axis of sizes.
    area: u32,
}

impl Grid {
    pub(crate) fn new(bounds: &Box3, bins: usize) -> Grid {
        let scale = bounds.size().to_array().map(|size| {
            let scale = bins as f32 / size;
            if scale.is_finite() { scale } else { 0.0 }
        });
        Grid {
            origin: bounds.lo,
            scale: Vec3A::from_array(scale),
            last: (bins - 1) as f32,
            bins,
            area: 0,
        }
    }

    /// The point's bin on each axis: a monotone function of the coordinate.
    #[inline(always)]
    pub(crate) fn bins_of(&self, point: Vec3A) -> [usize; 3] {
        // Adding 2²³ rounds to an integer and leaves it in the low bits.
        const ROUND: f32 = (1 << 23) as f32;
        let bin = (point - self.origin) * self.scale - Vec3A::splat(0.5);
        let bin = bin.max(Vec3A::ZERO).min(Vec3A::splat(self.last));
        let [x, y, z] = (bin + Vec3A::splat(ROUND)).to_array();
        let low = |x: f32| x.to_bits() as usize % MAX_BINS;
        [low(x), low(y), low(z)]
    }

    /// The fragment's bin by its centre on each axis, and by its area relative to the node's: two
    /// bins an octave, from the largest on.
    #[inline(always)]
    pub(crate) fn object_bins(&self, fragment: &Fragment) -> [usize; AXES] {
        let [x, y, z] = self.bins_of(fragment.center());
        let smaller = self
            .area
            .saturating_sub(fragment.bounds().half_area().to_bits());
        let size = (smaller >> 22) as usize;
        [x, y, z, size.min(self.bins - 1)]
    }

    /// The plane between bins `bin - 1` and `bin`.
    pub(crate) fn plane(&self, axis: usize, bin: usize) -> f32 {
        self.origin[axis] + bin as f32 / self.scale[axis]
    }

    pub(crate) fn has_extent(&self, axis: usize) -> bool {
        if axis == SIZE {
            self.area != 0
        } else {
            self.scale[axis] > 0.0
        }
    }
}

/// A way to divide a node's fragments between two children.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Candidate {
    /// Sum over both children of half area times count.
    pub(crate) cost: f32,
    pub(crate) axis: usize,
    /// First bin of the right child, greater than zero.
    pub(crate) bin: usize,
    pub(crate) left: Side,
    pub(crate) right: Side,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    pub(crate) bounds: Box3,
    pub(crate) count: u32,
}

impl Side {
    const EMPTY: Side = Side {
        bounds: Box3::EMPTY,
        count: 0,
    };

    pub(crate) fn cost(&self) -> f32 {
        self.bounds.half_area() * self.count as f32
    }
}

/// Boxes and counts for every axis and bin. `starts` and `ends` are alike for object splits.
#[derive(Clone)]
pub(crate) struct Bins {
    pub(crate) bounds: [[Box3; MAX_BINS]; AXES],
    /// Fragments that count to the left of every plane after the bin.
    pub(crate) starts: [[u32; MAX_BINS]; AXES],
    /// Fragments that count to the right of every plane before the bin.
    pub(crate) ends: [[u32; MAX_BINS]; AXES],
}

impl Bins {
    pub(crate) const EMPTY: Bins = Bins {
        bounds: [[Box3::EMPTY; MAX_BINS]; AXES],
        starts: [[0; MAX_BINS]; AXES],
        ends: [[0; MAX_BINS]; AXES],
    };

    pub(crate) fn merge(mut self, other: &Bins, bins: usize) -> Bins {
        for axis in 0..AXES {
            for bin in 0..bins {
                let bounds = &other.bounds[axis][bin];
                self.bounds[axis][bin].grow(bounds.lo, bounds.hi);
                self.starts[axis][bin] += other.starts[axis][bin];
                self.ends[axis][bin] += other.ends[axis][bin];
            }
        }
        self
    }

    /// The plane of the least cost, if any leaves something on both sides.
    pub(crate) fn best(&self, grid: &Grid) -> Option<Candidate> {
        let mut best: Option<Candidate> = None;
        for axis in (0..AXES).filter(|&axis| grid.has_extent(axis)) {
            let mut rights = [Side::EMPTY; MAX_BINS];
            let mut costs = [0.0; MAX_BINS];
            let mut right = Side::EMPTY;
            for bin in (1..grid.bins).rev() {
                right.bounds = right.bounds.union(&self.bounds[axis][bin]);
                right.count += self.ends[axis][bin];
                rights[bin] = right;
                costs[bin] = right.cost();
            }
            let mut left = Side::EMPTY;
            for bin in 1..grid.bins {
                left.bounds = left.bounds.union(&self.bounds[axis][bin - 1]);
                left.count += self.starts[axis][bin - 1];
                if left.count == 0 || rights[bin].count == 0 {
                    continue;
                }
                let cost = left.cost() + costs[bin];
                if best.is_none_or(|best| cost < best.cost) {
                    best = Some(Candidate {
                        cost,
                        axis,
                        bin,
                        left,
                        right: rights[bin],
                    });
                }
            }
        }
        best
    }
}

/// Bins for the fragments of a node, between their centres.
pub(crate) fn object_grid(summary: &Summary) -> Grid {
    Grid {
        area: summary.bounds.half_area().to_bits(),
        ..Grid::new(&summary.centers, (8 + summary.count / 16).min(MAX_BINS))
    }
}

/// The best division at a plane between bins of centres.
pub(crate) fn best_object_split(fragments: &[Fragment], grid: &Grid) -> Option<Candidate> {
    let mut bins = in_chunks(fragments, grid.bins, |bins, fragment| {
        let (bounds, chosen) = (fragment.bounds(), grid.object_bins(fragment));
        for (axis, bin) in chosen.into_iter().enumerate() {
            bins.bounds[axis][bin].grow(bounds.lo, bounds.hi);
            bins.starts[axis][bin] += 1;
        }
    });
    bins.ends = bins.starts;
    bins.best(grid)
}

/// Bins of all fragments, gathered by several threads if they are many.
pub(crate) fn in_chunks(
    fragments: &[Fragment],
    bins: usize,
    add: impl Fn(&mut Bins, &Fragment) + Sync,
) -> Bins {
    let gather = |fragments: &[Fragment]| {
        let mut bins = Bins::EMPTY;
        fragments
            .iter()
            .for_each(|fragment| add(&mut bins, fragment));
        bins
    };
    if fragments.len() <= 2 * CHUNK {
        return gather(fragments);
    }
    fragments
        .par_chunks(CHUNK)
        .map(gather)
        .reduce(|| Bins::EMPTY, |left, right| left.merge(&right, bins))
}

/// Orders at most [`MAX_SORTED`] fragments by the best division among all planes between centres,
/// and returns how many of them go left.
pub(crate) fn sort_for_best_split(fragments: &mut [Fragment]) -> usize {
    let count = fragments.len();
    if count == 2 {
        return 1;
    }
    let mut unsorted = [(Vec3A::ZERO, Box3::EMPTY); MAX_SORTED];
    for (entry, fragment) in unsorted.iter_mut().zip(&*fragments) {
        *entry = (fragment.center(), fragment.bounds());
    }
    let mut best = (f32::INFINITY, count / 2, [0; MAX_SORTED]);
    for axis in 0..3 {
        let order = sorted(count, |i| unsorted[i].0[axis]);
        let bounds = |i: usize| &unsorted[order[i] as usize % MAX_SORTED].1;
        let mut costs = [0.0; MAX_SORTED];
        let mut right = Box3::EMPTY;
        for i in (1..count).rev() {
            right = right.union(bounds(i));
            costs[i] = right.half_area() * (count - i) as f32;
        }
        let mut left = Box3::EMPTY;
        for (i, &right_cost) in costs[..count].iter().enumerate().skip(1) {
            left = left.union(bounds(i - 1));
            let cost = left.half_area() * i as f32 + right_cost;
            if cost < best.0 {
                best = (cost, i, order);
            }
        }
    }
    if best.0 < f32::INFINITY {
        let mut sorted = [fragments[0]; MAX_SORTED];
        for i in 0..count {
            sorted[i] = fragments[best.2[i] as usize];
        }
        fragments.copy_from_slice(&sorted[..count]);
    }
    best.1
}

/// The first `count` indices in the order of their keys; equal keys keep theirs.
fn sorted(count: usize, key: impl Fn(usize) -> f32) -> [u8; MAX_SORTED] {
    let (mut keys, mut order) = ([0.0; MAX_SORTED], [0; MAX_SORTED]);
    for i in 0..count {
        let key = key(i);
        let mut index = i;
        while index > 0 && keys[index - 1] > key {
            keys[index] = keys[index - 1];
            order[index] = order[index - 1];
            index -= 1;
        }
        (keys[index], order[index]) = (key, i as u8);
    }
    order
}
