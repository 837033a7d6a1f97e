//! Whether meshes enclose bodies.

use std::collections::BTreeMap;

use crate::desc::{MeshDesc, SceneDesc, SurfaceDesc};

/// Which meshes are closed surfaces, of those whose materials let light into bodies.
pub(super) struct Closed {
    pub(super) meshes: Vec<bool>,
    /// For each material, whether all its meshes are.
    pub(super) materials: Vec<bool>,
}

impl Closed {
    /// Those of a scene.
    pub(super) fn of(scene: &SceneDesc) -> Self {
        let transmits = |material: usize| match &scene.materials[material].surface {
            SurfaceDesc::MetallicRoughness(surface) => {
                surface.transmission.factor > 0.0 || surface.is_translucent()
            }
            SurfaceDesc::Dielectric { .. } => true,
            _ => false,
        };
        let meshes = scene.meshes.iter();
        let meshes: Vec<_> = meshes
            .map(|mesh| transmits(mesh.material) && is_closed(mesh))
            .collect();
        let mut materials = vec![true; scene.materials.len()];
        for (mesh, is_closed) in scene.meshes.iter().zip(&meshes) {
            materials[mesh.material] &= is_closed;
        }
        Self { meshes, materials }
    }
}

/// Every edge is met by as many triangles in one direction as in the other: the surface has no border. Vertices are
/// the same where their positions are, since files split them along seams of other attributes.
fn is_closed(mesh: &MeshDesc) -> bool {
    let mut numbers = BTreeMap::new();
    let mut number = |corner: u32| {
        // −0 and 0 are the same place.
        let place = mesh.positions[corner as usize]
            .to_array()
            .map(|c| (c + 0.0).to_bits());
        let next = numbers.len();
        *numbers.entry(place).or_insert(next)
    };
    let mut balance: BTreeMap<(usize, usize), i32> = BTreeMap::new();
    for triangle in &mesh.triangles {
        let corners = triangle.map(&mut number);
        for k in 0..3 {
            let (a, b) = (corners[k], corners[(k + 1) % 3]);
            // A degenerate edge is its own reverse.
            if a != b {
                *balance.entry((a.min(b), a.max(b))).or_default() += if a < b { 1 } else { -1 };
            }
        }
    }
    !balance.is_empty() && balance.values().all(|&count| count == 0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn a_tetrahedron_is_closed_until_a_side_is_missing_or_turned() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z];
        let triangles = vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mesh = MeshDesc {
            positions,
            triangles,
            ..MeshDesc::default()
        };
        assert!(is_closed(&mesh));
        let mut open = mesh.clone();
        open.triangles.pop();
        assert!(!is_closed(&open));
        let mut turned = mesh.clone();
        turned.triangles[3] = [1, 3, 2];
        assert!(!is_closed(&turned));
        let mut split = mesh;
        split.positions.push(Vec3::new(-0.0, 0.0, 0.0));
        split.triangles[0] = [4, 2, 1];
        assert!(is_closed(&split));
        assert!(!is_closed(&MeshDesc::default()));
    }
}
