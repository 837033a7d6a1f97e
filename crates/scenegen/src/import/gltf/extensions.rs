//! Which glTF extensions we read, and what is said about the others.

use std::collections::HashSet;
use std::path::Path;

use gltf::json::{Root, Value};
use serde_json::Map;

use crate::import::error::{ImportError, Warnings};

/// Extensions whose effect is imported.
const SUPPORTED: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// Extensions without an effect on a still image.
const WITHOUT_EFFECT: &[&str] = &["KHR_xmp", "KHR_xmp_json_ld", "KHR_animation_pointer"];

/// Material extensions that are not rendered, with the member that switches them on.
const MATERIAL_SWITCHES: &[(&str, &str)] = &[
    ("KHR_materials_anisotropy", "anisotropyStrength"),
    ("KHR_materials_clearcoat", "clearcoatFactor"),
    (
        "KHR_materials_diffuse_transmission",
        "diffuseTransmissionFactor",
    ),
    ("KHR_materials_dispersion", "dispersion"),
    ("KHR_materials_iridescence", "iridescenceFactor"),
    ("KHR_materials_sheen", "sheenColorFactor"),
];

/// Extensions about which the places that use them warn, so that the root need not.
const REPORTED_IN_PLACE: &[&str] = &[
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "MSFT_texture_dds",
];

/// Refuses a file that cannot be shown without an extension that we lack.
pub(super) fn check_required(root: &Root, file: &Path) -> Result<(), ImportError> {
    for extension in &root.extensions_required {
        if !SUPPORTED.contains(&extension.as_str()) && !WITHOUT_EFFECT.contains(&extension.as_str())
        {
            return Err(ImportError::UnsupportedExtension {
                file: file.to_owned(),
                extension: extension.clone(),
                advice: advice(extension),
            });
        }
    }
    Ok(())
}

fn advice(extension: &str) -> &'static str {
    match extension {
        "EXT_meshopt_compression" | "KHR_meshopt_compression" | "KHR_draco_mesh_compression" => {
            "decompress it first, for example with `gltf-transform copy in.glb out.glb`"
        }
        "KHR_materials_pbrSpecularGlossiness" => {
            "convert it first, for example with `gltf-transform metalrough in.glb out.glb`"
        }
        "KHR_texture_basisu" => "convert its textures to PNG, JPEG or WebP",
        _ => "export the file without it",
    }
}

/// Warns about what the file uses as a whole and is not imported.
pub(super) fn warn_about_root(root: &Root, warnings: &mut Warnings) {
    let used_in_place = used_in_place(root);
    for extension in &root.extensions_used {
        let known = SUPPORTED.contains(&extension.as_str())
            || WITHOUT_EFFECT.contains(&extension.as_str())
            || REPORTED_IN_PLACE.contains(&extension.as_str())
            || MATERIAL_SWITCHES.iter().any(|(name, _)| name == extension);
        if !known && !used_in_place.contains(extension.as_str()) {
            warnings.push(
                "extensionsUsed",
                format!("{extension} is not supported and ignored"),
            );
        }
    }
    if !root.animations.is_empty() {
        warnings.push(
            "animations",
            "not supported; the scene is shown as its nodes stand",
        );
    }
}

/// Extensions of materials and nodes, where the warning then names the material or node.
fn used_in_place(root: &Root) -> HashSet<&str> {
    let in_materials = root
        .materials
        .iter()
        .filter_map(|material| Some(&material.extensions.as_ref()?.others));
    let in_nodes = root
        .nodes
        .iter()
        .filter_map(|node| Some(&node.extensions.as_ref()?.others));
    in_materials
        .chain(in_nodes)
        .flat_map(|others| others.keys().map(String::as_str))
        .collect()
}

/// Warns about extensions of a material that have an effect and are not rendered.
pub(super) fn warn_about_material(
    others: &Map<String, Value>,
    place: &str,
    warnings: &mut Warnings,
) {
    for (extension, content) in others {
        let effective = match MATERIAL_SWITCHES.iter().find(|(name, _)| name == extension) {
            Some((_, switch)) => content.get(switch).is_some_and(is_not_zero),
            None => true,
        };
        if effective {
            let message = match extension.as_str() {
                "KHR_materials_pbrSpecularGlossiness" => {
                    "KHR_materials_pbrSpecularGlossiness is not supported; the metallic-roughness values are used"
                        .into()
                }
                _ => format!("{extension} is not supported; rendered without it"),
            };
            warnings.push(place, message);
        } else {
            let reason = format!("{extension} is there, and its factor is 0");
            warnings.dismiss(None, place, reason);
        }
    }
}

/// Warns about extensions of something that are not in `known`.
pub(super) fn warn_about_others(
    others: &Map<String, Value>,
    known: &[&str],
    place: &str,
    warnings: &mut Warnings,
) {
    for extension in others
        .keys()
        .filter(|extension| !known.contains(&extension.as_str()))
    {
        warnings.push(place, format!("{extension} is not supported and ignored"));
    }
}

fn is_not_zero(value: &Value) -> bool {
    match value {
        Value::Number(number) => number.as_f64() != Some(0.0),
        Value::Array(items) => items.iter().any(is_not_zero),
        Value::Null | Value::Bool(_) | Value::String(_) | Value::Object(_) => false,
    }
}
