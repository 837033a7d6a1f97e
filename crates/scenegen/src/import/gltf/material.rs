//! One glTF material: its surface, emission, alpha and normal map.

use gltf::json::Material;
use gltf::json::extensions::material::Material as Extensions;
use gltf::json::material::AlphaMode as JsonAlphaMode;
use gltf::json::texture::Info;
use gltf::json::validation::Checked;

use super::members::Members;
use super::{extensions, surface};
use crate::desc::{AlphaMode, ColorInput, MaterialDesc, NormalMap, ScalarInput, SurfaceDesc};
use crate::effect::Effect;
use crate::import::error::Fault;

/// Reads a material.
pub(super) fn read(
    material: &Material,
    name: String,
    members: &mut Members<'_, '_>,
) -> Result<MaterialDesc, Fault> {
    let used = material.extensions.clone().unwrap_or_default();
    extensions::warn_about_material(&used.others, &members.place, members.warnings);

    // Files with both say the same in two ways, the second for readers who do not know the first.
    let glossy = used.pbr_specular_glossiness.as_ref();
    let base = match glossy {
        Some(glossy) => Base {
            name: "diffuse",
            factor: glossy.diffuse_factor.0,
            texture: glossy.diffuse_texture.as_ref(),
        },
        None => Base {
            name: "baseColor",
            factor: material.pbr_metallic_roughness.base_color_factor.0,
            texture: material.pbr_metallic_roughness.base_color_texture.as_ref(),
        },
    };
    let factor_name = format!("{}Factor", base.name);
    let texture = members.texture(&format!("{}Texture", base.name), base.texture)?;
    let [red, green, blue, alpha] = base.factor;
    let color = ColorInput {
        factor: members.color(&factor_name, [red, green, blue], 0.0..=1.0, 1.0),
        texture: texture.clone(),
    };
    let alpha = ScalarInput {
        factor: members.number(&factor_name, alpha, 0.0..=1.0, 1.0),
        texture: texture.map(|texture| (texture, 3)),
    };
    let (surface, emission) = match (&used.unlit, glossy) {
        (Some(_), _) => (SurfaceDesc::Unlit, color),
        (None, Some(glossy)) => (
            surface::specular_glossiness(glossy, color, members)?,
            emission(material, &used, members)?,
        ),
        (None, None) => (
            surface::read(material, &used, color, members)?,
            emission(material, &used, members)?,
        ),
    };
    Ok(MaterialDesc {
        name,
        emission,
        alpha_mode: alpha_mode(material, members),
        alpha,
        normal_map: match surface {
            // Nothing is lit from anywhere.
            SurfaceDesc::Unlit => None,
            _ => normal_map(material, members)?,
        },
        surface,
        double_sided: material.double_sided,
    })
}

/// The colour that both material models have, with its alpha.
struct Base<'a> {
    /// What its members begin with.
    name: &'static str,
    factor: [f32; 4],
    texture: Option<&'a Info>,
}

fn emission(
    material: &Material,
    extensions: &Extensions,
    members: &mut Members<'_, '_>,
) -> Result<ColorInput, Fault> {
    let strength = extensions
        .emissive_strength
        .as_ref()
        .map_or(1.0, |extension| extension.emissive_strength.0);
    let strength = members.number("emissiveStrength", strength, 0.0..=f32::MAX, 1.0);
    let factor = material.emissive_factor.0;
    let factor = members.color("emissiveFactor", factor, 0.0..=f32::MAX, 0.0);
    if strength == 0.0 && factor != [0.0; 3] {
        let effect = Some(Effect::EmittingSurfaces);
        members
            .warnings
            .dismiss(effect, &*members.place, "emissiveStrength is 0");
    }
    let factor = factor.map(|factor| (factor * strength).min(f32::MAX));
    let texture = if factor == [0.0; 3] {
        None
    } else {
        members.texture("emissiveTexture", material.emissive_texture.as_ref())?
    };
    Ok(ColorInput { factor, texture })
}

fn alpha_mode(material: &Material, members: &mut Members<'_, '_>) -> AlphaMode {
    match material.alpha_mode {
        Checked::Valid(JsonAlphaMode::Opaque) => AlphaMode::Opaque,
        Checked::Valid(JsonAlphaMode::Mask) => {
            let cutoff = material.alpha_cutoff.map_or(0.5, |cutoff| cutoff.0);
            AlphaMode::Mask(members.number("alphaCutoff", cutoff, 0.0..=f32::MAX, 0.5))
        }
        Checked::Valid(JsonAlphaMode::Blend) => AlphaMode::Blend,
        Checked::Invalid => {
            members.warn("alphaMode is unknown; OPAQUE is used");
            AlphaMode::Opaque
        }
    }
}

fn normal_map(
    material: &Material,
    members: &mut Members<'_, '_>,
) -> Result<Option<NormalMap>, Fault> {
    let Some(texture) = &material.normal_texture else {
        return Ok(None);
    };
    let scale = members.number(
        "normalTexture/scale",
        texture.scale,
        f32::MIN..=f32::MAX,
        1.0,
    );
    let texture = members.normal_texture("normalTexture", texture)?;
    Ok(texture.map(|texture| NormalMap { texture, scale }))
}
