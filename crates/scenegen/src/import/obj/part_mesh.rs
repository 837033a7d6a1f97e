//! A part of a geometry as triangles with a single index.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::corner::{Attribute, Corner};
use super::geometry::{Face, Geometry, Part};
use super::occurrences::Occurrences;
use super::smoothing::SmoothNormals;
use crate::import::mesh::{Coverage, RawMesh, Triangulator, vector_area};

/// A part's triangles, and what is to be said of it.
pub(super) struct PartMesh {
    /// The triangles.
    pub(super) raw: RawMesh,
    /// Corners without texture coordinates in a part where others have some; they are at (0, 0).
    pub(super) corners_without_uv: usize,
}

/// Makes meshes of parts.
pub(super) struct PartMeshes<'g> {
    geometry: &'g Geometry,
    smooth_normals: SmoothNormals,
    triangulator: Triangulator,
    /// Polygons that triangles do not cover exactly.
    pub(super) approximate: Occurrences,
}

/// Where a corner has its normal from.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum NormalSource {
    /// `vn`.
    Given(usize),
    /// A smoothing group.
    Smooth(u32),
    /// A face, by its index in the part.
    Flat(usize),
}

impl<'g> PartMeshes<'g> {
    /// Of a geometry's parts.
    pub(super) fn new(geometry: &'g Geometry) -> Self {
        Self {
            geometry,
            smooth_normals: SmoothNormals::new(geometry),
            triangulator: Triangulator::new(),
            approximate: Occurrences::default(),
        }
    }

    /// That of one part.
    pub(super) fn mesh(&mut self, part: &Part) -> PartMesh {
        let geometry = self.geometry;
        let faces = geometry.faces(part);
        let corners = || faces.iter().flat_map(|face| geometry.corners(face));
        let has = |attribute| corners().any(|corner| corner.get(attribute).is_some());
        let has_uvs = has(Attribute::TextureCoordinate);
        // Without any, triangles get their own normals.
        let has_normals =
            has(Attribute::Normal) || faces.iter().any(|face| face.smoothing_group != 0);

        let mut builder = Builder::default();
        let mut triangles: Vec<[u32; 3]> = Vec::new();
        for (index, face) in faces.iter().enumerate() {
            let corners = geometry.corners(face);
            if corners.is_empty() {
                continue;
            }
            let positions = geometry.positions_of(face);
            let first = triangles.len();
            if self.triangulator.triangulate(&positions, &mut triangles) == Coverage::Approximate {
                self.approximate.note(face.line as usize);
            }
            let vertices: Vec<u32> = corners
                .iter()
                .map(|&corner| {
                    let normal = has_normals.then(|| self.normal_source(corner, face, index));
                    builder.vertex(corner, normal)
                })
                .collect();
            for triangle in &mut triangles[first..] {
                *triangle = triangle.map(|corner| vertices[corner as usize]);
            }
        }

        let uv = |corner: &Corner| {
            corner
                .get(Attribute::TextureCoordinate)
                .map(|index| geometry.uvs[index])
        };
        let normal = |&(corner, source): &(Corner, Option<NormalSource>)| match source {
            Some(NormalSource::Given(index)) => geometry.normals[index],
            Some(NormalSource::Smooth(group)) => self
                .smooth_normals
                .get(corner.position(), group)
                .unwrap_or(Vec3::ZERO),
            Some(NormalSource::Flat(face)) => {
                let area = vector_area(&geometry.positions_of(&faces[face]));
                area.try_normalize().unwrap_or_default().as_vec3()
            }
            None => Vec3::ZERO,
        };
        let vertices = &builder.vertices;
        let position_indices: Vec<usize> = vertices
            .iter()
            .map(|(corner, _)| corner.position())
            .collect();
        PartMesh {
            corners_without_uv: match has_uvs {
                true => corners().filter(|corner| uv(corner).is_none()).count(),
                false => 0,
            },
            raw: RawMesh {
                positions: position_indices
                    .iter()
                    .map(|&index| geometry.positions[index])
                    .collect(),
                normals: has_normals.then(|| vertices.iter().map(normal).collect()),
                tangents: None,
                uv_sets: [0, 1],
                uvs: [
                    has_uvs.then(|| {
                        vertices
                            .iter()
                            .map(|(corner, _)| uv(corner).unwrap_or(Vec2::ZERO))
                            .collect()
                    }),
                    None,
                ],
                colors: geometry.colors.of(&position_indices),
                triangles,
            },
        }
    }

    fn normal_source(&self, corner: Corner, face: &Face, index: usize) -> NormalSource {
        match (corner.get(Attribute::Normal), face.smoothing_group) {
            (Some(normal), _) => NormalSource::Given(normal),
            (None, 0) => NormalSource::Flat(index),
            (None, group) => NormalSource::Smooth(group),
        }
    }
}

/// Vertices in order of first use, each once.
#[derive(Default)]
struct Builder {
    vertices: Vec<(Corner, Option<NormalSource>)>,
    indices: HashMap<(Corner, Option<NormalSource>), u32>,
}

impl Builder {
    fn vertex(&mut self, corner: Corner, normal: Option<NormalSource>) -> u32 {
        *self.indices.entry((corner, normal)).or_insert_with(|| {
            self.vertices.push((corner, normal));
            self.vertices.len() as u32 - 1
        })
    }
}
