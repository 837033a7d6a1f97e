//! The geometry of an OBJ file: attributes, and faces that refer to them, with their polygons whole.

use std::ops::Range;

use glam::{DVec3, Vec2, Vec3};

use super::corner::Corner;
use super::vertex_colors::VertexColors;

/// What an OBJ file says.
#[derive(Default)]
pub(super) struct Geometry {
    /// What positions are relative to.
    pub(super) origin: DVec3,
    /// `v`; NaN where a line has no numbers.
    pub(super) positions: Vec<Vec3>,
    /// Colours behind `v`.
    pub(super) colors: VertexColors,
    /// `vt`, with a v that grows downwards.
    pub(super) uvs: Vec<Vec2>,
    /// `vn`, of any length.
    pub(super) normals: Vec<Vec3>,
    /// Faces, those of a part together.
    pub(super) faces: Vec<Face>,
    /// Corners, those of a face together.
    pub(super) corners: Vec<Corner>,
    /// What becomes a mesh.
    pub(super) parts: Vec<Part>,
    /// `usemtl`, in order.
    pub(super) materials: Vec<NamedMaterial>,
    /// `mtllib`, in order: index of the line, and what it names.
    pub(super) libraries: Vec<(usize, String)>,
}

/// A polygon.
#[derive(Clone, Copy)]
pub(super) struct Face {
    /// Index of its line.
    pub(super) line: u32,
    /// Index of its first corner.
    pub(super) first_corner: u32,
    /// How many it has.
    pub(super) corner_count: u32,
    /// `s`; 0 is none.
    pub(super) smoothing_group: u32,
}

impl Face {
    /// Of its corners in [`Geometry::corners`].
    pub(super) fn corner_range(self) -> Range<usize> {
        self.first_corner as usize..(self.first_corner + self.corner_count) as usize
    }

    /// Leaves the face out.
    pub(super) fn remove_corners(&mut self) {
        self.corner_count = 0;
    }
}

/// Faces of one object or group and one material.
pub(super) struct Part {
    /// Behind `o` or `g`.
    pub(super) name: String,
    /// Index into [`Geometry::materials`].
    pub(super) material: Option<usize>,
    /// Index of its first face.
    pub(super) first_face: usize,
    /// How many it has.
    pub(super) face_count: usize,
}

/// A `usemtl` statement.
pub(super) struct NamedMaterial {
    /// Index of its line.
    pub(super) line: usize,
    /// As written, comments included.
    pub(super) name: String,
    /// How many `mtllib` statements stand before it.
    pub(super) libraries_before: usize,
}

impl Geometry {
    /// A part's faces.
    pub(super) fn faces(&self, part: &Part) -> &[Face] {
        &self.faces[part.first_face..][..part.face_count]
    }

    /// A face's corners.
    pub(super) fn corners(&self, face: &Face) -> &[Corner] {
        &self.corners[face.corner_range()]
    }

    /// Where a face's corners are.
    pub(super) fn positions_of(&self, face: &Face) -> Vec<Vec3> {
        let corners = self.corners(face).iter();
        corners
            .map(|corner| self.positions[corner.position()])
            .collect()
    }
}
