//! The vertices of a model relative to a place among them.

use glam::{DVec3, Vec3};

use crate::import::origin;

/// The place that positions are relative to, and the positions.
pub(super) fn relative(positions: &[DVec3]) -> (DVec3, Vec<Vec3>) {
    let finite = || positions.iter().filter(|position| position.is_finite());
    let low = finite().fold(DVec3::INFINITY, |low, &position| low.min(position));
    let high = finite().fold(DVec3::NEG_INFINITY, |high, &position| high.max(position));
    let origin = origin::choose([low, high]);
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
        let place = DVec3::new(4_543_210.25, 5_432_100.5, 120.125);
        let near = [DVec3::ZERO, DVec3::new(10.0, 0.001, 0.0), DVec3::NAN];
        let (origin, positions) = relative(&near);
        assert_eq!((origin, positions[1]), (DVec3::ZERO, near[1].as_vec3()));
        let far = near.map(|position| position + place);
        let (origin, positions) = relative(&far);
        for (position, far) in positions.iter().zip(far).take(2) {
            assert!(
                (origin + position.as_dvec3()).distance(far) < 1e-6,
                "{origin} {position}"
            );
        }
        assert!(positions[2].is_nan());
        // One vertex far away, be it the first, is no reason.
        assert_eq!(relative(&[place, DVec3::X, DVec3::Y]).0, DVec3::ZERO);
        assert_eq!(relative(&[]).0, DVec3::ZERO);
    }
}
