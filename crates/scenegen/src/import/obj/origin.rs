//! The vertices of a model relative to a place among them.

use glam::{DVec3, Vec3};

use super::corner::Corner;
use crate::import::origin;

/// The place that positions are relative to, and the positions. Vertices that no corner refers to do not count.
pub(super) fn relative(positions: &[DVec3], corners: &[Corner]) -> (DVec3, Vec<Vec3>) {
    let step = corners.len().div_ceil(origin::MAX_SAMPLES).max(1);
    let used = corners.iter().step_by(step);
    let origin =
        origin::choose(used.filter_map(|corner| positions.get(corner.position()).copied()));
    let relative = positions
        .iter()
        .map(|&position| (position - origin).as_vec3());
    (origin, relative.collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn far_models_keep_their_details() {
        let corners = |faces: &str| -> Vec<Corner> {
            let words = faces.split_whitespace();
            words
                .map(|word| Corner::parse(word, [0; 3]).unwrap())
                .collect()
        };
        let place = DVec3::new(4_543_210.25, 5_432_100.5, 120.125);
        let near = [
            DVec3::ZERO,
            DVec3::new(10.0, 0.001, 0.0),
            DVec3::new(0.0, 10.0, 0.0),
            DVec3::NAN,
        ];
        let (origin, positions) = relative(&near, &corners("1 2 3 4"));
        assert_eq!((origin, positions[1]), (DVec3::ZERO, near[1].as_vec3()));
        let mut far = near.map(|position| position + place).to_vec();
        // Unused vertices outnumber the others, and one face is at the origin of the world; another has no vertex.
        far.extend([DVec3::ZERO; 10]);
        let (origin, positions) = relative(&far, &corners("1 2 3 4 1 2 5 1 2 77"));
        for (position, &far) in positions.iter().zip(&far).take(3) {
            assert!(
                (origin + position.as_dvec3()).distance(far) < 1e-6,
                "{origin} {position}"
            );
        }
        assert!(positions[3].is_nan());
        assert!((origin + positions[5].as_dvec3()).length() < 1.0);
        // Nor is a far vertex a reason, be it used or not.
        for faces in ["2 3 4", "1 2 3 4 3 2"] {
            let (origin, _) = relative(&[place, DVec3::X, DVec3::Y, DVec3::ZERO], &corners(faces));
            assert_eq!(origin, DVec3::ZERO, "{faces}");
        }
        assert_eq!(relative(&[], &[]).0, DVec3::ZERO);
    }
}
