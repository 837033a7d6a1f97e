//! A scene's data: the dynamic half of a scene, whose static half is its `program::Structure`.

use crate::domain::{Buffer, Buffers};
use crate::record::IndexedRecord;
use crate::triangle::TriangleRecord;

/// The buffers of a scene, owned, and what traversal needs beside them.
#[derive(Clone, Debug, Default)]
pub struct SceneData {
    buffers: [Vec<u32>; Buffer::COUNT],
    /// For each triangle: culled from behind. Empty where no triangle is.
    pub single_sided: Vec<bool>,
    /// For each triangle: its program has an alpha test. Empty where no triangle has.
    pub alpha_tested: Vec<bool>,
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

    /// Appends a record to the buffer that holds its kind.
    pub fn push<R: IndexedRecord>(&mut self, record: R) {
        record.append_to(self.buffer_mut(R::BUFFER));
    }

    /// All records of the buffer that holds their kind.
    pub fn records<R: IndexedRecord>(&self) -> impl ExactSizeIterator<Item = R> {
        let words = self.buffer(R::BUFFER).chunks_exact(R::WORDS as usize);
        words.map(R::from_words)
    }

    /// The record with this index.
    ///
    /// # Panics
    /// If there is none.
    pub fn record<R: IndexedRecord>(&self, index: usize) -> R {
        R::from_words(&self.buffer(R::BUFFER)[index * R::WORDS as usize..])
    }

    /// Replaces the record with this index by what `change` makes of it.
    ///
    /// # Panics
    /// If there is none.
    pub fn change<R: IndexedRecord>(&mut self, index: usize, change: impl FnOnce(R) -> R) {
        let words = &mut self.buffer_mut(R::BUFFER)[index * R::WORDS as usize..];
        change(R::from_words(words)).write_to(words);
    }

    /// Makes a triangle a light.
    pub fn set_light(&mut self, triangle: usize, light: u32) {
        self.change(triangle, |record| TriangleRecord { light, ..record });
    }

    /// How many triangles there are.
    pub fn triangle_count(&self) -> usize {
        self.buffer(Buffer::Triangles).len() / TriangleRecord::WORDS as usize
    }

    /// Positions of the corners, three a triangle.
    pub fn positions(&self) -> Vec<[f32; 3]> {
        let triangles = self.records::<TriangleRecord>();
        triangles.flat_map(|triangle| triangle.corners()).collect()
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
