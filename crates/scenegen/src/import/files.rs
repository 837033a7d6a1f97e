//! Reading files named by other files: URIs, data URIs and the paths of OBJ and MTL files.

use std::fs;
use std::path::{Path, PathBuf};

/// The largest file read whole.
const MAX_FILE_BYTES: u64 = 1 << 30;

/// Reads a regular file of bounded size.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, String> {
    let metadata = fs::metadata(path).map_err(|error| format!("cannot be read ({error})"))?;
    // A device or pipe named by a hostile file would never end.
    if !metadata.is_file() {
        return Err("is not a regular file".into());
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(format!(
            "has {} bytes, more than the 1 GiB we read",
            metadata.len()
        ));
    }
    fs::read(path).map_err(|error| format!("cannot be read ({error})"))
}

/// Reads what a glTF URI names: a data URI, or a file relative to `folder`.
pub(super) fn read_uri(uri: &str, folder: &Path) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (media_type, payload) = data.split_once(',').ok_or("the data URI has no comma")?;
        return if media_type.ends_with(";base64") {
            decode_base64(payload)
        } else {
            Ok(percent_decode(payload))
        };
    }
    if uri.contains("://") {
        return Err(format!(
            "{uri}: remote files are not fetched; download it beside the scene"
        ));
    }
    let path = uri_path(uri, folder)?;
    read(&path).map_err(|message| format!("{} {message}", path.display()))
}

/// The file that a URI without a scheme names.
pub(super) fn uri_path(uri: &str, folder: &Path) -> Result<PathBuf, String> {
    let decoded =
        String::from_utf8(percent_decode(uri)).map_err(|_| format!("{uri}: not UTF-8"))?;
    // Exporters forget to encode; a file literally called `a%20b.png` is tried second.
    let [decoded, literal] = [folder.join(&decoded), folder.join(uri)];
    Ok(if !decoded.is_file() && literal.is_file() {
        literal
    } else {
        decoded
    })
}

/// The files that a glTF file refers to; `None` where it is another kind of file or cannot be read.
pub(crate) fn external_files(scene: &Path) -> Option<Vec<PathBuf>> {
    if !scene.extension()?.eq_ignore_ascii_case("gltf") {
        return None;
    }
    let root: serde_json::Value = serde_json::from_slice(&read(scene).ok()?).ok()?;
    let folder = scene.parent()?;
    let entries = ["buffers", "images"]
        .into_iter()
        .filter_map(|array| root.get(array)?.as_array())
        .flatten();
    let uris = entries.filter_map(|entry| entry.get("uri")?.as_str());
    let files = uris.filter(|uri| !uri.starts_with("data:") && !uri.contains("://"));
    Some(files.filter_map(|uri| uri_path(uri, folder).ok()).collect())
}

/// Finds a file named in an OBJ or MTL file: backslashes are separators, and where nothing has the exact
/// name, one that differs only in case will do (these files come from systems that ignore case).
pub(super) fn find_loosely(name: &str, folder: &Path) -> Option<PathBuf> {
    let name = name.trim().replace('\\', "/");
    if name.is_empty() {
        return None;
    }
    let exact = folder.join(&name);
    if exact.is_file() {
        return Some(exact);
    }
    let mut path = if name.starts_with('/') {
        PathBuf::from("/")
    } else {
        folder.to_owned()
    };
    for part in name
        .split('/')
        .filter(|part| !part.is_empty() && *part != ".")
    {
        let next = path.join(part);
        path = if part == ".." || next.exists() {
            next
        } else {
            let mut matches: Vec<PathBuf> = fs::read_dir(&path)
                .ok()?
                .filter_map(Result::ok)
                .filter(|entry| {
                    entry
                        .file_name()
                        .to_string_lossy()
                        .eq_ignore_ascii_case(part)
                })
                .map(|entry| entry.path())
                .collect();
            matches.sort();
            matches.into_iter().next()?
        };
    }
    path.is_file().then_some(path)
}

fn percent_decode(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let escape = (bytes[at] == b'%')
            .then(|| bytes.get(at + 1..at + 3))
            .flatten();
        match escape.and_then(|hex| Some(hex_digit(hex[0])? << 4 | hex_digit(hex[1])?)) {
            Some(byte) => {
                decoded.push(byte);
                at += 3;
            }
            None => {
                decoded.push(bytes[at]);
                at += 1;
            }
        }
    }
    decoded
}

fn hex_digit(byte: u8) -> Option<u8> {
    char::from(byte).to_digit(16).map(|digit| digit as u8)
}

/// RFC 4648 with the standard or the URL alphabet; padding may be missing.
fn decode_base64(text: &str) -> Result<Vec<u8>, String> {
    let text = text.trim_end_matches('=');
    let mut decoded = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let mut bits = 0_u32;
    let mut bit_count = 0;
    for byte in text.bytes() {
        let digit = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'\r' | b'\n' => continue,
            _ => {
                return Err(format!(
                    "the data URI has the byte {byte:#04x}, which is not base64"
                ));
            }
        };
        bits = bits << 6 | u32::from(digit);
        bit_count += 6;
        if bit_count >= 8 {
            bit_count -= 8;
            decoded.push((bits >> bit_count) as u8);
        }
    }
    if bit_count == 6 {
        return Err("the data URI's base64 ends within a byte".into());
    }
    Ok(decoded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_round_trips_known_vectors() {
        for (text, expected) in [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg", "foob"),
        ] {
            assert_eq!(decode_base64(text).unwrap(), expected.as_bytes(), "{text}");
        }
        assert_eq!(decode_base64("-_8=").unwrap(), [0xfb, 0xff]);
        assert!(decode_base64("Zm9vY").is_err());
        assert!(decode_base64("Zm9*").is_err());
    }

    #[test]
    fn percent_escapes_are_decoded_and_broken_ones_kept() {
        assert_eq!(percent_decode("a%20b"), b"a b");
        assert_eq!(percent_decode("100%"), b"100%");
        assert_eq!(percent_decode("%zz%C3%A9"), "%zzé".as_bytes());
    }
}
