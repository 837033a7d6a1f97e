//! Splits of space: fragments that straddle the plane are cut in two, where that is cheaper than
//! leaving them whole (M. Stich, H. Friedrich, A. Dietrich, "Spatial Splits in Bounding Volume
//! Hierarchies", HPG 2009).

use crate::build::binning::{Bins, Candidate, Grid, in_chunks};
use crate::build::clip::clip;
use crate::build::fragment::{Box3, Fragment, Summary};
use crate::build::mesh::Mesh;
use crate::build::partition::Placement;

const SPATIAL_BINS: usize = 16;

/// Bins for the fragments of a node, between the sides of its box.
pub(crate) fn spatial_grid(summary: &Summary) -> Grid {
    Grid::new(&summary.bounds, SPATIAL_BINS)
}

/// Bins that a fragment touches: the first and the last on each axis.
#[inline(always)]
fn span(grid: &Grid, fragment: &Fragment) -> ([usize; 3], [usize; 3]) {
    if fragment.credits() == 0 {
        let bins = grid.bins_of(fragment.center() * 0.5);
        (bins, bins)
    } else {
        let bounds = fragment.bounds();
        (grid.bins_of(bounds.lo), grid.bins_of(bounds.hi))
    }
}

/// The best division at a plane between bins of space.
pub(crate) fn best_spatial_split(
    mesh: &Mesh<'_>,
    fragments: &[Fragment],
    grid: &Grid,
) -> Option<Candidate> {
    let bins: Bins = in_chunks(fragments, grid.bins, |bins, fragment| {
        let bounds = fragment.bounds();
        let (first, last) = span(grid, fragment);
        for axis in 0..3 {
            bins.starts[axis][first[axis]] += 1;
            bins.ends[axis][last[axis]] += 1;
        }
        if (0..3).all(|axis| first[axis] == last[axis]) {
            for (bins, bin) in bins.bounds.iter_mut().zip(first) {
                bins[bin].grow(bounds.lo, bounds.hi);
            }
            return;
        }
        let vertices = mesh.vertices(fragment.prim()).map(Into::into);
        for axis in 0..3 {
            let mut rest = bounds;
            for bin in first[axis]..last[axis] {
                let plane = grid.plane(axis, bin + 1);
                let (below, above) = clip(&vertices, &rest, axis, plane);
                if !below.is_empty() {
                    bins.bounds[axis][bin].grow(below.lo, below.hi);
                }
                rest = above;
            }
            if !rest.is_empty() {
                bins.bounds[axis][last[axis]].grow(rest.lo, rest.hi);
            }
        }
    });
    bins.best(grid)
}

/// Where a fragment goes at the split.
pub(crate) fn placement(
    mesh: &Mesh<'_>,
    grid: &Grid,
    split: &Candidate,
    fragment: &Fragment,
) -> Placement {
    let (first, last) = span(grid, fragment);
    if last[split.axis] < split.bin {
        return Placement::Left;
    }
    if first[split.axis] >= split.bin {
        return Placement::Right;
    }
    let bounds = fragment.bounds();
    let vertices = mesh.vertices(fragment.prim()).map(Into::into);
    let plane = grid.plane(split.axis, split.bin);
    let (below, above) = clip(&vertices, &bounds, split.axis, plane);
    if below.is_empty() {
        return Placement::Right;
    }
    if above.is_empty() {
        return Placement::Left;
    }

    let (left, right) = (&split.left, &split.right);
    let grown = |side: &Box3| side.union(&bounds).half_area();
    let both = left.cost() + right.cost();
    let whole_left = grown(&left.bounds) * left.count as f32
        + right.bounds.half_area() * (right.count - 1) as f32;
    let whole_right = left.bounds.half_area() * (left.count - 1) as f32
        + grown(&right.bounds) * right.count as f32;
    if whole_left.min(whole_right) <= both {
        return if whole_left <= whole_right {
            Placement::Left
        } else {
            Placement::Right
        };
    }
    let credits = fragment.credits() - 1;
    let (low, high) = (below.half_area(), above.half_area());
    let share = (credits as f32 * (low / (low + high))).round() as u32;
    let share = share.min(credits);
    Placement::Both(
        Fragment::new(fragment.prim(), &below, share),
        Fragment::new(fragment.prim(), &above, credits - share),
    )
}
