//! Scene data as bytes, for programs that carry a scene with them: all numbers little-endian.

use crate::domain::Buffer;
use crate::scene_data::SceneData;

/// Raised whenever the meaning of buffers changes.
const MAGIC: [u8; 8] = *b"RSCENE05";

/// Bytes that are no scene data, or another version's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NotSceneData;

impl std::fmt::Display for NotSceneData {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the scene's data are damaged or of another version; build again")
    }
}

impl std::error::Error for NotSceneData {}

impl SceneData {
    /// The data as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        for buffer in Buffer::ALL {
            let words = self.buffer(buffer);
            bytes.extend((words.len() as u64).to_le_bytes());
            bytes.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        }
        for marks in [&self.single_sided, &self.alpha_tested] {
            bytes.extend((marks.len() as u64).to_le_bytes());
            bytes.extend(marks.iter().map(|&mark| u8::from(mark)));
        }
        bytes
    }

    /// The data that [`SceneData::to_bytes`] wrote.
    ///
    /// # Errors
    /// If the bytes are something else. Their meaning is not checked: they are trusted as much as the program itself.
    pub fn from_bytes(mut bytes: &[u8]) -> Result<Self, NotSceneData> {
        let magic = bytes.split_off(..MAGIC.len()).ok_or(NotSceneData)?;
        if magic != MAGIC {
            return Err(NotSceneData);
        }
        let mut data = Self::default();
        for buffer in Buffer::ALL {
            let (words, _) = part(&mut bytes, 4)?.as_chunks();
            let words = words.iter().map(|&word| u32::from_le_bytes(word));
            *data.buffer_mut(buffer) = words.collect();
        }
        for marks in [&mut data.single_sided, &mut data.alpha_tested] {
            *marks = part(&mut bytes, 1)?.iter().map(|&mark| mark != 0).collect();
        }
        if bytes.is_empty() {
            Ok(data)
        } else {
            Err(NotSceneData)
        }
    }
}

/// Takes a number of elements of `size` bytes, and these.
fn part<'a>(bytes: &mut &'a [u8], size: usize) -> Result<&'a [u8], NotSceneData> {
    let (length, rest) = bytes.split_first_chunk().ok_or(NotSceneData)?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok();
    let length = length.and_then(|length| length.checked_mul(size));
    let (part, rest) = length
        .and_then(|length| rest.split_at_checked(length))
        .ok_or(NotSceneData)?;
    *bytes = rest;
    Ok(part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::triangle::TriangleRecord;

    #[test]
    fn data_read_back_and_damage_is_noticed() {
        let mut data = SceneData::default();
        let corners = [[0.0; 3], [1.0; 3], [2.0, 3.0, 4.0]];
        let triangle = TriangleRecord {
            params: 6,
            program: 5,
            ..TriangleRecord::new(corners)
        };
        data.push(triangle);
        data.alpha_tested = vec![true];
        let bytes = data.to_bytes();
        let read = SceneData::from_bytes(&bytes).unwrap();
        assert!(
            Buffer::ALL
                .iter()
                .all(|&b| read.buffer(b) == data.buffer(b))
        );
        assert_eq!(read.alpha_tested, [true]);
        assert!(read.single_sided.is_empty());
        for length in 0..bytes.len() {
            assert!(SceneData::from_bytes(&bytes[..length]).is_err(), "{length}");
        }
        let mut huge = bytes.clone();
        huge[8..16].fill(0xff);
        assert!(SceneData::from_bytes(&huge).is_err());
        assert!(SceneData::from_bytes(&[&bytes[..], &[0]].concat()).is_err());
    }
}
