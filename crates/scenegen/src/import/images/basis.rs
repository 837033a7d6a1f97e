//! Basis Universal textures in KTX 2 files (KHR_texture_basisu).

use basisu::{DecodeFlags, TargetFormat, Transcoder};

/// Whether a file is a KTX 2 container.
pub(super) fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\xabKTX 20\xbb\r\n\x1a\n")
}

/// Width and height.
pub(super) fn size(bytes: &[u8]) -> Result<[u32; 2], String> {
    let (width, height) = open(bytes)?.base_dimensions();
    Ok([width, height])
}

/// The texels of the largest level.
pub(super) fn texels(bytes: &[u8]) -> Result<Vec<[u8; 4]>, String> {
    let transcoder = open(bytes)?;
    let decoded = transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE);
    let decoded = decoded.map_err(unreadable)?;
    Ok(decoded.as_chunks().0.to_vec())
}

fn open(bytes: &[u8]) -> Result<Transcoder<'_>, String> {
    Transcoder::new(bytes).map_err(unreadable)
}

fn unreadable(error: basisu::Error) -> String {
    format!("is no Basis Universal texture that can be read ({error:?})")
}
