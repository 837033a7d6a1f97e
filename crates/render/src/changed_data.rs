//! A scene's data at another moment: what is not the same as at the first.

use crate::domain::{Buffer, Buffers};
use crate::record::{BufferRecord, IndexedRecord};
use crate::scene_data::SceneData;
use crate::triangle::TriangleRecord;

/// The buffers of a scene that are others at another moment; the rest are those of the first.
#[derive(Clone, Debug, PartialEq)]
pub struct ChangedData {
    buffers: [Option<Vec<u32>>; Buffer::COUNT],
    moves_triangles: bool,
}

impl ChangedData {
    /// What of the data at another moment differs from those at the first. The buffers in `same` are not looked at.
    pub fn new(first: &SceneData, mut other: SceneData, same: &[Buffer]) -> Self {
        let changed = |buffer: Buffer| {
            let is_same = same.contains(&buffer) || first.buffer(buffer) == other.buffer(buffer);
            (!is_same).then(|| std::mem::take(other.buffer_mut(buffer)))
        };
        let buffers = Buffer::ALL.map(changed);
        let moved = buffers[TriangleRecord::BUFFER as usize].as_deref();
        let moves_triangles = moved.is_some_and(|words| {
            let ours = records(words).map(|triangle| triangle.corners());
            let theirs = first.records::<TriangleRecord>();
            !ours.eq(theirs.map(|triangle| triangle.corners()))
        });
        Self {
            buffers,
            moves_triangles,
        }
    }

    /// Nothing differs.
    pub fn is_empty(&self) -> bool {
        self.buffers.iter().all(Option::is_none)
    }

    /// Whether a buffer differs.
    pub fn has(&self, buffer: Buffer) -> bool {
        self.buffers[buffer as usize].is_some()
    }

    /// All buffers at this moment, where those at the first are these.
    pub fn buffers<'a>(&'a self, first: &'a SceneData) -> Buffers<'a> {
        Buffers::new(Buffer::ALL.map(|buffer| {
            let changed = self.buffers[buffer as usize].as_deref();
            changed.unwrap_or_else(|| first.buffer(buffer))
        }))
    }

    /// Positions of the corners, three a triangle, if any triangle is elsewhere.
    pub fn positions(&self) -> Option<Vec<[f32; 3]>> {
        let words = self.buffers[TriangleRecord::BUFFER as usize].as_deref()?;
        let corners = || records(words).flat_map(|triangle| triangle.corners());
        self.moves_triangles.then(|| corners().collect())
    }

    /// Bytes in the buffers that differ.
    pub fn memory_bytes(&self) -> usize {
        let words = self.buffers.iter().flatten().map(Vec::len);
        4 * words.sum::<usize>()
    }
}

fn records(words: &[u32]) -> impl Iterator<Item = TriangleRecord> {
    let records = words.chunks_exact(TriangleRecord::WORDS as usize);
    records.map(TriangleRecord::from_words)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    fn data(corners: [[f32; 3]; 3]) -> SceneData {
        let mut data = SceneData::default();
        data.push(TriangleRecord {
            program: 7,
            ..TriangleRecord::new(corners)
        });
        data.buffer_mut(Buffer::Texels).push(9);
        data
    }

    #[test]
    fn only_what_differs_is_kept() {
        let first = data(CORNERS);
        assert!(ChangedData::new(&first, data(CORNERS), &[]).is_empty());

        let mut moved = CORNERS;
        moved[1][2] = 1.0;
        let mut other = data(moved);
        other.buffer_mut(Buffer::Texels).clear();
        let changed = ChangedData::new(&first, other, &[Buffer::Texels]);
        assert_eq!(
            Buffer::ALL.map(|buffer| changed.has(buffer)),
            Buffer::ALL.map(|buffer| buffer == Buffer::Triangles)
        );
        assert_eq!(changed.positions(), Some(moved.to_vec()));
        let buffers = changed.buffers(&first);
        assert_eq!(buffers.get(Buffer::Texels), [9]);
        let expected = data(moved);
        assert_eq!(
            buffers.get(Buffer::Triangles),
            expected.buffer(Buffer::Triangles)
        );
        assert_eq!(
            changed.memory_bytes(),
            4 * buffers.get(Buffer::Triangles).len()
        );
    }

    #[test]
    fn a_light_that_changes_moves_no_triangle() {
        let first = data(CORNERS);
        let mut other = data(CORNERS);
        other.set_light(0, 3);
        let changed = ChangedData::new(&first, other, &[]);
        assert!(changed.has(Buffer::Triangles));
        assert_eq!(changed.positions(), None);
    }
}
