//! OBJ files, with tobj for the geometry.

use std::cell::RefCell;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use glam::{DAffine3, Vec2, Vec3};

use super::materials::ObjMaterials;
use super::mtl::{self, MtlMaterial};
use super::source::{self, CountingLines, ObjSource, REPAIR_LINE};
use crate::desc::{MeshDesc, SceneDesc};
use crate::import::budget::Budget;
use crate::import::error::{Fault, ImportError, MAKE_SMALLER, Warnings};
use crate::import::files;
use crate::import::guard::without_panic;
use crate::import::instances::place_mesh;
use crate::import::mesh::{self, RawMesh};
use crate::import::texture_uses;

/// tobj needs several times a file's size.
const MAX_OBJ_BYTES: usize = 256 << 20;

/// More libraries than this are not read.
const MAX_LIBRARIES: usize = 1000;

/// Reads an `.obj` file and its material libraries.
pub(in crate::import) fn import(
    file: &Path,
    warnings: &mut Warnings,
) -> Result<SceneDesc, ImportError> {
    let bytes = files::read(file).map_err(|message| ImportError::Io {
        file: file.to_owned(),
        message,
    })?;
    if bytes.len() > MAX_OBJ_BYTES {
        let fault = Fault::new(
            "file",
            format!("{} bytes are more than the 256 MiB we read", bytes.len()),
        );
        return Err(fault.advise(MAKE_SMALLER).in_file(file));
    }
    let source = source::clean(&bytes, warnings).map_err(|fault| fault.in_file(file))?;
    drop(bytes);
    let folder = file.parent().unwrap_or(Path::new(""));
    let (models, materials) =
        load(&source, folder, warnings).map_err(|fault| fault.in_file(file))?;
    let mut known: HashSet<&str> = materials
        .iter()
        .map(|material| material.name.as_str())
        .collect();
    for (line, name) in &source.used_materials {
        // Once for each name: files repeat it thousands of times.
        if known.insert(name) {
            warnings.push(
                format!("line {line}"),
                format!("material \"{name}\" is in no library; grey is used"),
            );
        }
    }
    build(models, &materials, folder, warnings).map_err(|fault| fault.in_file(file))
}

fn load(
    source: &ObjSource,
    folder: &Path,
    warnings: &mut Warnings,
) -> Result<(Vec<tobj::Model>, Vec<MtlMaterial>), Fault> {
    let line = AtomicUsize::new(0);
    let library = RefCell::new((Vec::new(), HashSet::new(), warnings));
    let options = tobj::LoadOptions {
        ignore_points: true,
        ignore_lines: true,
        ..tobj::GPU_LOAD_OPTIONS
    };
    let loader = |name: &Path| {
        let (materials, seen, warnings) = &mut *library.borrow_mut();
        // Files repeat the line for every object.
        if seen.len() >= MAX_LIBRARIES || !seen.insert(name.to_owned()) {
            return Ok((Vec::new(), HashMap::new()));
        }
        let place = format!("line {}", line.load(Ordering::Relaxed));
        let loaded = mtl::load(&name.to_string_lossy(), folder, &place, warnings);
        let ids: HashMap<String, usize> = loaded
            .iter()
            .enumerate()
            .map(|(index, material)| (material.name.clone(), index))
            .collect();
        // tobj only needs to know how many there are and what they are called.
        let stubs = vec![tobj::Material::default(); loaded.len()];
        materials.extend(loaded);
        Ok((stubs, ids))
    };
    let outcome = without_panic(|| {
        let mut reader = CountingLines::new(&source.text, &line);
        tobj::load_obj_buf(&mut reader, &options, loader).map_err(|error| error.to_string())
    });
    let place = format!("line {}", line.load(Ordering::Relaxed));
    let (models, _) = outcome.map_err(|problem| Fault::new(place, problem).advise(REPAIR_LINE))?;
    Ok((models, library.into_inner().0))
}

fn build(
    models: Vec<tobj::Model>,
    library: &[MtlMaterial],
    folder: &Path,
    warnings: &mut Warnings,
) -> Result<SceneDesc, Fault> {
    let mut scene = SceneDesc::default();
    let mut materials = ObjMaterials::new(library, folder);
    let mut budget = Budget::geometry();
    for model in models
        .into_iter()
        .filter(|model| !model.mesh.indices.is_empty())
    {
        let place = format!("o \"{}\"", model.name.escape_debug());
        budget.charge(model.mesh.indices.len() as u64, 4 + 14 * 4, &place)?;
        let raw = raw_mesh(&model.mesh, &place, warnings);
        let material = materials.id(model.mesh.material_id, warnings);
        let desc = &materials.list[material];
        texture_uses::warn_about_missing_uvs(desc, &raw.uvs, &place, warnings);
        let tangent_uv_set = desc.normal_map.as_ref().map(|map| map.texture.uv_set);
        let name = model.name.clone();
        let Some(mesh) = mesh::finish(raw, name, tangent_uv_set, &place, &mut budget, warnings)?
        else {
            continue;
        };
        scene.meshes.push(MeshDesc { material, ..mesh });
        let mesh = scene.meshes.len() - 1;
        let world = DAffine3::IDENTITY;
        scene.instances.extend(place_mesh(
            &scene.meshes,
            mesh,
            &model.name,
            &world,
            &place,
            warnings,
        ));
    }
    materials.dismiss_unused(warnings);
    (scene.materials, scene.textures, scene.images) = materials.finish(warnings);
    Ok(scene)
}

fn raw_mesh(mesh: &tobj::Mesh, place: &str, warnings: &mut Warnings) -> RawMesh {
    let count = mesh.positions.len() / 3;
    // tobj leaves corners without the attribute out, after which nothing lines up any more.
    let mut complete = |length: usize, name: &str| {
        if length != 0 && length != count {
            warnings.push(
                place,
                format!("only some corners have {name}; they are ignored for all"),
            );
        }
        length == count
    };
    let has_normals = complete(mesh.normals.len() / 3, "normals");
    let has_uvs = complete(mesh.texcoords.len() / 2, "texture coordinates");
    let has_colors = complete(mesh.vertex_color.len() / 3, "colours");
    let vectors = |values: &[f32]| -> Vec<Vec3> {
        values
            .as_chunks::<3>()
            .0
            .iter()
            .map(|&v| v.into())
            .collect()
    };
    let (triangles, _) = mesh.indices.as_chunks::<3>();
    RawMesh {
        positions: vectors(&mesh.positions),
        normals: has_normals.then(|| vectors(&mesh.normals)),
        tangents: None,
        // OBJ's v grows upwards.
        uvs: [
            has_uvs.then(|| {
                mesh.texcoords
                    .as_chunks::<2>()
                    .0
                    .iter()
                    .map(|&[u, v]| Vec2::new(u, 1.0 - v))
                    .collect()
            }),
            None,
        ],
        colors: has_colors.then(|| {
            vectors(&mesh.vertex_color)
                .into_iter()
                .map(|rgb| rgb.extend(1.0))
                .collect()
        }),
        triangles: triangles.to_vec(),
    }
}
