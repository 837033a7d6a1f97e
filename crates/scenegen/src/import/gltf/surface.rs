//! How a glTF material scatters light: metallic-roughness with the extensions that we render.

use gltf::json::Material;
use gltf::json::extensions::material::{
    Ior, Material as Extensions, PbrSpecularGlossiness, Volume,
};

use serde_json::Value;

use super::layers;
use super::members::Members;
use crate::desc::{Attenuation, ColorInput, MetallicRoughness, ScalarInput, SurfaceDesc};
use crate::import::error::Fault;

/// Of a texture's channels, the one that holds roughness: green.
const ROUGHNESS_CHANNEL: usize = 1;

/// The index of refraction where KHR_materials_ior gives none.
const DEFAULT_IOR: f32 = 1.5;

/// Reads how a material of metallic-roughness scatters light, all but its base colour.
pub(super) fn read(
    material: &Material,
    extensions: &Extensions,
    base_color: ColorInput,
    members: &mut Members<'_, '_>,
) -> Result<SurfaceDesc, Fault> {
    let surface = metallic_roughness(material, extensions, base_color, members)?;
    Ok(SurfaceDesc::MetallicRoughness(surface))
}

/// KHR_materials_pbrSpecularGlossiness, of which metallic-roughness with its extensions has all: a dielectric whose
/// reflection at normal incidence is the specular colour.
pub(super) fn specular_glossiness(
    extension: &PbrSpecularGlossiness,
    diffuse: ColorInput,
    members: &mut Members<'_, '_>,
) -> Result<SurfaceDesc, Fault> {
    let glossiness = members.number(
        "glossinessFactor",
        extension.glossiness_factor.0,
        0.0..=1.0,
        1.0,
    );
    let texture = extension.specular_glossiness_texture.as_ref();
    let specular_texture = members.texture("specularGlossinessTexture", texture)?;
    let roughness_texture =
        members.roughness_texture("specularGlossinessTexture", texture, glossiness)?;
    Ok(SurfaceDesc::MetallicRoughness(MetallicRoughness {
        base_color: diffuse,
        metallic: ScalarInput::constant(0.0),
        roughness: match roughness_texture {
            Some(texture) => ScalarInput {
                factor: 1.0,
                texture: Some((texture, ROUGHNESS_CHANNEL)),
            },
            None => ScalarInput::constant(1.0 - glossiness),
        },
        // Fresnel 1, so that the colour alone says what is reflected.
        ior: 0.0,
        specular: ScalarInput::constant(1.0),
        specular_color: ColorInput {
            factor: members.color(
                "specularFactor",
                extension.specular_factor.0,
                0.0..=1.0,
                1.0,
            ),
            texture: specular_texture,
        },
        ..MetallicRoughness::default()
    }))
}

