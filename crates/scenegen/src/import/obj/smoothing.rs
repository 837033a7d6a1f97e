//! Normals of smoothing groups: what faces that share a group and a vertex average to.

use std::collections::HashMap;

use glam::{DVec3, Vec3};

use super::corner::Attribute;
use super::geometry::{Face, Geometry};
use crate::import::mesh::vector_area;

/// Normals by vertex and smoothing group.
#[derive(Default)]
pub(super) struct SmoothNormals(HashMap<(u32, u32), DVec3>);

impl SmoothNormals {
    /// Those that corners without a normal of their own need. A face counts by its angle at the vertex, so that it does
    /// not matter how a surface is cut into faces (Thürmer and Wüthrich 1998).
    pub(super) fn new(geometry: &Geometry) -> Self {
        let lacks_normals = |face: &&Face| {
            let corners = geometry.corners(face);
            corners
                .iter()
                .any(|corner| corner.get(Attribute::Normal).is_none())
        };
        let mut sums = HashMap::new();
        for face in geometry.faces.iter().filter(lacks_normals) {
            if face.smoothing_group == 0 {
                continue;
            }
            let positions = geometry.positions_of(face);
            let Some(normal) = vector_area(&positions).try_normalize() else {
                continue;
            };
            for (index, corner) in geometry.corners(face).iter().enumerate() {
                let key = (corner.position() as u32, face.smoothing_group);
                let sum: &mut DVec3 = sums.entry(key).or_default();
                *sum += angle(&positions, index) * normal;
            }
        }
        Self(sums)
    }

    /// That of a vertex, of any length; `None` where no face with an area gives one.
    pub(super) fn get(&self, vertex: usize, smoothing_group: u32) -> Option<Vec3> {
        let sum = self.0.get(&(vertex as u32, smoothing_group))?;
        Some(sum.try_normalize()?.as_vec3())
    }
}

/// The angle between a polygon's edges at a corner; 0 where an edge has no length.
fn angle(corners: &[Vec3], index: usize) -> f64 {
    let at = |index: usize| corners[index % corners.len()].as_dvec3();
    let (corner, next, previous) = (at(index), at(index + 1), at(index + corners.len() - 1));
    let directions = [next, previous].map(|end| (end - corner).try_normalize());
    match directions {
        [Some(a), Some(b)] => a.dot(b).clamp(-1.0, 1.0).acos(),
        _ => 0.0,
    }
}
