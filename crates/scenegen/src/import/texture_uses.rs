//! Which textures a material reads, and with which coordinates.

use glam::Vec2;

use super::warnings::Warnings;
use crate::desc::{ColorInput, MaterialDesc, ScalarInput, SurfaceDesc, TextureUse};

/// All uses of textures in a material, in the order of its fields.
pub(crate) fn texture_uses(material: &MaterialDesc) -> Vec<&TextureUse> {
    fn color(input: &ColorInput) -> Option<&TextureUse> {
        input.texture.as_ref()
    }
    fn scalar(input: &ScalarInput) -> Option<&TextureUse> {
        input.texture.as_ref().map(|(texture, _)| texture)
    }
    let mut uses = match &material.surface {
        SurfaceDesc::MetallicRoughness(surface) => vec![
            color(&surface.base_color),
            scalar(&surface.metallic),
            scalar(&surface.roughness),
            scalar(&surface.specular),
            color(&surface.specular_color),
            scalar(&surface.transmission),
        ],
        SurfaceDesc::Phong(phong) => vec![
            color(&phong.diffuse),
            color(&phong.specular),
            scalar(&phong.exponent),
        ],
        SurfaceDesc::Dielectric { .. } => Vec::new(),
    };
    uses.push(color(&material.emission));
    uses.push(scalar(&material.alpha));
    uses.push(material.normal_map.as_ref().map(|map| &map.texture));
    uses.into_iter().flatten().collect()
}

/// Warns where a mesh lacks the coordinates that its material's textures are read with.
pub(super) fn warn_about_missing_uvs(
    material: &MaterialDesc,
    uvs: &[Option<Vec<Vec2>>; 2],
    place: &str,
    warnings: &mut Warnings,
) {
    for (set, values) in uvs.iter().enumerate() {
        if values.is_none()
            && texture_uses(material)
                .iter()
                .any(|texture| texture.uv_set == set)
        {
            let message = format!(
                "lacks TEXCOORD_{set}, which the textures of material \"{}\" are read with; (0, 0) is used",
                material.name
            );
            warnings.push(place, message);
        }
    }
}
