//! URIs: files beside the scene, and data within it.

use std::path::{Path, PathBuf};

use crate::import::files;

/// What a URI names.
pub(super) enum Uri<'a> {
    /// The data behind `data:`, media type and comma included.
    Data(&'a str),
    /// Something to fetch, which we do not do.
    Remote,
    /// A file, relative to that of the scene.
    File(&'a str),
}

impl<'a> Uri<'a> {
    /// Tells the kinds apart.
    pub(super) fn new(uri: &'a str) -> Self {
        match uri.strip_prefix("data:") {
            Some(data) => Self::Data(data),
            None if uri.contains("://") => Self::Remote,
            None => Self::File(uri),
        }
    }
}

/// Reads what a URI names; files are relative to `folder`.
pub(super) fn read(uri: &str, folder: &Path) -> Result<Vec<u8>, String> {
    match Uri::new(uri) {
        Uri::Data(data) => {
            let (media_type, payload) = data.split_once(',').ok_or("the data URI has no comma")?;
            if media_type.ends_with(";base64") {
                decode_base64(payload)
            } else {
                Ok(percent_decode(payload))
            }
        }
        Uri::Remote => Err(format!(
            "{uri}: remote files are not fetched; download it beside the scene"
        )),
        Uri::File(name) => {
            let path = file_path(name, folder)?;
            files::read(&path).map_err(|message| format!("{} {message}", path.display()))
        }
    }
}

/// The path of [`Uri::File`].
pub(super) fn file_path(name: &str, folder: &Path) -> Result<PathBuf, String> {
    let decoded =
        String::from_utf8(percent_decode(name)).map_err(|_| format!("{name}: not UTF-8"))?;
    // Exporters forget to encode; a file literally called `a%20b.png` is tried second.
    let [decoded, literal] = [folder.join(&decoded), folder.join(name)];
    Ok(if !decoded.is_file() && literal.is_file() {
        literal
    } else {
        decoded
    })
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
