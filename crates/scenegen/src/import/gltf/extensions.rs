//! Which glTF extensions we read, and what is said about the others.

use std::collections::HashSet;
use std::path::Path;

use gltf::json::{Root, Value};
use serde_json::Map;

use crate::import::error::ImportError;
use crate::import::warnings::Warnings;

/// What becomes of an extension.
enum Support {
    /// Its effect is imported.
    Imported,
    /// It has no effect on a still image.
    WithoutEffect,
    /// Not rendered, and whoever comes upon its use says so.
    ReportedWhereUsed,
    /// None of these.
    Unknown,
}

impl Support {
    fn of(extension: &str) -> Self {
        match extension {
            "EXT_lights_area"
            | "EXT_mesh_gpu_instancing"
            | "EXT_meshopt_compression"
            | "KHR_meshopt_compression"
            | "EXT_texture_webp"
            | "KHR_draco_mesh_compression"
            | "KHR_lights_punctual"
            | "KHR_materials_anisotropy"
            | "KHR_materials_clearcoat"
            | "KHR_materials_diffuse_roughness"
            | "KHR_materials_diffuse_transmission"
            | "KHR_materials_dispersion"
            | "KHR_materials_emissive_strength"
            | "KHR_materials_ior"
            | "KHR_materials_iridescence"
            | "KHR_materials_sheen"
            | "KHR_materials_specular"
            | "KHR_materials_pbrSpecularGlossiness"
            | "KHR_materials_transmission"
            | "KHR_materials_unlit"
            | "KHR_materials_variants"
            | "KHR_materials_volume"
            | "KHR_materials_volume_scatter"
            | "KHR_mesh_quantization"
            | "KHR_node_visibility"
            | "KHR_texture_basisu"
            | "KHR_texture_transform" => Self::Imported,
            "EXT_feature_metadata"
            | "EXT_mesh_features"
            | "EXT_structural_metadata"
            | "FB_ngon_encoding"
            | "KHR_animation_pointer"
            | "KHR_xmp"
            | "KHR_xmp_json_ld" => Self::WithoutEffect,
            "MSFT_texture_dds" => Self::ReportedWhereUsed,
            _ => Self::Unknown,
        }
    }
}

/// Refuses a file that cannot be shown without an extension that we lack.
pub(super) fn check_required(root: &Root, file: &Path) -> Result<(), ImportError> {
    for extension in &root.extensions_required {
        match Support::of(extension) {
            Support::Imported | Support::WithoutEffect => {}
            Support::ReportedWhereUsed | Support::Unknown => {
                return Err(ImportError::UnsupportedExtension {
                    file: file.to_owned(),
                    extension: extension.clone(),
                    advice: advice(extension),
                });
            }
        }
    }
    Ok(())
}

fn advice(extension: &str) -> &'static str {
    match extension {
        "MSFT_texture_dds" => "convert its textures to PNG, JPEG or WebP",
        _ => "export the file without it",
    }
}

/// Warns about what the file uses as a whole and is not imported.
pub(super) fn warn_about_root(root: &Root, warnings: &mut Warnings) {
    let used_in_place = used_in_place(root);
    for extension in &root.extensions_used {
        let is_unknown = matches!(Support::of(extension), Support::Unknown);
        if is_unknown && !used_in_place.contains(extension.as_str()) {
            warnings.push(
                "extensionsUsed",
                format!("{extension} is not supported and ignored"),
            );
        }
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
    for extension in others.keys() {
        match Support::of(extension) {
            // Whoever reads it says what it lacks.
            Support::Imported => continue,
            Support::WithoutEffect | Support::ReportedWhereUsed | Support::Unknown => {}
        }
        warnings.push(
            place,
            format!("{extension} is not supported; rendered without it"),
        );
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
        match Support::of(extension) {
            Support::WithoutEffect => {
                warnings.dismiss(None, place, format!("{extension} changes no image"));
            }
            _ => warnings.push(place, format!("{extension} is not supported and ignored")),
        }
    }
}

/// Why an extension changes nothing whose factor is 0.
pub(super) fn without_effect(extension: &str) -> String {
    format!("{extension} is there, and its factor is 0")
}
