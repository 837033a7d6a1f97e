//! A glTF file's JSON and buffers, before anything is interpreted.
//!
//! The JSON is read into `gltf::json` types without that crate's validation, which refuses extensions we
//! can read and indexes out of bounds in others. Every index is looked up with a check here instead.

use std::path::{Path, PathBuf};

use gltf::json::{self, Animation, Index, Root, Value};

use super::extensions;
use crate::import::error::{Fault, ImportError, MAKE_SMALLER, Warnings, place};
use crate::import::files;

/// More JSON objects than this would need gigabytes once parsed.
const MAX_JSON_OBJECTS: usize = 2_000_000;

/// A parsed file with its buffers.
pub(super) struct Document {
    /// Where the file is.
    pub(super) file: PathBuf,
    /// The JSON.
    pub(super) root: Root,
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
            split_glb(&bytes).map_err(|fault| fault.in_file(file))?
        } else {
            (bytes.as_slice(), None)
        };
        let root = parse(json).map_err(|fault| fault.in_file(file))?;
        check_version(&root).map_err(|fault| fault.in_file(file))?;
        extensions::check_required(&root, file)?;

        let mut document = Self {
            file: file.to_owned(),
            root,
            buffers: Vec::new(),
        };
        let buffers = document.root.buffers.iter().enumerate();
        document.buffers = buffers
            .map(|(index, buffer)| load_buffer(index, buffer, file, binary))
            .collect();
        extensions::warn_about_root(&document.root, warnings);
        Ok(document)
    }

    /// The folder that relative URIs start from.
    pub(super) fn folder(&self) -> &Path {
        self.file.parent().unwrap_or(Path::new(""))
    }

    /// Bytes of a buffer view and its stride.
    pub(super) fn view(
        &self,
        index: Index<json::buffer::View>,
        user: &str,
    ) -> Result<(&[u8], Option<usize>), Fault> {
        let view = get(&self.root.buffer_views, index, "bufferViews", user)?;
        let here = place("bufferViews", index.value(), view.name.as_deref());
        let buffer = get(
            &self.buffers,
            Index::<json::Buffer>::new(index_u32(view.buffer)),
            "buffers",
            &here,
        )?;
        let buffer = buffer.as_ref().map_err(|problem| {
            Fault::new(format!("buffers/{}", view.buffer.value()), problem.clone())
        })?;
        let start = view.byte_offset.unwrap_or_default().0;
        let bytes = start
            .checked_add(view.byte_length.0)
            .and_then(|end| buffer.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?))
            .ok_or_else(|| {
                Fault::new(
                    here,
                    format!("reaches beyond the {} bytes of its buffer", buffer.len()),
                )
            })?;
        Ok((bytes, view.byte_stride.map(|stride| stride.0)))
    }
}

fn index_u32<T>(index: Index<T>) -> u32 {
    index.value() as u32
}

/// Looks an index up, naming both ends where it dangles.
pub(super) fn get<'a, T, U>(
    items: &'a [T],
    index: Index<U>,
    array: &str,
    user: &str,
) -> Result<&'a T, Fault> {
    items.get(index.value()).ok_or_else(|| {
        Fault::new(
            user,
            format!(
                "refers to {array}/{}, but there are {}",
                index.value(),
                items.len()
            ),
        )
    })
}

fn parse(json: &[u8]) -> Result<Root, Fault> {
    if json.iter().filter(|&&byte| byte == b'{').count() > MAX_JSON_OBJECTS {
        let problem = format!("more than {MAX_JSON_OBJECTS} JSON objects");
        return Err(Fault::new("JSON", problem).advise(MAKE_SMALLER));
    }
    // The specification forbids a byte order mark and allows readers to skip it.
    let json = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    Root::from_slice(json).or_else(|error| {
        parse_leniently(json).ok_or_else(|| {
            let place = format!("line {} column {}", error.line(), error.column());
            Fault::new(place, format!("invalid JSON or glTF: {error}"))
        })
    })
}

/// Second try without what the `gltf` crate is stricter about than the specification: a scene needs no
/// nodes, an animation channel needs no node, and animations are not shown anyway.
fn parse_leniently(json: &[u8]) -> Option<Root> {
    let mut value: Value = serde_json::from_slice(json).ok()?;
    let members = value.as_object_mut()?;
    let had_animations = members.remove("animations").is_some();
    for scene in members
        .get_mut("scenes")
        .and_then(Value::as_array_mut)
        .into_iter()
        .flatten()
    {
        scene
            .as_object_mut()?
            .entry("nodes")
            .or_insert_with(|| Value::Array(Vec::new()));
    }
    let mut root: Root = serde_json::from_value(value).ok()?;
    if had_animations {
        let (channels, samplers) = (Vec::new(), Vec::new());
        root.animations.push(Animation {
            extensions: None,
            extras: None,
            channels,
            name: None,
            samplers,
        });
    }
    Some(root)
}

fn check_version(root: &Root) -> Result<(), Fault> {
    let asset = &root.asset;
    let needed = asset.min_version.as_ref().unwrap_or(&asset.version);
    if asset.version.starts_with("2.") && (asset.min_version.is_none() || needed == "2.0") {
        return Ok(());
    }
    let problem = format!("glTF version {needed} is not 2.0");
    Err(Fault::new("asset/version", problem).advise("export it as glTF 2.0"))
}

/// Splits a binary glTF into its JSON and the binary chunk.
fn split_glb(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let word = |at: usize| -> Option<u32> {
        let word = bytes.get(at..at.checked_add(4)?)?;
        Some(u32::from_le_bytes(word.try_into().ok()?))
    };
    let truncated = |at: usize| Fault::new(format!("byte {at}"), "the GLB file ends too early");
    if word(4).ok_or_else(|| truncated(4))? != 2 {
        return Err(Fault::new("byte 4", "the GLB container's version is not 2")
            .advise("export it as glTF 2.0"));
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
            (0, 0x4e4f_534a) => json = Some(&bytes[at + 8..end]),
            (1, 0x004e_4942) => binary = Some(&bytes[at + 8..end]),
            // Other chunks are to be ignored.
            _ => {}
        }
        at = end;
    }
    let json = json.ok_or_else(|| Fault::new("byte 12", "the first chunk is not JSON"))?;
    Ok((json, binary))
}

fn load_buffer(
    index: usize,
    buffer: &json::Buffer,
    file: &Path,
    binary: Option<&[u8]>,
) -> Result<Vec<u8>, String> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let mut bytes = match &buffer.uri {
        Some(uri) => files::read_uri(uri, folder)?,
        None if index == 0 => binary
            .ok_or("has neither a uri nor a GLB binary chunk")?
            .to_vec(),
        None => return Err("has no uri".into()),
    };
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
