//! Bytes as text: OBJ and MTL do not say their encoding, glTF does, and programs write all of them.

use encoding_rs::{
    BIG5, EUC_JP, EUC_KR, Encoding, GB18030, IBM866, ISO_8859_2, ISO_8859_5, ISO_8859_7, KOI8_R,
    MACINTOSH, SHIFT_JIS, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1250, WINDOWS_1251, WINDOWS_1252,
    WINDOWS_1253, WINDOWS_1254, WINDOWS_1255, WINDOWS_1256, WINDOWS_1257, WINDOWS_1258,
};

/// What bytes may be in that are no UTF-8 and no Windows-1252, or were taken for the latter by another program; the most
/// telling first, which have no meaning for most bytes.
const CODE_PAGES: [&Encoding; 20] = [
    UTF_8,
    SHIFT_JIS,
    GB18030,
    BIG5,
    EUC_KR,
    EUC_JP,
    WINDOWS_1251,
    WINDOWS_1250,
    WINDOWS_1253,
    WINDOWS_1254,
    WINDOWS_1255,
    WINDOWS_1256,
    WINDOWS_1257,
    WINDOWS_1258,
    ISO_8859_2,
    ISO_8859_5,
    ISO_8859_7,
    KOI8_R,
    IBM866,
    MACINTOSH,
];

/// Decodes a whole file. A byte order mark decides; without one, text whose every other byte is zero is UTF-16, and a
/// line that is no UTF-8 becomes Windows-1252, which has a character for every byte: whatever code page was meant,
/// different names stay different and [`legacy_bytes`] gives their bytes back.
pub(super) fn decode(bytes: Vec<u8>) -> String {
    match bytes[..] {
        [0xff, 0xfe, 0, 0, ..] => decode_utf32(&bytes[4..], u32::from_le_bytes),
        [0, 0, 0xfe, 0xff, ..] => decode_utf32(&bytes[4..], u32::from_be_bytes),
        [0xff, 0xfe, ..] => decode_as(UTF_16LE, &bytes[2..]),
        [0xfe, 0xff, ..] => decode_as(UTF_16BE, &bytes[2..]),
        // A mark of UTF-8 is white space to those who read lines.
        _ => match unmarked_utf16(&bytes) {
            Some(encoding) => decode_as(encoding, &bytes),
            None => String::from_utf8(bytes).unwrap_or_else(|error| decode_lines(error.as_bytes())),
        },
    }
}

fn decode_as(encoding: &'static Encoding, bytes: &[u8]) -> String {
    encoding.decode_without_bom_handling(bytes).0.into_owned()
}

/// Files are put together of others, so that each line may have its own encoding.
fn decode_lines(bytes: &[u8]) -> String {
    let lines = bytes.split_inclusive(|byte| matches!(byte, b'\n' | b'\r'));
    let mut text = String::with_capacity(bytes.len());
    for line in lines {
        match str::from_utf8(line) {
            Ok(line) => text.push_str(line),
            Err(_) => text.push_str(&decode_as(WINDOWS_1252, line)),
        }
    }
    text
}

/// The bytes of text that was decoded as Windows-1252; `None` where it has other characters.
pub(in crate::import) fn legacy_bytes(text: &str) -> Option<Vec<u8>> {
    let (bytes, _, has_other_characters) = WINDOWS_1252.encode(text);
    (!has_other_characters).then(|| bytes.into_owned())
}

/// What the bytes of text that was decoded as Windows-1252 may have meant; nothing where they are ASCII or were not.
pub(in crate::import) fn other_decodings(text: &str) -> Vec<String> {
    let bytes = legacy_bytes(text).filter(|bytes| !bytes.is_ascii());
    let decode = |bytes: &Vec<u8>| -> Vec<String> {
        let decoded = CODE_PAGES
            .iter()
            .filter_map(|page| page.decode_without_bom_handling_and_without_replacement(bytes));
        decoded.map(|text| text.into_owned()).collect()
    };
    bytes.as_ref().map(decode).unwrap_or_default()
}

/// UTF-16 without a byte order mark. Most characters are ASCII, of which one of the two bytes is zero.
fn unmarked_utf16(bytes: &[u8]) -> Option<&'static Encoding> {
    let (pairs, _) = bytes[..bytes.len().min(1024)].as_chunks::<2>();
    let zeros = [0, 1].map(|half| pairs.iter().filter(|pair| pair[half] == 0).count());
    match zeros {
        [0, low] if 4 * low > pairs.len() => Some(UTF_16LE),
        [high, 0] if 4 * high > pairs.len() => Some(UTF_16BE),
        _ => None,
    }
}

fn decode_utf32(bytes: &[u8], code: fn([u8; 4]) -> u32) -> String {
    let (codes, _) = bytes.as_chunks::<4>();
    let decode = |&bytes| char::from_u32(code(bytes)).unwrap_or(char::REPLACEMENT_CHARACTER);
    codes.iter().map(decode).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_gives_the_same_text() {
        let text = "# Grün\nv 1 2 3\nusemtl Öl 金\n";
        let utf16 = |bytes: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(bytes).collect();
        let utf32 =
            |bytes: fn(u32) -> [u8; 4]| text.chars().flat_map(|c| bytes(c.into())).collect();
        let files: [(&[u8], Vec<u8>); 8] = [
            (&[], text.into()),
            (&[0xef, 0xbb, 0xbf], text.into()),
            (&[], utf16(u16::to_le_bytes)),
            (&[], utf16(u16::to_be_bytes)),
            (&[0xff, 0xfe], utf16(u16::to_le_bytes)),
            (&[0xfe, 0xff], utf16(u16::to_be_bytes)),
            (&[0xff, 0xfe, 0, 0], utf32(u32::to_le_bytes)),
            (&[0, 0, 0xfe, 0xff], utf32(u32::to_be_bytes)),
        ];
        for (mark, bytes) in files {
            let decoded = decode([mark, &bytes].concat());
            assert_eq!(decoded.trim_start_matches('\u{feff}'), text, "{mark:x?}");
        }
        assert_eq!(decode(Vec::new()), "");
        assert_eq!(decode(vec![b'v']), "v");
    }

    #[test]
    fn bytes_of_code_pages_stay_distinct() {
        let every_byte: Vec<u8> = (0x80..=0xff).collect();
        let text = decode(every_byte.clone());
        assert_eq!(text.chars().count(), 128);
        assert_eq!(legacy_bytes(&text), Some(every_byte));
        assert_eq!(decode(b"usemtl \xd6l".to_vec()), "usemtl Öl");
        assert_eq!(legacy_bytes("金"), None);
        assert_eq!(
            decode(b"# \xa9\rusemtl \xc3\x96l\n".to_vec()),
            "# ©\rusemtl Öl\n"
        );
    }
}
