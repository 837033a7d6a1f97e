//! The container of binary glTF files.

use super::root::CONVERT;
use crate::import::error::Fault;

/// The type of the chunk of JSON, `JSON` in ASCII.
const JSON: u32 = 0x4e4f_534a;

/// The type of the binary chunk, `BIN` in ASCII.
const BIN: u32 = 0x004e_4942;

/// Splits a file into its JSON and the binary chunk, if it has one.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let word = |at: usize| -> Option<u32> {
        let word = bytes.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(word.try_into().ok()?))
    };
    let truncated = |at: usize| Fault::new(format!("byte {at}"), "the GLB file ends too early");
    let version = word(4).ok_or_else(|| truncated(4))?;
    if version != 2 {
        let problem = format!("the GLB container is of glTF version {version}, not 2");
        return Err(Fault::new("byte 4", problem).advise(CONVERT));
    }
    let length = word(8).ok_or_else(|| truncated(8))? as usize;
    if length > bytes.len() {
        return Err(Fault::new(
            "byte 8",
            format!(
                "the header says {length} bytes, the file has {}",
                bytes.len()
            ),
        ));
    }
    let mut json = None;
    let mut binary = None;
    let mut at = 12;
    for chunk_index in 0.. {
        if at >= length {
            break;
        }
        let size = word(at).ok_or_else(|| truncated(at))? as usize;
        let kind = word(at + 4).ok_or_else(|| truncated(at + 4))?;
        let end = (at + 8).checked_add(size).filter(|&end| end <= length);
        let end = end.ok_or_else(|| {
            Fault::new(
                format!("byte {at}"),
                "a chunk reaches beyond the end of the file",
            )
        })?;
        match (chunk_index, kind) {
            (0, JSON) => json = Some(&bytes[at + 8..end]),
            (1, BIN) => binary = Some(&bytes[at + 8..end]),
            // Other chunks are to be ignored.
            _ => {}
        }
        at = end;
    }
    let json = json.ok_or_else(|| Fault::new("byte 12", "the first chunk is not JSON"))?;
    Ok((json, binary))
}
