//! Tangents for normal maps: those of the file where they are valid, MikkTSpace otherwise.

use std::collections::HashMap;

use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec2, Vec3, Vec4};

use super::normals::normalized;
use super::vertices::{gather, gather_vertices};
use crate::desc::MeshDesc;
use crate::import::warnings::Warnings;

/// Sets `mesh.tangents`, or warns that the normal map cannot be shown.
pub(super) fn complete(
    mesh: &mut MeshDesc,
    given: Option<Vec<Vec4>>,
    uv_set: usize,
    place: &str,
    warnings: &mut Warnings,
) {
    if let Some(given) = given {
        mesh.tangents = valid(given, &mesh.triangles);
        if mesh.tangents.is_some() {
            return;
        }
        warnings.push(
            place,
            "TANGENT has zero or non-finite vectors; tangents are computed instead",
        );
    }
    // Missing texture coordinates are reported for all textures of the material by the importer.
    if mesh.uvs.get(uv_set).is_some_and(Option::is_some) {
        generate(mesh, uv_set);
    }
}

fn valid(given: Vec<Vec4>, triangles: &[[u32; 3]]) -> Option<Vec<Vec4>> {
    let mut is_used = vec![false; given.len()];
    triangles
        .iter()
        .flatten()
        .for_each(|&corner| is_used[corner as usize] = true);
    let check = |(tangent, is_used): (Vec4, bool)| match normalized(tangent.truncate()) {
        Some(direction) if tangent.w.is_finite() => {
            Some(direction.extend(if tangent.w < 0.0 { -1.0 } else { 1.0 }))
        }
        _ => (!is_used).then_some(Vec4::new(1.0, 0.0, 0.0, 1.0)),
    };
    given.into_iter().zip(is_used).map(check).collect()
}

struct Corners<'a> {
    mesh: &'a MeshDesc,
    uvs: &'a [Vec2],
    tangents: Vec<Option<Vec4>>,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)].to_array()
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals[self.vertex(face, corner)].to_array()
    }

    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        self.uvs[self.vertex(face, corner)].to_array()
    }

    fn set_tangent(&mut self, tangent_space: Option<TangentSpace>, face: usize, corner: usize) {
        // MikkTSpace wants v to grow upwards; ours grows downwards, which turns the bitangent around.
        self.tangents[3 * face + corner] = tangent_space.and_then(|space| {
            let [x, y, z, sign] = space.tangent_encoded();
            Some(normalized(Vec3::new(x, y, z))?.extend(-sign))
        });
    }
}

/// MikkTSpace tangents; a vertex whose corners disagree is split.
fn generate(mesh: &mut MeshDesc, uv_set: usize) {
    let Some(uvs) = &mesh.uvs[uv_set] else { return };
    let mut corners = Corners {
        mesh,
        uvs,
        tangents: vec![None; 3 * mesh.triangles.len()],
    };
    // Its error type has no values.
    let Ok(()) = generate_tangents(&mut corners) else {
        return;
    };
    let corner_tangents = corners.tangents;

    let mut splits: HashMap<(u32, [u32; 4]), u32> = HashMap::new();
    let mut first: Vec<Option<Vec4>> = vec![None; mesh.positions.len()];
    let mut sources: Vec<u32> = (0..mesh.positions.len() as u32).collect();
    let mut tangents: Vec<Vec4> = Vec::new();
    for (corner, tangent) in mesh.triangles.iter_mut().flatten().zip(corner_tangents) {
        let vertex = *corner;
        let tangent = tangent.unwrap_or_else(|| {
            mesh.normals[vertex as usize]
                .any_orthonormal_vector()
                .extend(1.0)
        });
        match first[vertex as usize] {
            None => first[vertex as usize] = Some(tangent),
            Some(first) if first == tangent => {}
            Some(_) => {
                let bits = tangent.to_array().map(f32::to_bits);
                *corner = *splits.entry((vertex, bits)).or_insert_with(|| {
                    sources.push(vertex);
                    tangents.push(tangent);
                    sources.len() as u32 - 1
                });
            }
        }
    }
    let unused = Vec4::new(1.0, 0.0, 0.0, 1.0);
    let mut all: Vec<Vec4> = first
        .into_iter()
        .map(|tangent| tangent.unwrap_or(unused))
        .collect();
    all.append(&mut tangents);
    mesh.tangents = Some(all);
    if sources.len() > mesh.positions.len() {
        mesh.normals = gather(&mesh.normals, &sources);
        gather_vertices(mesh, &sources);
    }
}
