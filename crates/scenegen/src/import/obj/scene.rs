//! An OBJ file as a scene description: the pieces of this folder put together.

use std::collections::{HashMap, HashSet};
use std::path::Path;

use glam::DAffine3;

use super::geometry::{Geometry, NamedMaterial, Part};
use super::libraries::Libraries;
use super::lines::line_place;
use super::materials::{Materials, Source};
use super::part_mesh::PartMeshes;
use super::{parser, references};
use crate::desc::{MeshDesc, SceneDesc};
use crate::import::budget::Budget;
use crate::import::error::{Fault, ImportError, MAKE_SMALLER};
use crate::import::instances::place_mesh;
use crate::import::warnings::Warnings;
use crate::import::{files, mesh, text};

/// What is made of a file needs several times its size.
const MAX_OBJ_BYTES: usize = 256 << 20;

/// Bytes of a triangle's corner, if it shares its vertex with no other: an index, and a vertex without tangent.
const CORNER_BYTES: u64 = 4 + 14 * 4;

/// Reads an `.obj` file and its material libraries.
pub(in crate::import) fn import(
    file: &Path,
    warnings: &mut Warnings,
) -> Result<SceneDesc, ImportError> {
    let bytes = files::read(file).map_err(|message| ImportError::Io {
        file: file.to_owned(),
        message,
    })?;
    read(bytes, file, warnings).map_err(|fault| fault.in_file(file))
}

fn read(bytes: Vec<u8>, file: &Path, warnings: &mut Warnings) -> Result<SceneDesc, Fault> {
    if bytes.len() > MAX_OBJ_BYTES {
        let problem = format!("{} bytes are more than the 256 MiB we read", bytes.len());
        return Err(Fault::new("file", problem).advise(MAKE_SMALLER));
    }
    let mut budget = Budget::geometry();
    let mut geometry = parser::parse(&text::decode(bytes), &mut budget, warnings)?;
    references::check(&mut geometry, warnings);
    if geometry.faces.is_empty() && !geometry.positions.is_empty() {
        let message = format!(
            "{} vertices and no face: points are not rendered",
            geometry.positions.len()
        );
        warnings.push("v", message);
    }
    geometry.colors.linearize(warnings);
    let libraries = Libraries::load(&geometry, file, warnings);
    let materials = find_materials(&geometry, &libraries, warnings);
    let folder = file.parent().unwrap_or(Path::new(""));
    build(&geometry, &libraries, &materials, folder, budget, warnings)
}

/// The material of each `usemtl`, by index in the libraries. Files repeat names thousands of times: each is looked up and
/// complained about once.
fn find_materials(
    geometry: &Geometry,
    libraries: &Libraries,
    warnings: &mut Warnings,
) -> Vec<Option<usize>> {
    let mut known: HashMap<(&str, usize), Option<usize>> = HashMap::new();
    let mut said: HashSet<&str> = HashSet::new();
    let find = |named: &NamedMaterial| {
        let found = libraries.find(named);
        let problem = match &found {
            None => Some("is in no library; grey is used".to_owned()),
            Some(found) if found.is_guess => {
                let name = libraries.materials[found.index].name.escape_debug();
                Some(format!("is in no library; \"{name}\" is used"))
            }
            Some(_) => None,
        };
        (found.map(|found| found.index), problem)
    };
    let materials = geometry.materials.iter().map(|named| {
        let key = (named.name.as_str(), named.libraries_before);
        *known.entry(key).or_insert_with(|| {
            let (index, problem) = find(named);
            if let Some(problem) = problem
                && said.insert(&named.name)
            {
                let name = named.name.escape_debug();
                let message = format!("material \"{name}\" {problem}");
                warnings.push(line_place(named.line), message);
            }
            index
        })
    });
    materials.collect()
}

fn build(
    geometry: &Geometry,
    libraries: &Libraries,
    used: &[Option<usize>],
    folder: &Path,
    mut budget: Budget,
    warnings: &mut Warnings,
) -> Result<SceneDesc, Fault> {
    let mut scene = SceneDesc::default();
    let mut materials = Materials::new(&libraries.materials, folder);
    let mut meshes = PartMeshes::new(geometry);
    for part in geometry
        .parts
        .iter()
        .filter(|part| corner_count(geometry, part) > 0)
    {
        let place = format!("o \"{}\"", part.name.escape_debug());
        budget.charge(corner_count(geometry, part), CORNER_BYTES, &place)?;
        let part_mesh = meshes.mesh(part);
        let source = match part.material.and_then(|index| used[index]) {
            Some(index) => Source::Library(index),
            None if part_mesh.raw.colors.is_some() => Source::White,
            None => Source::Grey,
        };
        let (material_index, material) = materials.get(source, warnings);
        if part_mesh.corners_without_uv > 0 && material.textures().next().is_some() {
            let message = format!(
                "{} corners lack texture coordinates; (0, 0) is used",
                part_mesh.corners_without_uv
            );
            warnings.push(&*place, message);
        }
        let name = part.name.clone();
        let Some(mesh) =
            mesh::finish(part_mesh.raw, name, material, &place, &mut budget, warnings)?
        else {
            continue;
        };
        scene.meshes.push(MeshDesc {
            material: material_index,
            ..mesh
        });
        scene.instances.extend(place_mesh(
            &scene.meshes,
            scene.meshes.len() - 1,
            &part.name,
            &DAffine3::IDENTITY,
            &place,
            warnings,
        ));
    }
    scene.origin = geometry.origin;
    let message = "polygons cross themselves or have too many corners; they are fans of triangles around their first corner, \
        which may cover more than their outlines";
    meshes.approximate.warn(message, warnings);
    materials.dismiss_unused(warnings);
    (scene.materials, scene.textures, scene.images) = materials.finish(warnings);
    Ok(scene)
}

/// Corners of a part's triangles.
fn corner_count(geometry: &Geometry, part: &Part) -> u64 {
    let counts = geometry
        .faces(part)
        .iter()
        .map(|face| geometry.corners(face).len());
    counts.map(|count| 3 * count.saturating_sub(2) as u64).sum()
}
