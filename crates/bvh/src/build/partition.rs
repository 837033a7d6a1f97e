//! Divides the fragments of a node between two children, in place and always in the same order.

use rayon::prelude::*;

use crate::build::binning::CHUNK;
use crate::build::fragment::{Fragment, Summary};

/// Where a fragment goes.
pub(crate) enum Placement {
    Left,
    Right,
    /// Split: its credits, less one, shared between the parts.
    Both(Fragment, Fragment),
}

/// Rearranges the first `count` slots. Afterwards the left fragments come first, and the right ones
/// follow after as many free slots as the left ones have credits.
pub(crate) fn partition(
    slots: &mut [Fragment],
    count: usize,
    placement: impl Fn(&Fragment) -> Placement + Sync,
) -> (Summary, Summary) {
    if count > 2 * CHUNK {
        return partition_chunks(slots, count, placement);
    }
    let (mut left, mut right) = (Summary::EMPTY, Summary::EMPTY);
    // Left fragments, fragments not yet seen, right fragments.
    let (mut next, mut unseen, mut end) = (0, count, count);
    while next < unseen {
        let fragment = slots[next];
        match placement(&fragment) {
            Placement::Left => {
                left.add(&fragment);
                next += 1;
            }
            Placement::Right => {
                right.add(&fragment);
                unseen -= 1;
                slots.swap(next, unseen);
            }
            Placement::Both(below, above) => {
                left.add(&below);
                right.add(&above);
                slots[next] = below;
                slots[end] = above;
                next += 1;
                end += 1;
            }
        }
    }
    make_room(slots, &left, &right);
    (left, right)
}

/// Moves right fragments that follow the left ones directly behind the left ones' spare slots.
pub(crate) fn make_room(slots: &mut [Fragment], left: &Summary, right: &Summary) {
    let moved = left.credits.min(right.count);
    let end = left.slots() + right.count;
    slots.copy_within(left.count..left.count + moved, end - moved);
}

fn partition_chunks(
    slots: &mut [Fragment],
    count: usize,
    placement: impl Fn(&Fragment) -> Placement + Sync,
) -> (Summary, Summary) {
    let parts: Vec<_> = slots[..count]
        .par_chunks(CHUNK)
        .map(|fragments| {
            let mut sides = [Vec::with_capacity(CHUNK), Vec::with_capacity(CHUNK)];
            for fragment in fragments {
                match placement(fragment) {
                    Placement::Left => sides[0].push(*fragment),
                    Placement::Right => sides[1].push(*fragment),
                    Placement::Both(below, above) => {
                        sides[0].push(below);
                        sides[1].push(above);
                    }
                }
            }
            let summaries = [Summary::of(&sides[0]), Summary::of(&sides[1])];
            (sides, summaries)
        })
        .collect();
    let [left, right] = [0, 1].map(|side| {
        parts.iter().fold(Summary::EMPTY, |all, (_, summaries)| {
            all.merge(&summaries[side])
        })
    });

    let (mut lefts, mut rights) = slots.split_at_mut(left.slots());
    let mut copies = Vec::with_capacity(2 * parts.len());
    for (sides, _) in &parts {
        let target;
        (target, lefts) = lefts.split_at_mut(sides[0].len());
        copies.push((target, &sides[0]));
        let target;
        (target, rights) = rights.split_at_mut(sides[1].len());
        copies.push((target, &sides[1]));
    }
    copies
        .into_par_iter()
        .for_each(|(target, source)| target.copy_from_slice(source));
    (left, right)
}
