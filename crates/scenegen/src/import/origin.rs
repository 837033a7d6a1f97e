//! Scenes far from the origin, as surveys and scans are: their positions are relative to a place among them, as 32 bits
//! do not hold both where a scene is and what it looks like.
//!
//! The place is where most corners of faces are, and not the middle of all of them: a single vertex left at 0, a north
//! arrow or a helper beside the model would make a box of hundreds of kilometres, from whose size alone nothing seems far.

use glam::{DAffine3, DVec3};

use super::warnings::Warnings;
use crate::desc::{InstanceDesc, MeshDesc, SceneDesc};

/// Scenes are far if their middle is so many times farther from the origin than half of their corners are from it.
const FAR: f64 = 100.0;

/// As many corners say where a scene is; importers give no more than about that.
pub(super) const MAX_SAMPLES: usize = 1 << 16;

/// Objects across which 32 bits tell fewer places apart have lost details.
const FEWEST_PLACES: f64 = 1000.0;

/// The place that positions are relative to, of whole coordinates; the origin for scenes that are not far, or where there
/// is nothing. `corners` are where corners of faces are, each once or as often as faces have it.
pub(super) fn choose(corners: impl IntoIterator<Item = DVec3>) -> DVec3 {
    let corners = corners.into_iter();
    let corners: Vec<DVec3> = corners.filter(|corner| corner.is_finite()).collect();
    if corners.is_empty() {
        return DVec3::ZERO;
    }
    let middle = DVec3::from([0, 1, 2].map(|axis| median(corners.iter().map(|c| c[axis]))));
    let distances = corners.iter().map(|&c| (c - middle).abs().max_element());
    let is_far = middle.abs().max_element() > FAR * median(distances);
    if is_far { middle.round() } else { DVec3::ZERO }
}

/// Warns about objects so far from the scene's origin that they have lost details: it can be near one place only.
pub(super) fn warn_about_lost_details(scene: &SceneDesc, warnings: &mut Warnings) {
    let boxes: Vec<[DVec3; 2]> = scene.meshes.iter().map(middle_and_half_extent).collect();
    let is_coarse = |instance: &&InstanceDesc| {
        let transform = instance.transform;
        let [middle, half_extent] = boxes[instance.mesh];
        let to_world = DAffine3::from_mat3_translation(
            glam::Mat3::from(transform.matrix3).as_dmat3(),
            transform.translation.as_dvec3(),
        );
        let columns = to_world.matrix3.to_cols_array().map(f64::abs);
        let half_extent = glam::DMat3::from_cols_array(&columns) * half_extent;
        let step = to_world.transform_point3(middle).abs().max_element() * f64::from(f32::EPSILON);
        let size = 2.0 * half_extent.max_element();
        size > 0.0 && size < FEWEST_PLACES * step
    };
    let mut coarse = scene.instances.iter().filter(is_coarse);
    if let Some(first) = coarse.next() {
        let message = format!(
            "{} objects are so small and so far from most others that 32 bits do not hold their details",
            1 + coarse.count()
        );
        warnings.push(format!("\"{}\"", first.name.escape_debug()), message);
    }
}

fn middle_and_half_extent(mesh: &MeshDesc) -> [DVec3; 2] {
    let used = mesh.triangles.as_flattened().iter();
    let positions = used.map(|&corner| mesh.positions[corner as usize].as_dvec3());
    let (low, high) = positions.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
        (low.min(p), high.max(p))
    });
    match low.is_finite() {
        true => [0.5 * (low + high), 0.5 * (high - low)],
        false => [DVec3::ZERO; 2],
    }
}

/// The middle one of the values, of an even number the upper one; there is at least one. It is right as long as more than
/// half of them are.
fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: DVec3 = DVec3::new(4_543_210.25, 5_432_100.5, 120.125);

    fn square(side: f64) -> Vec<DVec3> {
        [[0., 0.], [1., 0.], [1., 1.], [0., 1.]]
            .map(|[x, y]| side * DVec3::new(x, y, 0.0))
            .to_vec()
    }

    fn at(place: DVec3, corners: &[DVec3]) -> Vec<DVec3> {
        corners.iter().map(|&corner| corner + place).collect()
    }

    #[test]
    fn near_scenes_stay_where_they_are() {
        assert_eq!(choose([]), DVec3::ZERO);
        assert_eq!(choose([DVec3::NAN]), DVec3::ZERO);
        assert_eq!(choose(square(1.0)), DVec3::ZERO);
        assert_eq!(
            choose(at(DVec3::new(50.0, 0.0, 0.0), &square(1.0))),
            DVec3::ZERO
        );
        // Whatever lies far away, the others do not.
        assert_eq!(choose([square(1.0), vec![PLACE; 3]].concat()), DVec3::ZERO);
    }

    #[test]
    fn far_scenes_are_relative_to_where_most_of_them_is() {
        let far = at(PLACE, &square(10.0));
        for outliers in [
            vec![],
            vec![DVec3::ZERO],
            vec![DVec3::ZERO, DVec3::X, DVec3::Y],
            vec![-PLACE, DVec3::NAN, 1e9 * DVec3::X],
        ] {
            for corners in [[far.clone(), outliers.clone()], [outliers, far.clone()]] {
                let origin = choose(corners.concat());
                assert!(origin.distance(PLACE) < 15.0, "{origin}");
                assert_eq!(origin, origin.round());
            }
        }
    }

    #[test]
    fn one_place_is_far_from_everything_else() {
        assert_eq!(choose([DVec3::new(3.25, 0.0, 0.0); 3]), 3.0 * DVec3::X);
    }
}
