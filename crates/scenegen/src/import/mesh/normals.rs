//! Shading normals: flat ones where a file has none, face normals where it has unusable ones.

use glam::{DVec3, Vec3};

use super::vertices::gather_vertices;
use crate::desc::MeshDesc;
use crate::import::warnings::Warnings;

/// The normal of a triangle's front, in f64 so that slivers and tiny triangles have one; `None` without area.
pub(super) fn face_normal(positions: &[Vec3], corners: [u32; 3]) -> Option<Vec3> {
    let [a, b, c]: [DVec3; 3] = corners.map(|corner| positions[corner as usize].as_dvec3());
    let normal = (b - a).cross(c - a).try_normalize()?.as_vec3();
    Some(normal.normalize())
}

/// Gives every triangle vertices of its own with its face normal.
pub(super) fn make_flat(mesh: &mut MeshDesc) {
    let corners: Vec<u32> = mesh.triangles.iter().flatten().copied().collect();
    gather_vertices(mesh, &corners);
    let triangle_count = mesh.triangles.len() as u32;
    mesh.triangles = (0..triangle_count)
        .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
        .collect();
    mesh.normals = mesh
        .triangles
        .iter()
        .flat_map(|&corners| [face_normal(&mesh.positions, corners).unwrap_or(Vec3::Y); 3])
        .collect();
}

/// Takes the given normals, made unit; zero and non-finite ones become the normal of a face at the vertex.
pub(super) fn repair(mesh: &mut MeshDesc, given: Vec<Vec3>, place: &str, warnings: &mut Warnings) {
    let mut broken = vec![false; given.len()];
    mesh.normals = given
        .into_iter()
        .zip(&mut broken)
        .map(|(normal, broken)| {
            normalized(normal).unwrap_or_else(|| {
                *broken = true;
                Vec3::Y
            })
        })
        .collect();
    if !broken.contains(&true) {
        return;
    }
    let mut replaced = 0_usize;
    for &corners in &mesh.triangles {
        for corner in corners {
            if std::mem::take(&mut broken[corner as usize]) {
                replaced += 1;
                if let Some(normal) = face_normal(&mesh.positions, corners) {
                    mesh.normals[corner as usize] = normal;
                } else {
                    // Another face of the vertex may have an area.
                    replaced -= 1;
                    broken[corner as usize] = true;
                }
            }
        }
    }
    if replaced > 0 {
        warnings.push(
            place,
            format!("{replaced} normals are zero or not finite; the face normal is used"),
        );
    }
}

/// A unit vector, in f64 so that 1e-30 has a direction; `None` for zero and non-finite ones.
pub(super) fn normalized(vector: Vec3) -> Option<Vec3> {
    if !vector.is_finite() {
        return None;
    }
    Some(vector.as_dvec3().try_normalize()?.as_vec3())
}
