//! KHR_materials_variants: other materials for the same meshes, of which the user may name one set.

use gltf::json::mesh::Primitive;
use gltf::json::{Index, Material, Root, Value};

use crate::import::error::Fault;
use crate::import::warnings::Warnings;

/// The extension's name.
pub(super) const EXTENSION: &str = "KHR_materials_variants";

/// The index of the variant of this name; `None` where none is asked for.
pub(super) fn chosen(
    root: &Root,
    wanted: Option<&str>,
    warnings: &mut Warnings,
) -> Result<Option<usize>, Fault> {
    let at = format!("extensions/{EXTENSION}/variants");
    let extensions = root.extensions.as_ref();
    let extension = extensions.and_then(|extensions| extensions.others.get(EXTENSION));
    let variants = extension.and_then(|extension| extension.get("variants")?.as_array());
    let names: Vec<&str> = variants
        .into_iter()
        .flatten()
        .map(|variant| variant.get("name").and_then(Value::as_str).unwrap_or(""))
        .collect();
    let quoted: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
    let available = match quoted.is_empty() {
        true => "none".to_owned(),
        false => quoted.join(", "),
    };
    let Some(wanted) = wanted else {
        if !names.is_empty() {
            let reason = format!("no variant is asked for; --variant shows one of {available}");
            warnings.dismiss(None, at, reason);
        }
        return Ok(None);
    };
    let found = names.iter().position(|name| *name == wanted);
    let lower = wanted.to_lowercase();
    let found = found.or_else(|| names.iter().position(|name| name.to_lowercase() == lower));
    found.map(Some).ok_or_else(|| {
        let problem = format!("there is no {wanted:?}, but {available}");
        Fault::new(at, problem).advise("name one of these with --variant, or none")
    })
}

/// The material of a primitive in a variant; its own where the variant does not change it.
pub(super) fn material(primitive: &Primitive, variant: Option<usize>) -> Option<Index<Material>> {
    let mapped = || {
        let wanted = variant? as u64;
        let extensions = primitive.extensions.as_ref()?;
        let mappings = extensions.others.get(EXTENSION)?.get("mappings")?;
        let names_it = |mapping: &&Value| {
            let variants = mapping.get("variants").and_then(Value::as_array);
            variants.is_some_and(|list| list.iter().any(|index| index.as_u64() == Some(wanted)))
        };
        let mapping = mappings.as_array()?.iter().find(names_it)?;
        let index = u32::try_from(mapping.get("material")?.as_u64()?).ok()?;
        Some(Index::new(index))
    };
    mapped().or(primitive.material)
}
