//! The tree over the boxes of instances: from the top down, by binned splits under the surface area
//! heuristic. A wide node divides its range until it has `N` parts, the one of the greatest area
//! first.
//!
//! Instances are few next to triangles: the build is simple and serial, O(n log n), half a second
//! for 10⁵.

use std::ops::Range;

use crate::bounds::Bounds;
use crate::layout::child::Child;
use crate::layout::node::WideNode;
use crate::layout::validate::MAX_DEPTH;

/// Instances in the largest leaf. A leaf tests each box again before it transforms the ray.
const MAX_LEAF: usize = 4;
const BINS: usize = 32;
/// From this level on ranges are halved: boxes as small as you like inside each other would
/// otherwise make a chain. The halves of 2²⁷ instances reach leaves in 27 more levels.
const FIRST_HALVED_LEVEL: usize = 34;
const _: () = assert!(FIRST_HALVED_LEVEL + 27 < MAX_DEPTH && MAX_LEAF <= Child::MAX_PACKETS);

/// How ranges are divided.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Rule {
    /// The greatest box first, where the surface area heuristic says.
    LeastCost,
    /// The longest range first, at its median.
    Halves,
}

impl Rule {
    fn at(level: usize) -> Rule {
        if level < FIRST_HALVED_LEVEL {
            Rule::LeastCost
        } else {
            Rule::Halves
        }
    }
}

/// A box, and its index among those given.
#[derive(Clone, Copy)]
struct Item {
    bounds: Bounds,
    index: u32,
}

impl Item {
    /// Twice the middle of the box along an axis; finite.
    fn center(&self, axis: usize) -> f64 {
        let finite = |x: f32| f64::from(x.clamp(f32::MIN, f32::MAX));
        finite(self.bounds.lo[axis]) + finite(self.bounds.hi[axis])
    }
}

/// Nodes over the boxes, none of which is empty or NaN, parents first; and the boxes' indices in
/// the order in which the leaves name them.
pub(crate) fn build_top_level<const N: usize>(boxes: &[Bounds]) -> (Vec<WideNode<N>>, Vec<u32>) {
    let mut items: Vec<Item> = boxes
        .iter()
        .zip(0..)
        .map(|(&bounds, index)| Item { bounds, index })
        .collect();
    let mut nodes = vec![WideNode::VACANT];
    // Nodes yet to fill: (node, what is below, level).
    let mut pending = vec![(0, 0..items.len(), 1)];
    while let Some((target, range, level)) = pending.pop() {
        let parts = divide::<N>(&mut items, range, Rule::at(level));
        for (slot, (part, bounds)) in parts.into_iter().enumerate() {
            let child = if part.len() <= MAX_LEAF {
                Child::leaf(part.start, part.len())
            } else {
                nodes.push(WideNode::VACANT);
                pending.push((nodes.len() - 1, part, level + 1));
                Child::node(nodes.len() - 1)
            };
            nodes[target].set_child(slot, &bounds, child);
        }
    }
    (nodes, items.iter().map(|item| item.index).collect())
}

/// At most `N` parts of the range, and their boxes; none if it is empty.
fn divide<const N: usize>(
    items: &mut [Item],
    range: Range<usize>,
    rule: Rule,
) -> Vec<(Range<usize>, Bounds)> {
    if range.is_empty() {
        return Vec::new();
    }
    let bounds = bounds_of(&items[range.clone()]);
    let mut parts = vec![(range, bounds)];
    while parts.len() < N {
        let size = |(part, bounds): &(Range<usize>, Bounds)| match rule {
            Rule::LeastCost => bounds.half_area(),
            Rule::Halves => part.len() as f64,
        };
        let next = (0..parts.len())
            .filter(|&part| parts[part].0.len() > MAX_LEAF)
            .max_by(|&a, &b| size(&parts[a]).total_cmp(&size(&parts[b])));
        let Some(next) = next else { break };
        let part = parts[next].0.clone();
        let middle = part.start + split(&mut items[part.clone()], rule);
        let [left, right] = [part.start..middle, middle..part.end];
        parts[next] = (left.clone(), bounds_of(&items[left]));
        parts.push((right.clone(), bounds_of(&items[right])));
    }
    parts
}

fn bounds_of(items: &[Item]) -> Bounds {
    items
        .iter()
        .fold(Bounds::EMPTY, |bounds, item| bounds.union(&item.bounds))
}

/// Rearranges the items, two at least, and returns how many go to the left: not none, not all.
fn split(items: &mut [Item], rule: Rule) -> usize {
    let axes = [0, 1, 2].map(|axis| {
        let range = items
            .iter()
            .map(|item| item.center(axis))
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
                (lo.min(x), hi.max(x))
            });
        Axis {
            axis,
            lo: range.0,
            extent: range.1 - range.0,
        }
    });
    let best = axes
        .iter()
        .filter(|axis| axis.extent > 0.0 && rule == Rule::LeastCost)
        .map(|axis| (axis.cheapest_split(items), axis))
        .min_by(|(a, _), (b, _)| a.cost.total_cmp(&b.cost));
    if let Some((cut, axis)) = best {
        let (mut left, mut right) = (0, items.len());
        while left < right {
            if axis.bin(&items[left]) <= cut.last_bin {
                left += 1;
            } else {
                right -= 1;
                items.swap(left, right);
            }
        }
        return left;
    }
    let longest = axes
        .into_iter()
        .max_by(|a, b| a.extent.total_cmp(&b.extent))
        .expect("three axes");
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let [p, q] = [a, b].map(|item| item.center(longest.axis));
        p.total_cmp(&q).then(a.index.cmp(&b.index))
    });
    middle
}

/// The boxes' centres along one axis.
struct Axis {
    axis: usize,
    lo: f64,
    extent: f64,
}

/// A split after a bin.
struct Cut {
    last_bin: usize,
    cost: f64,
}

impl Axis {
    /// The first centre falls into the first bin and the last into the last.
    fn bin(&self, item: &Item) -> usize {
        let fraction = (item.center(self.axis) - self.lo) / self.extent;
        ((fraction * BINS as f64) as usize).min(BINS - 1)
    }

    /// For an extent greater than zero.
    fn cheapest_split(&self, items: &[Item]) -> Cut {
        let mut bins = [(0u32, Bounds::EMPTY); BINS];
        for item in items {
            let (count, bounds) = &mut bins[self.bin(item)];
            *count += 1;
            *bounds = bounds.union(&item.bounds);
        }
        let sweep = |sum: &mut (u32, Bounds), (count, bounds): &(u32, Bounds)| {
            *sum = (sum.0 + count, sum.1.union(bounds));
            Some(*sum)
        };
        let start = (0, Bounds::EMPTY);
        let below: Vec<_> = bins.iter().scan(start, sweep).collect();
        let mut above: Vec<_> = bins.iter().rev().scan(start, sweep).collect();
        above.reverse();
        let cost = |(count, bounds): (u32, Bounds)| f64::from(count) * bounds.half_area();
        (0..BINS - 1)
            .map(|last_bin| Cut {
                last_bin,
                cost: cost(below[last_bin]) + cost(above[last_bin + 1]),
            })
            .min_by(|a, b| a.cost.total_cmp(&b.cost))
            .expect("several bins")
    }
}
