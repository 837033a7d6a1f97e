//! Raw triangles as a file gives them, and what makes a valid [`MeshDesc`] of them.
//!
//! Both importers fill [`RawMesh`]; here non-finite values are dealt with, normals and tangents completed.

use glam::{Vec2, Vec3, Vec4};

use super::{normals, tangents};
use crate::desc::MeshDesc;
use crate::import::budget::Budget;
use crate::import::error::{Fault, Warnings};

/// Vertices and triangles, with attribute arrays of the same length and indices in range, but with any
/// bits in the floats.
#[derive(Debug, Default)]
pub(in crate::import) struct RawMesh {
    /// Positions.
    pub(in crate::import) positions: Vec<Vec3>,
    /// Normals of any length.
    pub(in crate::import) normals: Option<Vec<Vec3>>,
    /// Tangents of any length.
    pub(in crate::import) tangents: Option<Vec<Vec4>>,
    /// Texture coordinates.
    pub(in crate::import) uvs: [Option<Vec<Vec2>>; 2],
    /// Colours.
    pub(in crate::import) colors: Option<Vec<Vec4>>,
    /// Corners.
    pub(in crate::import) triangles: Vec<[u32; 3]>,
}

/// Makes a valid mesh; `None` where no triangle is left. `tangent_uv_set` says that the material has a
/// normal map, and with which texture coordinates.
pub(in crate::import) fn finish(
    mut raw: RawMesh,
    name: String,
    tangent_uv_set: Option<usize>,
    place: &str,
    budget: &mut Budget,
    warnings: &mut Warnings,
) -> Result<Option<MeshDesc>, Fault> {
    drop_non_finite(&mut raw, place, warnings);
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
    let given_tangents = match raw.normals {
        Some(given) => {
            normals::repair(&mut mesh, given, place, warnings);
            raw.tangents
        }
        None => {
            // Split vertices: 3 per triangle, position, normal, two texture coordinates, colour.
            budget.charge(mesh.triangles.len() as u64, 3 * 56, place)?;
            normals::make_flat(&mut mesh);
            // The specification says to ignore given tangents where there are no normals.
            None
        }
    };
    if let Some(uv_set) = tangent_uv_set {
        budget.charge(mesh.triangles.len() as u64, 3 * 72, place)?;
        tangents::complete(&mut mesh, given_tangents, uv_set, place, warnings);
    }
    Ok(Some(mesh))
}

/// Drops triangles with non-finite corners and replaces other non-finite values by harmless ones.
fn drop_non_finite(raw: &mut RawMesh, place: &str, warnings: &mut Warnings) {
    let before = raw.triangles.len();
    let positions = &raw.positions;
    raw.triangles.retain(|corners| {
        corners
            .iter()
            .all(|&corner| positions[corner as usize].is_finite())
    });
    let dropped = before - raw.triangles.len();
    if dropped > 0 {
        warnings.push(
            place,
            format!("{dropped} of {before} triangles have NaN or infinite corners and are dropped"),
        );
    }
    replace_non_finite(&mut raw.positions, Vec3::is_finite, Vec3::ZERO);
    for uvs in raw.uvs.iter_mut().flatten() {
        let replaced = replace_non_finite(uvs, Vec2::is_finite, Vec2::ZERO);
        if replaced > 0 {
            warnings.push(
                place,
                format!("{replaced} texture coordinates are NaN or infinite; 0 is used"),
            );
        }
    }
    if let Some(colors) = &mut raw.colors {
        let valid = |color: Vec4| color.is_finite() && color.min_element() >= 0.0;
        let replaced = replace_non_finite(colors, valid, Vec4::ONE);
        if replaced > 0 {
            warnings.push(
                place,
                format!("{replaced} vertex colours are NaN, infinite or negative; white is used"),
            );
        }
    }
}

fn replace_non_finite<T: Copy>(
    values: &mut [T],
    is_valid: impl Fn(T) -> bool,
    substitute: T,
) -> usize {
    let mut count = 0;
    for value in values.iter_mut().filter(|value| !is_valid(**value)) {
        *value = substitute;
        count += 1;
    }
    count
}
