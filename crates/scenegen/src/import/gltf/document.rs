//! A glTF file's JSON and buffers, before anything is interpreted.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use glam::DVec3;
use gltf::json::{self, Index, Root};

use super::lookup::{get, place};
use super::meshopt::Compressed;
use super::{draco, extensions, glb, json_text, root, translations, uri};
use crate::import::budget::Budget;
use crate::import::error::{Fault, ImportError};
use crate::import::files;
use crate::import::folders::Folders;
use crate::import::warnings::Warnings;

/// A parsed file with its buffers.
pub(super) struct Document {
    /// The folder that relative URIs start from.
    pub(super) folder: PathBuf,
    /// The JSON.
    pub(super) root: Root,
    /// Translations of nodes that 32 bits do not hold, by the node's index.
    pub(super) long_translations: HashMap<usize, DVec3>,
    /// Buffer views that are stored compressed, with the bytes of an element, by the view's index.
    decompressed: HashMap<usize, (Vec<u8>, usize)>,
    /// Elements that are stored compressed with those of their primitive, by the accessor's index.
    pub(super) draco: HashMap<usize, draco::Elements>,
    /// Each buffer's bytes, or why they could not be had (which matters only if someone asks).
    buffers: Vec<Result<Vec<u8>, String>>,
}

impl Document {
    /// Reads a `.gltf` or `.glb` file and the buffers it names.
    pub(super) fn open(file: &Path, warnings: &mut Warnings) -> Result<Self, ImportError> {
        let bytes = files::read(file).map_err(|message| ImportError::Io {
            file: file.to_owned(),
            message,
        })?;
        let (json, binary) = if bytes.starts_with(b"glTF") {
            glb::split(&bytes).map_err(|fault| fault.in_file(file))?
        } else {
            (bytes.as_slice(), None)
        };
        let json = json_text::read(json, warnings).map_err(|fault| fault.in_file(file))?;
        let root = root::parse(&json, warnings).map_err(|fault| fault.in_file(file))?;
        extensions::check_required(&root, file)?;

        let folder = file.parent().unwrap_or(Path::new(""));
        let mut folders = Folders::default();
        let buffers = root.buffers.iter().enumerate();
        let buffers = buffers
            .map(|(index, buffer)| {
                let at = place("buffers", index, buffer.name.as_deref());
                match &buffer.uri {
                    Some(uri) => {
                        let content = uri::read(uri, folder, &mut folders)?;
                        if let Some(remark) = content.remark {
                            warnings.push(at, remark);
                        }
                        of_length(content.bytes, buffer)
                    }
                    None if index == 0 => {
                        let bytes = binary.ok_or("has neither a uri nor a GLB binary chunk")?;
                        of_length(bytes.to_vec(), buffer)
                    }
                    None => Err("has no uri".into()),
                }
            })
            .collect::<Vec<Result<Vec<u8>, String>>>();
        extensions::warn_about_root(&root, warnings);
        let decompressed = decompress(&root, &buffers).map_err(|fault| fault.in_file(file))?;
        let mut document = Self {
            decompressed,
            draco: HashMap::new(),
            folder: folder.to_owned(),
            long_translations: translations::long(&json, &root),
            root,
            buffers,
        };
        let view = |index, user: &str| document.view(index, user).map(|(bytes, _)| bytes);
        let decoded = draco::decode_all(&document.root, &view, warnings);
        document.draco = decoded.map_err(|fault| fault.in_file(file))?;
        Ok(document)
    }

    /// Bytes of a buffer view and its stride.
    pub(super) fn view(
        &self,
        index: Index<json::buffer::View>,
        user: &str,
    ) -> Result<(&[u8], Option<usize>), Fault> {
        let view = get(&self.root.buffer_views, index, "bufferViews", user)?;
        if let Some((bytes, stride)) = self.decompressed.get(&index.value()) {
            return Ok((bytes, Some(*stride)));
        }
        let here = place("bufferViews", index.value(), view.name.as_deref());
        let buffer = get(&self.buffers, view.buffer, "buffers", &here)?;
        let buffer = buffer.as_ref().map_err(|problem| {
            Fault::new(format!("buffers/{}", view.buffer.value()), problem.clone())
        })?;
        let start = view.byte_offset.unwrap_or_default().0;
        let bytes = section(buffer, start, view.byte_length.0)
            .map_err(|problem| Fault::new(here, problem))?;
        // Zero is what exporters write for elements that follow one another.
        let stride = view
            .byte_stride
            .map(|stride| stride.0)
            .filter(|&stride| stride > 0);
        Ok((bytes, stride))
    }
}

/// A part of a buffer.
fn section(buffer: &[u8], start: u64, length: u64) -> Result<&[u8], String> {
    let end = start.checked_add(length);
    let range =
        end.and_then(|end| buffer.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?));
    range.ok_or_else(|| format!("reaches beyond the {} bytes of its buffer", buffer.len()))
}

/// Decodes all compressed buffer views.
fn decompress(
    root: &Root,
    buffers: &[Result<Vec<u8>, String>],
) -> Result<HashMap<usize, (Vec<u8>, usize)>, Fault> {
    let mut budget = Budget::geometry();
    let mut decompressed = HashMap::new();
    for index in 0..root.buffer_views.len() {
        let Some(compressed) = Compressed::of_view(root, index)? else {
            continue;
        };
        let at = place(
            "bufferViews",
            index,
            root.buffer_views[index].name.as_deref(),
        );
        let buffer = buffers.get(compressed.buffer);
        let buffer = buffer
            .ok_or_else(|| Fault::new(&*at, "is compressed in a buffer that there is not"))?;
        let bytes = match buffer {
            Ok(buffer) => section(buffer, compressed.offset as u64, compressed.length as u64),
            Err(problem) => Err(problem.clone()),
        };
        let bytes = bytes.map_err(|problem| Fault::new(&*at, problem))?;
        let decoded = compressed.decode(bytes, &mut budget, &at)?;
        decompressed.insert(index, (decoded, compressed.stride));
    }
    Ok(decompressed)
}

/// The bytes of a buffer, without what lies behind it.
fn of_length(mut bytes: Vec<u8>, buffer: &json::Buffer) -> Result<Vec<u8>, String> {
    let length =
        usize::try_from(buffer.byte_length.0).map_err(|_| "byteLength is too large".to_owned())?;
    if bytes.len() < length {
        return Err(format!(
            "has {} bytes, but byteLength says {length}",
            bytes.len()
        ));
    }
    // Padding of the GLB chunk is not part of the buffer.
    bytes.truncate(length);
    Ok(bytes)
}
