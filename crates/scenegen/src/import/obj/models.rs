//! The models of an OBJ file, by tobj, and the libraries that it names on the way.

use std::cell::{Cell, RefCell};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use glam::{Vec2, Vec3};

use super::counting_lines::CountingLines;
use super::lines::REPAIR_LINE;
use super::mtl::{self, MtlMaterial};
use crate::import::error::Fault;
use crate::import::guard::without_panic;
use crate::import::mesh::RawMesh;
use crate::import::warnings::Warnings;

/// More libraries than this are not read.
const MAX_LIBRARIES: usize = 1000;

/// What has been read of the libraries.
struct Libraries<'w> {
    materials: Vec<MtlMaterial>,
    seen: HashSet<PathBuf>,
    warnings: &'w mut Warnings,
}

/// Reads the models of cleaned text and the materials of its libraries.
pub(super) fn load(
    text: &str,
    folder: &Path,
    warnings: &mut Warnings,
) -> Result<(Vec<tobj::Model>, Vec<MtlMaterial>), Fault> {
    let line = Cell::new(0);
    let libraries = RefCell::new(Libraries {
        materials: Vec::new(),
        seen: HashSet::new(),
        warnings,
    });
    let options = tobj::LoadOptions {
        ignore_points: true,
        ignore_lines: true,
        ..tobj::GPU_LOAD_OPTIONS
    };
    let loader = |name: &Path| {
        let libraries = &mut *libraries.borrow_mut();
        // Files repeat the line for every object.
        if libraries.seen.len() >= MAX_LIBRARIES || !libraries.seen.insert(name.to_owned()) {
            return Ok((Vec::new(), HashMap::new()));
        }
        let place = format!("line {}", line.get());
        let loaded = mtl::load(&name.to_string_lossy(), folder, &place, libraries.warnings);
        let indices: HashMap<String, usize> = loaded
            .iter()
            .enumerate()
            .map(|(index, material)| (material.name.clone(), index))
            .collect();
        // tobj only needs to know how many there are and what they are called.
        let stubs = vec![tobj::Material::default(); loaded.len()];
        libraries.materials.extend(loaded);
        Ok((stubs, indices))
    };
    let outcome = without_panic(|| {
        let mut reader = CountingLines::new(text, &line);
        tobj::load_obj_buf(&mut reader, &options, loader).map_err(|error| error.to_string())
    });
    let place = format!("line {}", line.get());
    let (models, _) = outcome.map_err(|problem| Fault::new(place, problem).advise(REPAIR_LINE))?;
    Ok((models, libraries.into_inner().materials))
}

/// A model's triangles.
pub(super) fn raw_mesh(mesh: &tobj::Mesh, place: &str, warnings: &mut Warnings) -> RawMesh {
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
