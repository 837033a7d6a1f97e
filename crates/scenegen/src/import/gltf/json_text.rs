//! The text of a glTF file's JSON: UTF-8 without a byte order mark and padding, as the specification wants it, from what
//! programs write.

use std::borrow::Cow;

use crate::import::error::Fault;
use crate::import::text;
use crate::import::warnings::Warnings;

/// The JSON as UTF-8.
pub(super) fn read<'a>(bytes: &'a [u8], warnings: &mut Warnings) -> Result<Cow<'a, [u8]>, Fault> {
    let has_zeros = bytes.iter().take(2).any(|&byte| byte == 0 || byte >= 0xfe);
    let unpadded = match has_zeros {
        true => bytes,
        false => without_padding(bytes),
    };
    if without_padding(bytes).trim_ascii().is_empty() {
        return Err(Fault::new("JSON", "there is none: the file is empty"));
    }
    if bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"\x1f\x8b") {
        let advice = "unpack it, and give the .gltf or .glb file in it";
        return Err(Fault::new("JSON", "the file is a packed archive").advise(advice));
    }
    let unmarked = unpadded.strip_prefix(b"\xef\xbb\xbf").unwrap_or(unpadded);
    if !has_zeros && str::from_utf8(unmarked).is_ok() {
        return Ok(Cow::Borrowed(unmarked));
    }
    let what = match has_zeros {
        true => "is UTF-16 or UTF-32",
        false => "is not UTF-8; bytes that are not are read as Windows-1252",
    };
    warnings.push(
        "JSON",
        format!("{what}, where the specification wants UTF-8"),
    );
    let decoded = text::decode(unmarked.to_vec());
    Ok(Cow::Owned(decoded.trim_end_matches('\0').into()))
}

/// Chunks of binary files are to be filled up with spaces; some are with zeros.
fn without_padding(bytes: &[u8]) -> &[u8] {
    let last = bytes.iter().rposition(|&byte| byte != 0);
    &bytes[..last.map_or(0, |last| last + 1)]
}

/// The text without two things that JSON does not know: commas before a closing bracket, and numbers that are none, for which
/// it has `null`. `None` where there is neither.
pub(super) fn tolerant(json: &[u8]) -> Option<Vec<u8>> {
    /// As C, JavaScript and Python write them.
    const NO_NUMBERS: [&str; 8] = [
        "-infinity",
        "infinity",
        "-inf",
        "inf",
        "-nan(ind)",
        "-nan",
        "nan(ind)",
        "nan",
    ];
    let mut text = Vec::with_capacity(json.len());
    let mut at = 0;
    let mut last = None;
    while at < json.len() {
        let byte = json[at];
        if byte == b'"' {
            let end = end_of_string(json, at);
            text.extend(&json[at..end]);
            at = end;
            last = None;
            continue;
        }
        let rest = &json[at..];
        let no_number = NO_NUMBERS.iter().find(|word| {
            let start = rest.get(..word.len());
            start.is_some_and(|start| start.eq_ignore_ascii_case(word.as_bytes()))
        });
        if let Some(word) = no_number {
            text.extend(b"null");
            at += word.len();
            last = None;
            continue;
        }
        if let (b']' | b'}', Some(comma)) = (byte, last) {
            text.remove(comma);
        }
        if byte == b',' {
            last = Some(text.len());
        } else if !byte.is_ascii_whitespace() {
            last = None;
        }
        text.push(byte);
        at += 1;
    }
    (text != json).then_some(text)
}

/// Where the string that starts at a quotation mark ends, behind the second one.
fn end_of_string(json: &[u8], start: usize) -> usize {
    let mut at = start + 1;
    while at < json.len() {
        match json[at] {
            b'"' => return at + 1,
            b'\\' => at += 2,
            _ => at += 1,
        }
    }
    json.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(bytes: &[u8]) -> (String, usize) {
        let mut warnings = Warnings::default();
        let text = read(bytes, &mut warnings).unwrap().into_owned();
        (String::from_utf8(text).unwrap(), warnings.into_vec().len())
    }

    #[test]
    fn every_encoding_gives_the_same_text() {
        let json = r#"{"name":"Grün 金"}"#;
        assert_eq!(text(json.as_bytes()), (json.to_owned(), 0));
        assert_eq!(
            text(format!("\u{feff}{json}").as_bytes()),
            (json.to_owned(), 0)
        );
        assert_eq!(
            text(format!("{json}\0\0\0").as_bytes()),
            (json.to_owned(), 0)
        );
        let utf16 = |mark: &str, bytes: fn(u16) -> [u8; 2]| -> Vec<u8> {
            format!("{mark}{json}")
                .encode_utf16()
                .flat_map(bytes)
                .collect()
        };
        for mark in ["", "\u{feff}"] {
            assert_eq!(text(&utf16(mark, u16::to_le_bytes)), (json.to_owned(), 1));
            assert_eq!(text(&utf16(mark, u16::to_be_bytes)), (json.to_owned(), 1));
        }
        assert_eq!(
            text(b"{\"name\":\"Gr\xfcn\"}"),
            (r#"{"name":"Grün"}"#.into(), 1)
        );
    }

    #[test]
    fn what_is_no_json_is_named() {
        let mut warnings = Warnings::default();
        for (bytes, word) in [(&b" \n\0"[..], "empty"), (b"PK\x03\x04..", "archive")] {
            let fault = read(bytes, &mut warnings).unwrap_err();
            assert!(fault.problem.contains(word), "{}", fault.problem);
        }
    }

    #[test]
    fn commas_too_many_and_numbers_that_are_none_are_mended() {
        let mend =
            |json: &str| tolerant(json.as_bytes()).map(|text| String::from_utf8(text).unwrap());
        assert_eq!(mend(r#"{"a":[1,2],"b":"NaN,]"}"#), None);
        assert_eq!(mend("[1, 2 , ]").as_deref(), Some("[1, 2  ]"));
        assert_eq!(mend(r#"{"a":1,}"#).as_deref(), Some(r#"{"a":1}"#));
        assert_eq!(
            mend("[NaN,-Infinity, inf,-nan(ind)]").as_deref(),
            Some("[null,null, null,null]")
        );
        assert_eq!(mend(r#"["a\",]",]"#).as_deref(), Some(r#"["a\",]"]"#));
    }
}
