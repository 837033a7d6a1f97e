//! One MTL material: its statements as a description.

use std::ops::RangeInclusive;

use super::illumination::Illumination;
use super::inputs::{BlackBesideMap, Inputs};
use super::statements::Statements;
use super::textures::Textures;
use super::transparency::{self, Transparency};
use crate::desc::{
    AlphaMode, ColorInput, MaterialDesc, MetallicRoughness, PhongSurface, ScalarInput, SurfaceDesc,
};

/// Reflectance where a file gives none.
const GREY: f32 = 0.8;

/// How rough sheen is, of which files say no more than how strong it is.
const SHEEN_ROUGHNESS: f32 = 0.5;

/// The index of refraction where a file gives none.
const DEFAULT_IOR: f32 = 1.5;

/// The exponent of a highlight where a file gives none.
const DEFAULT_EXPONENT: f32 = 30.0;

/// The exponent where a map of exponents is white and no number stands beside it: the largest that the format knows.
const LARGEST_EXPONENT: f32 = 1000.0;

/// Beyond this exponent, cosines of 32 bits do not tell the lobe from its surroundings: at 10⁸ it loses light, and at 10⁹
/// two thirds of it, while at 10⁶ it reflects what a mirror does, to 10⁻⁴, and is a twelfth of a degree wide.
const SHARPEST_EXPONENT: f32 = 1e6;

/// The indices of refraction that the format knows; those of materials are from 1 to 5.
const INDICES_OF_REFRACTION: RangeInclusive<f32> = 0.001..=10.0;

/// `illum` 3, 5 and 8 are a mirror from this exponent on. Programs write `illum` 3 for every metal, and exponents up to
/// 1000 for how smooth it is.
const MIRROR_EXPONENT: f32 = 900.0;

/// Reads a material.
pub(super) fn read(statements: Statements<'_>, textures: &mut Textures<'_>) -> MaterialDesc {
    let inputs = &mut Inputs {
        statements,
        textures,
    };
    let illumination = Illumination::new(inputs.statements.number("illum").unwrap_or(2.0));
    let (surface, alpha) = match transparency::read(inputs, illumination) {
        Transparency::Dissolve { opacity } => {
            let surface = opaque_surface(inputs, illumination);
            let texture = inputs.alpha_map();
            let factor = opacity;
            (surface, ScalarInput { factor, texture })
        }
        Transparency::Glass { tint } => (glass(inputs, tint), ScalarInput::constant(1.0)),
    };
    let emission = inputs.color("ke", "map_ke", 0.0, BlackBesideMap::Nothing);
    let normal_map = inputs.normal_map();
    inputs.statements.warn_about_unread();
    MaterialDesc {
        name: inputs.statements.material().name.clone(),
        surface,
        emission,
        alpha_mode: match alpha.factor < 1.0 || alpha.texture.is_some() {
            true => AlphaMode::Blend,
            false => AlphaMode::Opaque,
        },
        alpha,
        normal_map,
        double_sided: true,
    }
}

/// A smooth dielectric. Its highlights are reflections, which `Ni` gives.
fn glass(inputs: &mut Inputs<'_, '_>, transmittance: [f32; 3]) -> SurfaceDesc {
    inputs.statements.dismiss(&["ks", "map_ks", "ns", "map_ns"]);
    SurfaceDesc::Dielectric {
        ior: ior(inputs),
        transmittance,
    }
}

fn opaque_surface(inputs: &mut Inputs<'_, '_>, illumination: Illumination) -> SurfaceDesc {
    let diffuse = inputs.color("kd", "map_kd", GREY, BlackBesideMap::Nothing);
    if ["pr", "pm", "map_pr", "map_pm"]
        .into_iter()
        .any(|key| inputs.statements.has(key))
    {
        return metallic_roughness(inputs, diffuse);
    }
    let specular = match illumination {
        Illumination::Diffuse => {
            inputs.statements.dismiss(&["ks", "map_ks", "ns", "map_ns"]);
            ColorInput::constant([0.0; 3])
        }
        _ => inputs.color("ks", "map_ks", 0.0, BlackBesideMap::Black),
    };
    let has_specular = specular.factor != [0.0; 3];
    let exponent_map = inputs.scalar_map("map_ns", |map| map);
    let exponent = inputs.statements.number("ns");
    let is_smooth = exponent.is_none_or(|exponent| exponent >= MIRROR_EXPONENT);
    if illumination == Illumination::Reflection && is_smooth && exponent_map.is_none() {
        return SurfaceDesc::Mirror {
            diffuse,
            reflectance: specular,
        };
    }
    let factor = exponent.unwrap_or(match exponent_map {
        Some(_) => LARGEST_EXPONENT,
        None => DEFAULT_EXPONENT,
    });
    if has_specular && exponent.is_none() {
        inputs
            .statements
            .warn(format!("Ks without Ns: an exponent of {factor} is used"));
    }
    if factor < 0.0 {
        inputs
            .statements
            .warn(format!("Ns {factor} is negative; 0 is used"));
    }
    if factor > SHARPEST_EXPONENT && has_specular {
        inputs.statements.warn(format!(
            "Ns {factor} is sharper than can be rendered; {SHARPEST_EXPONENT} is used"
        ));
    }
    SurfaceDesc::Phong(PhongSurface {
        diffuse,
        specular,
        exponent: ScalarInput {
            factor: factor.clamp(0.0, SHARPEST_EXPONENT),
            texture: exponent_map,
        },
    })
}

/// `Pr` and `Pm`, the extension for physically based materials, are the roughness and metalness of glTF; `Ks` and `Ns`
/// are there for programs that do not know them.
fn metallic_roughness(inputs: &mut Inputs<'_, '_>, base_color: ColorInput) -> SurfaceDesc {
    inputs.statements.dismiss(&["ks", "map_ks", "ns", "map_ns"]);
    let sheen = inputs.fraction("ps").unwrap_or_default();
    let rotation = inputs.statements.number("anisor").unwrap_or_default();
    // 1 is written for every material.
    let ior = match ior(inputs) {
        ior if ior > 1.0 => ior,
        _ => DEFAULT_IOR,
    };
    SurfaceDesc::MetallicRoughness(MetallicRoughness {
        base_color,
        metallic: inputs.fraction_input("pm", "map_pm", 0.0),
        roughness: inputs.fraction_input("pr", "map_pr", 0.5),
        ior,
        anisotropy: inputs.fraction_input("aniso", "map_aniso", 0.0),
        // In turns.
        anisotropy_rotation: rotation * std::f32::consts::TAU,
        sheen_color: ColorInput::constant([sheen; 3]),
        sheen_roughness: ScalarInput::constant(SHEEN_ROUGHNESS),
        clearcoat: inputs.fraction_input("pc", "map_pc", 0.0),
        clearcoat_roughness: inputs.fraction_input("pcr", "map_pcr", 0.0),
        ..MetallicRoughness::default()
    })
}

fn ior(inputs: &mut Inputs<'_, '_>) -> f32 {
    let Some(given) = inputs.statements.number("ni") else {
        return DEFAULT_IOR;
    };
    let (least, largest) = INDICES_OF_REFRACTION.into_inner();
    let (used, problem) = match given {
        ..=0.0 => (DEFAULT_IOR, "is not positive"),
        _ => (given.clamp(least, largest), "is none of a material"),
    };
    if used != given {
        let message = format!("Ni {given} {problem}; {used} is used");
        inputs.statements.warn(message);
    }
    used
}
