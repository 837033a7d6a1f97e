//! A scene's data: the dynamic half of a scene, whose static half is its `program::Structure`.

use crate::domain::{Buffer, Buffers};
use crate::light::NO_LIGHT;
use crate::surface::TRIANGLE_WORDS;

/// The buffers of a scene, owned, and what traversal needs beside them.
#[derive(Clone, Debug, Default)]
pub struct SceneData {
    buffers: [Vec<u32>; Buffer::COUNT],
    /// For each triangle: culled from behind. Empty where no triangle is.
    pub single_sided: Vec<bool>,
    /// For each triangle: its program has alpha, so that it may let rays through. Empty where no triangle does.
    pub lets_through: Vec<bool>,
}

impl SceneData {
    /// The words of a buffer.
    pub fn buffer(&self, buffer: Buffer) -> &[u32] {
        &self.buffers[buffer as usize]
    }

    /// The words of a buffer, to be filled.
    pub fn buffer_mut(&mut self, buffer: Buffer) -> &mut Vec<u32> {
        &mut self.buffers[buffer as usize]
    }

    /// All buffers, for a domain.
    pub fn buffers(&self) -> Buffers<'_> {
        Buffers::new(self.buffers.each_ref().map(Vec::as_slice))
    }

    /// Adds a triangle that is no light. Its attributes, if any, are the vertices that are added to
    /// [`Buffer::Indices`].
    pub fn push_triangle(&mut self, corners: [[f32; 3]; 3], program: u32, params: u32) {
        let last_words = [params, NO_LIGHT, 0];
        for (corner, last) in corners.into_iter().zip(last_words) {
            let [x, y, z] = corner.map(f32::to_bits);
            self.buffer_mut(Buffer::Triangles).extend([x, y, z, last]);
        }
        self.buffer_mut(Buffer::TrianglePrograms).push(program);
    }

    /// Makes a triangle a light.
    pub fn set_light(&mut self, triangle: usize, light: u32) {
        self.buffer_mut(Buffer::Triangles)[triangle * TRIANGLE_WORDS as usize + 7] = light;
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.buffer(Buffer::TrianglePrograms).len()
    }

    /// Positions of the corners, three a triangle.
    pub fn positions(&self) -> Vec<[f32; 3]> {
        let (rows, _) = self.buffer(Buffer::Triangles).as_chunks();
        rows.iter()
            .map(|&[x, y, z, _]| [x, y, z].map(f32::from_bits))
            .collect()
    }

    /// The corners of the triangles among [`SceneData::positions`].
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let corners = |triangle| [3 * triangle, 3 * triangle + 1, 3 * triangle + 2];
        (0..self.triangle_count() as u32).map(corners).collect()
    }

    /// Bytes in all buffers.
    pub fn memory_bytes(&self) -> usize {
        self.buffers.iter().map(|words| words.len() * 4).sum()
    }
}