fn metallic_roughness(
    material: &Material,
    extensions: &Extensions,
    base_color: ColorInput,
    members: &mut Members<'_, '_>,
) -> Result<MetallicRoughness, Fault> {
    let pbr = &material.pbr_metallic_roughness;
    let texture = members.texture(
        "metallicRoughnessTexture",
        pbr.metallic_roughness_texture.as_ref(),
    )?;
    let metallic = members.number("metallicFactor", pbr.metallic_factor.0, 0.0..=1.0, 1.0);
    let roughness = members.number("roughnessFactor", pbr.roughness_factor.0, 0.0..=1.0, 1.0);

    let specular = extensions.specular.clone().unwrap_or_default();
    let specular_texture =
        members.texture("specularTexture", specular.specular_texture.as_ref())?;
    let specular_color_texture = members.texture(
        "specularColorTexture",
        specular.specular_color_texture.as_ref(),
    )?;
    let transmission = extensions.transmission.clone().unwrap_or_default();
    let transmission_texture = members.texture(
        "transmissionTexture",
        transmission.transmission_texture.as_ref(),
    )?;
    let transmission_factor = members.number(
        "transmissionFactor",
        transmission.transmission_factor.0,
        0.0..=1.0,
        0.0,
    );
    let (solid, attenuation) = volume(members, extensions.volume.as_ref());
    let surface = MetallicRoughness {
        base_color,
        metallic: ScalarInput {
            factor: metallic,
            texture: texture.clone().map(|texture| (texture, 2)),
        },
        roughness: ScalarInput {
            factor: roughness,
            texture: texture.map(|texture| (texture, ROUGHNESS_CHANNEL)),
        },
        ior: ior(members, extensions.ior.as_ref()),
        specular: ScalarInput {
            factor: members.number("specularFactor", specular.specular_factor.0, 0.0..=1.0, 1.0),
            texture: specular_texture.map(|texture| (texture, 3)),
        },
        specular_color: ColorInput {
            factor: members.color(
                "specularColorFactor",
                specular.specular_color_factor.0,
                0.0..=f32::MAX,
                1.0,
            ),
            texture: specular_color_texture,
        },
        transmission: ScalarInput {
            factor: transmission_factor,
            texture: transmission_texture.map(|texture| (texture, 0)),
        },
        solid,
        attenuation,
        priority: priority(material, members),
        ..MetallicRoughness::default()
    };
    layers::read(surface, &extensions.others, members)
}

/// What is left of light that a solid absorbs wholly after the attenuation distance: more than nothing, of which there would
/// be no logarithm.
const LEAST_ATTENUATION_COLOR: f32 = 1e-5;

/// KHR_materials_volume: whether the surface bounds a solid, and what that absorbs.
fn volume(members: &mut Members<'_, '_>, volume: Option<&Volume>) -> (bool, Option<Attenuation>) {
    let Some(volume) = volume else {
        return (false, None);
    };
    let thickness = volume.thickness_factor.0;
    let thickness = members.number("thicknessFactor", thickness, 0.0..=f32::MAX, 0.0);
    let color = members.color(
        "attenuationColor",
        volume.attenuation_color.0,
        0.0..=1.0,
        1.0,
    );
    let distance = volume.attenuation_distance.0;
    if color == [1.0; 3] || distance == f32::INFINITY {
        return (thickness > 0.0, None);
    }
    if distance.is_nan() || distance <= 0.0 {
        members.warn(format!(
            "attenuationDistance {distance} is not positive; nothing is absorbed"
        ));
        return (thickness > 0.0, None);
    }
    let attenuation = Attenuation {
        color: color.map(|c| c.max(LEAST_ATTENUATION_COLOR)),
        distance,
    };
    (thickness > 0.0, Some(attenuation))
}

/// `extras.priority`, a whole number: glTF has no member for it, and this is what other renderers call it; as there, the higher
/// goes before.
fn priority(material: &Material, members: &mut Members<'_, '_>) -> i32 {
    let extras = material.extras.as_ref();
    let extras = extras.and_then(|json| serde_json::from_str::<Value>(json.get()).ok());
    let Some(given) = extras.as_ref().and_then(|extras| extras.get("priority")) else {
        return 0;
    };
    let number = given.as_f64().filter(|number| number.fract() == 0.0);
    let number = number.filter(|number| number.abs() <= f64::from(i32::MAX));
    number.map_or_else(
        || {
            members.warn(format!(
                "extras.priority {given} is no whole number; 0 is used"
            ));
            0
        },
        |number| number as i32,
    )
}

/// KHR_materials_ior: 0, which stands for Fresnel 1, or at least 1.
fn ior(members: &mut Members<'_, '_>, extension: Option<&Ior>) -> f32 {
    let ior = extension.map_or(DEFAULT_IOR, |extension| extension.ior.0);
    if ior == 0.0 || (ior >= 1.0 && ior.is_finite()) {
        return ior;
    }
    members.warn(format!(
        "ior {ior} is neither 0 nor at least 1; {DEFAULT_IOR} is used"
    ));
    DEFAULT_IOR
}
