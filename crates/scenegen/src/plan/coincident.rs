//! Triangles that lie exactly on others: exporters write surfaces twice, and scanners thousands of times.
//!
//! At one distance the triangle of the smallest index is hit, so that what lies on it is never seen; but every ray that comes by
//! tests all of them (hard case B-07). Such triangles are drawn together to a point, which hierarchies leave out, and which emits nothing.

use std::collections::{HashMap, HashSet};
use std::hash::{DefaultHasher, Hash, Hasher};

use residual_render::scene_data::SceneData;
use residual_render::triangle::TriangleRecord;

/// The corners' bits, in their order from the smallest on: equal for triangles with the same front.
type Key = [[u32; 3]; 3];

fn key(corners: [[f32; 3]; 3]) -> Key {
    // Both zeros are one place.
    let [a, b, c] = corners.map(|corner| corner.map(|x| (x + 0.0).to_bits()));
    [[a, b, c], [b, c, a], [c, a, b]]
        .into_iter()
        .min()
        .expect("three turns")
}

fn hash(key: &Key) -> u64 {
    let mut hasher = DefaultHasher::new();
    key.hash(&mut hasher);
    hasher.finish()
}

/// Hides the triangles that nobody can see because another lies in the same place; returns how many.
pub(super) fn hide(data: &mut SceneData) -> usize {
    let corners = |data: &SceneData, index: usize| data.record::<TriangleRecord>(index).corners();
    let count = data.triangle_count();
    let mut hashes: Vec<u64> = (0..count)
        .map(|index| hash(&key(corners(data, index))))
        .collect();
    let by_index = hashes.clone();
    hashes.sort_unstable();
    let repeated: HashSet<u64> = hashes
        .windows(2)
        .filter(|pair| pair[0] == pair[1])
        .map(|pair| pair[0])
        .collect();
    if repeated.is_empty() {
        return 0;
    }
    // Of each place, whether what is seen there is seen from one side only.
    let mut seen: HashMap<Key, bool> = HashMap::new();
    let mut hidden = 0;
    for index in (0..count).filter(|&index| repeated.contains(&by_index[index])) {
        let place = corners(data, index);
        let [a, b, c] = place;
        if a == b || b == c || c == a {
            continue;
        }
        let is_single_sided = data.single_sided[index];
        match seen.get(&key(place)) {
            // What lies on it may be seen from the other side.
            Some(true) if !is_single_sided => {}
            Some(_) => {
                let point = TriangleRecord::new([place[0]; 3]);
                data.change::<TriangleRecord>(index, |record| TriangleRecord {
                    a: point.a,
                    b: point.b,
                    c: point.c,
                    ..record
                });
                hidden += 1;
            }
            // Whoever lets rays through hides nothing.
            None if data.alpha_tested[index] => {}
            None => {
                seen.insert(key(place), is_single_sided);
            }
        }
    }
    hidden
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    /// Triangles with their flags: single-sided, alpha-tested.
    fn data(triangles: &[([[f32; 3]; 3], bool, bool)]) -> SceneData {
        let mut data = SceneData::default();
        for (corners, single_sided, alpha_tested) in triangles {
            data.push(TriangleRecord::new(*corners));
            data.single_sided.push(*single_sided);
            data.alpha_tested.push(*alpha_tested);
        }
        data
    }

    /// Which of the triangles are still there.
    fn left(triangles: &[([[f32; 3]; 3], bool, bool)]) -> Vec<bool> {
        let mut data = data(triangles);
        let hidden = hide(&mut data);
        let left: Vec<bool> = data
            .records::<TriangleRecord>()
            .map(|triangle| triangle.corners()[0] != triangle.corners()[1])
            .collect();
        assert_eq!(hidden, left.iter().filter(|left| !**left).count());
        left
    }

    #[test]
    fn the_first_of_each_place_is_seen() {
        let [a, b, c] = PLACE;
        let turned = [b, c, a];
        let back = [a, c, b];
        let zero = [[-0.0, 0.0, 0.0], b, c];
        let other = [a, b, [0.0, 2.0, 0.0]];
        let of = |corners| (corners, false, false);
        assert_eq!(
            left(&[
                of(PLACE),
                of(turned),
                of(back),
                of(zero),
                of(other),
                of(PLACE),
                of(back)
            ]),
            [true, false, true, false, true, false, false]
        );
    }

    #[test]
    fn what_can_be_seen_stays() {
        // Behind a single-sided triangle, a double-sided one is seen from the back; behind alpha, everything is.
        let single = (PLACE, true, false);
        let double = (PLACE, false, false);
        let alpha = (PLACE, false, true);
        assert_eq!(left(&[single, double, single]), [true, true, false]);
        assert_eq!(left(&[double, single]), [true, false]);
        assert_eq!(
            left(&[alpha, alpha, double, alpha]),
            [true, true, true, false]
        );
        assert_eq!(left(&[double]), [true]);
    }
}
