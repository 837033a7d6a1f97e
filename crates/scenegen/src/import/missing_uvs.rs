//! Meshes that lack the texture coordinates that their material's textures are read with.

use glam::Vec2;

use super::warnings::Warnings;
use crate::desc::MaterialDesc;

/// Warns where a mesh lacks the coordinates that its material's textures are read with.
pub(super) fn warn_about_missing_uvs(
    material: &MaterialDesc,
    uvs: &[Option<Vec<Vec2>>; 2],
    numbers: [u32; 2],
    place: &str,
    warnings: &mut Warnings,
) {
    for (set, (values, number)) in uvs.iter().zip(numbers).enumerate() {
        if values.is_none() && material.textures().any(|texture| texture.uv_set == set) {
            let message = format!(
                "lacks TEXCOORD_{number}, which the textures of material \"{}\" are read with; (0, 0) is used",
                material.name
            );
            warnings.push(place, message);
        }
    }
}
