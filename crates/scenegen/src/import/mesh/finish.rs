//! From a [`RawMesh`] and its material to a valid [`MeshDesc`].

use super::raw::RawMesh;
use super::{normals, tangents};
use crate::desc::{MaterialDesc, MeshDesc};
use crate::import::budget::Budget;
use crate::import::error::Fault;
use crate::import::missing_uvs;
use crate::import::warnings::Warnings;

/// Bytes of a vertex: position, normal, two texture coordinates, colour.
const VERTEX_BYTES: u64 = 56;

/// The same with a tangent.
const VERTEX_BYTES_WITH_TANGENT: u64 = VERTEX_BYTES + 16;

/// Makes a valid mesh; `None` where no triangle is left. The caller sets the index of its material.
pub(in crate::import) fn finish(
    mut raw: RawMesh,
    name: String,
    material: &MaterialDesc,
    place: &str,
    budget: &mut Budget,
    warnings: &mut Warnings,
) -> Result<Option<MeshDesc>, Fault> {
    missing_uvs::warn_about_missing_uvs(material, &raw.uvs, raw.uv_sets, place, warnings);
    raw.drop_non_finite(place, warnings);
    if raw.triangles.is_empty() {
        warnings.push(place, "has no triangles and is skipped");
        return Ok(None);
    }

    let mut mesh = MeshDesc {
        name,
        positions: raw.positions,
        uvs: raw.uvs,
        colors: raw.colors,
        triangles: raw.triangles,
        ..MeshDesc::default()
    };
    let corner_count = 3 * mesh.triangles.len() as u64;
    let given_tangents = match raw.normals {
        Some(given) => {
            normals::repair(&mut mesh, given, place, warnings);
            raw.tangents
        }
        None => {
            budget.charge(corner_count, VERTEX_BYTES, place)?;
            normals::make_flat(&mut mesh);
            // The specification says to ignore given tangents where there are no normals.
            None
        }
    };
    if let Some(uv_set) = material.tangent_uv_set() {
        // In the worst case every corner becomes a vertex of its own.
        budget.charge(corner_count, VERTEX_BYTES_WITH_TANGENT, place)?;
        tangents::complete(&mut mesh, given_tangents, uv_set, place, warnings);
    }
    Ok(Some(mesh))
}
