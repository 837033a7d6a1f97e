//! A scene's data: the dynamic half of a scene, whose static half is its `program::Structure`.

use crate::domain::{Buffer, Buffers};

/// The buffers of a scene, owned, and what traversal needs beside them.
#[derive(Clone, Debug, Default)]
pub struct SceneData {
    buffers: [Vec<u32>; Buffer::COUNT],
    /// For each triangle: culled from behind. Empty where no triangle is.
    pub single_sided: Vec<bool>,
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

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.buffer(Buffer::Triangles).len() / 3
    }

    /// Vertex positions.
    pub fn positions(&self) -> Vec<[f32; 3]> {
        let words = self.buffer(Buffer::Positions).chunks_exact(3);
        words
            .map(|p| [p[0], p[1], p[2]].map(f32::from_bits))
            .collect()
    }

    /// Corners of the triangles.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        let words = self.buffer(Buffer::Triangles).chunks_exact(3);
        words.map(|t| [t[0], t[1], t[2]]).collect()
    }

    /// Bytes in all buffers.
    pub fn memory_bytes(&self) -> usize {
        self.buffers.iter().map(|words| words.len() * 4).sum()
    }
}
