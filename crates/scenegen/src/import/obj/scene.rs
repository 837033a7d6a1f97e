//! An OBJ file as a scene description: the pieces of this folder put together.

use std::collections::HashSet;
use std::path::Path;

use glam::DAffine3;

use super::lines::line_place;
use super::materials::Materials;
use super::mtl::MtlMaterial;
use super::{models, source};
use crate::desc::{MeshDesc, SceneDesc};
use crate::import::budget::Budget;
use crate::import::error::{Fault, ImportError, MAKE_SMALLER};
use crate::import::instances::place_mesh;
use crate::import::warnings::Warnings;
use crate::import::{files, mesh};

/// tobj needs several times a file's size.
const MAX_OBJ_BYTES: usize = 256 << 20;

/// Reads an `.obj` file and its material libraries.
pub(in crate::import) fn import(
    file: &Path,
    warnings: &mut Warnings,
) -> Result<SceneDesc, ImportError> {
    let bytes = files::read(file).map_err(|message| ImportError::Io {
        file: file.to_owned(),
        message,
    })?;
    let folder = file.parent().unwrap_or(Path::new(""));
    read(bytes, folder, warnings).map_err(|fault| fault.in_file(file))
}

fn read(bytes: Vec<u8>, folder: &Path, warnings: &mut Warnings) -> Result<SceneDesc, Fault> {
    if bytes.len() > MAX_OBJ_BYTES {
        let problem = format!("{} bytes are more than the 256 MiB we read", bytes.len());
        return Err(Fault::new("file", problem).advise(MAKE_SMALLER));
    }
    let source = source::clean(&bytes, warnings)?;
    drop(bytes);
    let (models, library) = models::load(&source.text, folder, warnings)?;
    warn_about_unknown_materials(&source.used_materials, &library, warnings);
    build(models, &library, folder, warnings)
}

/// Once for each name: files repeat it thousands of times.
fn warn_about_unknown_materials(
    used: &[(usize, String)],
    library: &[MtlMaterial],
    warnings: &mut Warnings,
) {
    let mut known: HashSet<&str> = library
        .iter()
        .map(|material| material.name.as_str())
        .collect();
    for (line, name) in used {
        if known.insert(name) {
            warnings.push(
                line_place(*line),
                format!("material \"{name}\" is in no library; grey is used"),
            );
        }
    }
}

fn build(
    models: Vec<tobj::Model>,
    library: &[MtlMaterial],
    folder: &Path,
    warnings: &mut Warnings,
) -> Result<SceneDesc, Fault> {
    let mut scene = SceneDesc::default();
    let mut materials = Materials::new(library, folder);
    let mut budget = Budget::geometry();
    for model in models
        .into_iter()
        .filter(|model| !model.mesh.indices.is_empty())
    {
        let place = format!("o \"{}\"", model.name.escape_debug());
        budget.charge(model.mesh.indices.len() as u64, 4 + 14 * 4, &place)?;
        let raw = models::raw_mesh(&model.mesh, &place, warnings);
        let (material_index, material) = materials.get(model.mesh.material_id, warnings);
        let name = model.name.clone();
        let Some(mesh) = mesh::finish(raw, name, material, &place, &mut budget, warnings)? else {
            continue;
        };
        scene.meshes.push(MeshDesc {
            material: material_index,
            ..mesh
        });
        scene.instances.extend(place_mesh(
            &scene.meshes,
            scene.meshes.len() - 1,
            &model.name,
            &DAffine3::IDENTITY,
            &place,
            warnings,
        ));
    }
    materials.dismiss_unused(warnings);
    (scene.materials, scene.textures, scene.images) = materials.finish(warnings);
    Ok(scene)
}
