//! Layers and lobes of a material that extensions add, whose JSON the `gltf` crate leaves as it is.

use serde_json::{Map, Value};

use super::extension_members::ExtensionMembers;
use super::extensions;
use super::members::Members;
use crate::desc::{MetallicRoughness, Scattering};
use crate::effect::Effect;
use crate::import::error::Fault;

/// The surface with what these extensions say of it.
pub(super) fn read(
    mut surface: MetallicRoughness,
    extensions: &Map<String, Value>,
    members: &mut Members<'_, '_>,
) -> Result<MetallicRoughness, Fault> {
    let of = |name| ExtensionMembers::of(extensions, name);
    if let Some(extension) = of("KHR_materials_diffuse_roughness") {
        surface.diffuse_roughness = extension.scalar(
            members,
            ["diffuseRoughnessFactor", "diffuseRoughnessTexture"],
            (0.0..=1.0, 0.0),
            0,
        )?;
        if surface.diffuse_roughness.factor > 0.0 {
            members.warn("KHR_materials_diffuse_roughness is a draft, which may change".to_owned());
        }
    }
    if let Some(extension) = of("KHR_materials_diffuse_transmission") {
        surface.diffuse_transmission = extension.scalar(
            members,
            ["diffuseTransmissionFactor", "diffuseTransmissionTexture"],
            (0.0..=1.0, 0.0),
            3,
        )?;
        surface.diffuse_transmission_color = extension.color(
            members,
            [
                "diffuseTransmissionColorFactor",
                "diffuseTransmissionColorTexture",
            ],
            [1.0; 3],
        )?;
    }
    if let Some(extension) = of("KHR_materials_volume_scatter") {
        surface.scattering = scattering(&extension, members);
    }
    if let Some(extension) = of("KHR_materials_dispersion") {
        surface.dispersion = extension.number(members, "dispersion", (0.0..=f32::MAX, 0.0));
    }
    if let Some(extension) = of("KHR_materials_anisotropy") {
        surface.anisotropy = extension.scalar(
            members,
            ["anisotropyStrength", "anisotropyTexture"],
            (0.0..=1.0, 0.0),
            2,
        )?;
        let angles = f32::MIN..=f32::MAX;
        surface.anisotropy_rotation =
            extension.number(members, "anisotropyRotation", (angles, 0.0));
    }
    if let Some(extension) = of("KHR_materials_iridescence") {
        surface.iridescence = extension.scalar(
            members,
            ["iridescenceFactor", "iridescenceTexture"],
            (0.0..=1.0, 0.0),
            0,
        )?;
        surface.iridescence_ior =
            extension.number(members, "iridescenceIor", (1.0..=f32::MAX, 1.3));
        surface.iridescence_minimum = extension.number(
            members,
            "iridescenceThicknessMinimum",
            (0.0..=f32::MAX, 100.0),
        );
        surface.iridescence_thickness = extension.scalar(
            members,
            ["iridescenceThicknessMaximum", "iridescenceThicknessTexture"],
            (0.0..=f32::MAX, 400.0),
            1,
        )?;
    }
    if let Some(extension) = of("KHR_materials_sheen") {
        surface.sheen_color =
            extension.color(members, ["sheenColorFactor", "sheenColorTexture"], [0.0; 3])?;
        surface.sheen_roughness = extension.scalar(
            members,
            ["sheenRoughnessFactor", "sheenRoughnessTexture"],
            (0.0..=1.0, 0.0),
            3,
        )?;
    }
    if let Some(extension) = of("KHR_materials_clearcoat") {
        surface.clearcoat = extension.scalar(
            members,
            ["clearcoatFactor", "clearcoatTexture"],
            (0.0..=1.0, 0.0),
            0,
        )?;
        surface.clearcoat_roughness = extension.scalar(
            members,
            ["clearcoatRoughnessFactor", "clearcoatRoughnessTexture"],
            (0.0..=1.0, 0.0),
            1,
        )?;
        surface.clearcoat_normal = extension.normal_map(members, "clearcoatNormalTexture")?;
    }
    dismiss_without_effect(&surface, extensions, members);
    Ok(surface)
}

/// KHR_materials_volume_scatter, of which there are two drafts: the colour's member is named in both ways.
fn scattering(
    extension: &ExtensionMembers<'_>,
    members: &mut Members<'_, '_>,
) -> Option<Scattering> {
    let of_draft = |member: &&str| extension.has(member);
    let member = ["multiscatterColorFactor", "multiscatterColor"]
        .into_iter()
        .find(of_draft);
    let color = extension.factor(members, member.unwrap_or("multiscatterColor"), [0.0; 3]);
    if extension.has("multiscatterColorTexture") {
        members
            .warn("multiscatterColorTexture is ignored: bodies are the same throughout".to_owned());
    }
    let anisotropy = extension.number(members, "scatterAnisotropy", (-0.99..=0.99, 0.0));
    (color != [0.0; 3]).then_some(Scattering {
        multiscatter_color: color,
        anisotropy,
    })
}

/// Notes the extensions whose factor is 0.
fn dismiss_without_effect(
    surface: &MetallicRoughness,
    given: &Map<String, Value>,
    members: &mut Members<'_, '_>,
) {
    let switches = [
        (
            "KHR_materials_diffuse_roughness",
            Effect::RoughDiffuseReflection,
            surface.diffuse_roughness.factor,
        ),
        (
            "KHR_materials_diffuse_transmission",
            Effect::DiffuseTransmission,
            surface.diffuse_transmission.factor,
        ),
        (
            "KHR_materials_volume_scatter",
            Effect::ScatteringMedia,
            match (surface.attenuation, surface.scattering) {
                (Some(_), Some(_)) => 1.0,
                _ => 0.0,
            },
        ),
        (
            "KHR_materials_dispersion",
            Effect::Dispersion,
            surface.dispersion,
        ),
        (
            "KHR_materials_anisotropy",
            Effect::Anisotropy,
            surface.anisotropy.factor,
        ),
        (
            "KHR_materials_iridescence",
            Effect::Iridescence,
            surface.iridescence.factor,
        ),
        (
            "KHR_materials_sheen",
            Effect::Sheen,
            surface.sheen_color.factor.iter().sum(),
        ),
        (
            "KHR_materials_clearcoat",
            Effect::ClearCoat,
            surface.clearcoat.factor,
        ),
    ];
    for (extension, effect, factor) in switches {
        if factor == 0.0 && given.contains_key(extension) {
            let reason = extensions::without_effect(extension);
            members
                .warnings
                .dismiss(Some(effect), &*members.place, reason);
        }
    }
}
