//! URIs: files beside the scene, and data within it.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use crate::import::folders::Folders;
use crate::import::{files, percent, text};

/// How many parts of a path of another machine may lead to a file from here.
const MAX_PARTS: usize = 6;

/// What a URI names.
pub(super) enum Uri<'a> {
    /// The data behind `data:`, media type and comma included.
    Data(&'a str),
    /// Something to fetch, which we do not do.
    Remote,
    /// A file, relative to that of the scene, or anywhere on the machine that wrote it.
    File(&'a str),
}

impl<'a> Uri<'a> {
    /// Tells the kinds apart.
    pub(super) fn new(uri: &'a str) -> Self {
        if let Some(data) = after_scheme(uri, "data:") {
            return Self::Data(data);
        }
        match after_scheme(uri, "file:") {
            // A host may stand before the third slash.
            Some(path) => Self::File(path.strip_prefix("//localhost").unwrap_or(path)),
            None if uri.contains("://") => Self::Remote,
            None => Self::File(uri),
        }
    }
}

/// What follows a scheme, which may be written in any case.
fn after_scheme<'a>(uri: &'a str, scheme: &str) -> Option<&'a str> {
    let (start, rest) = uri.split_at_checked(scheme.len())?;
    start.eq_ignore_ascii_case(scheme).then_some(rest)
}

/// What a URI gives.
pub(super) struct Content {
    /// The bytes.
    pub(super) bytes: Vec<u8>,
    /// Where they were found, if the URI does not say so.
    pub(super) remark: Option<String>,
}

/// Reads what a URI names; files are relative to `folder`.
pub(super) fn read(uri: &str, folder: &Path, folders: &mut Folders) -> Result<Content, String> {
    match Uri::new(uri) {
        Uri::Data(data) => {
            let (media_type, payload) = data.split_once(',').ok_or("the data URI has no comma")?;
            let is_base64 = media_type
                .rsplit(';')
                .next()
                .is_some_and(|last| last.trim().eq_ignore_ascii_case("base64"));
            let bytes = if is_base64 && payload.contains('%') {
                decode_base64(&String::from_utf8_lossy(&percent::decode(payload)))?
            } else if is_base64 {
                decode_base64(payload)?
            } else {
                percent::decode(payload)
            };
            Ok(Content {
                bytes,
                remark: None,
            })
        }
        Uri::Remote => Err(format!(
            "{uri}: remote files are not fetched; download it beside the scene"
        )),
        Uri::File(name) => {
            let found = file_path(name, folder, folders)?;
            let bytes = files::read(&found.path)
                .map_err(|message| format!("{} {message}", found.path.display()))?;
            let remark = found
                .is_guess
                .then(|| format!("{name} is not here; {} is used", found.path.display()));
            Ok(Content { bytes, remark })
        }
    }
}

/// Where a file is.
pub(super) struct Location {
    /// The file, which need not exist.
    pub(super) path: PathBuf,
    /// Only the end of its path is that of the URI.
    is_guess: bool,
}

/// The path of [`Uri::File`]: where it says, or beside the scene under the end of its name.
pub(super) fn file_path(
    name: &str,
    folder: &Path,
    folders: &mut Folders,
) -> Result<Location, String> {
    let readings = readings(name)?;
    let location = |is_guess| move |path| Location { path, is_guess };
    let mut named = readings.iter();
    if let Some(path) = named.find_map(|name| folders.find(OsStr::new(name), folder)) {
        return Ok(location(false)(path));
    }
    let guess = readings.iter().find_map(|name| {
        let parts: Vec<&str> = name.split(['/', '\\']).collect();
        let longest = parts.len().saturating_sub(MAX_PARTS).max(1);
        (longest..parts.len()).find_map(|start| {
            let end = parts[start..].join("/");
            folders.find(OsStr::new(&end), folder)
        })
    });
    let absent = || location(false)(folder.join(&readings[0]));
    Ok(guess.map(location(true)).unwrap_or_else(absent))
}

/// What a name may mean: escapes are decoded, as the specification says; exporters forget to encode, so that a file may
/// literally be called `a%20b.png`; some encode twice, or add a query.
fn readings(name: &str) -> Result<Vec<String>, String> {
    // Escapes of a legacy code page are rarer than those of UTF-8.
    let decode = |name: &str| text::decode(percent::decode(name));
    let decoded = decode(name);
    let mut readings = vec![decoded.clone(), name.to_owned()];
    readings.push(decode(&decoded));
    for text in [name, &decoded] {
        if let Some(end) = text.find(['?', '#']) {
            readings.push(decode(&text[..end]));
        }
    }
    let mut seen = HashSet::new();
    readings.retain(|reading| !reading.is_empty() && seen.insert(reading.clone()));
    if readings.is_empty() {
        return Err("the uri is empty".into());
    }
    Ok(readings)
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
            b'\r' | b'\n' | b' ' | b'\t' => continue,
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
}
