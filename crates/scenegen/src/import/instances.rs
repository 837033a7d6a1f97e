//! Placing meshes: transforms that leave something to see.

use glam::{DAffine3, DVec3};

use super::warnings::Warnings;
use crate::desc::{InstanceDesc, MeshDesc};

/// The instance, or `None`, after a warning, where nothing of it can be seen.
pub(super) fn place_mesh(
    meshes: &[MeshDesc],
    mesh: usize,
    name: &str,
    world: &DAffine3,
    at: &str,
    warnings: &mut Warnings,
) -> Option<InstanceDesc> {
    let transform = world.as_affine3a();
    if !transform.is_finite() {
        warnings.push(at, "the transform is not finite; the instance is left out");
        return None;
    }
    // The f32 matrix decides, as it is what will be rendered.
    let linear = glam::Mat3::from(transform.matrix3).as_dmat3();
    if linear.determinant() == 0.0 {
        if !has_area(&meshes[mesh], &linear) {
            warnings.push(
                at,
                "the transform is singular and leaves no area; the instance is left out",
            );
            return None;
        }
        warnings.push(at, "the transform is singular: the instance is flat");
    }
    Some(InstanceDesc {
        name: name.to_owned(),
        mesh,
        transform,
    })
}

fn has_area(mesh: &MeshDesc, linear: &glam::DMat3) -> bool {
    mesh.triangles.iter().any(|corners| {
        let [a, b, c] = corners.map(|corner| *linear * mesh.positions[corner as usize].as_dvec3());
        (b - a).cross(c - a) != DVec3::ZERO
    })
}
