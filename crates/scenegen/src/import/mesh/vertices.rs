//! Rearranging the vertices of a mesh.

use crate::desc::MeshDesc;

/// Makes new vertices of those at the given indices. Normals and tangents are left to the caller, which
/// makes them anew.
pub(super) fn gather_vertices(mesh: &mut MeshDesc, indices: &[u32]) {
    mesh.positions = gather(&mesh.positions, indices);
    for uvs in mesh.uvs.iter_mut().flatten() {
        *uvs = gather(uvs, indices);
    }
    if let Some(colors) = &mut mesh.colors {
        *colors = gather(colors, indices);
    }
}

/// The values at the given indices.
pub(super) fn gather<T: Copy>(values: &[T], indices: &[u32]) -> Vec<T> {
    indices
        .iter()
        .map(|&index| values[index as usize])
        .collect()
}
