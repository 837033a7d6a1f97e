//! Decoding one image, of a size that is looked at first.

use std::io::Cursor;

use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use super::limits::{LARGEST_RADIANCE, MAX_EXTENT};
use super::sixteen_bits::of_16_bits;
use super::unreadable::unreadable;
use super::{basis, openexr, radiance};
use crate::desc::{ImageDesc, Texels};
use crate::import::budget::Budget;
use crate::import::guard::without_panic;
use crate::import::warnings::Warnings;

/// How a file is encoded, with what was found out about it.
#[derive(Debug)]
pub(super) enum Encoding {
    Image(ImageFormat),
    Basis([u32; 2]),
    OpenExr(openexr::Layout),
    Radiance(radiance::Header),
}

/// Decodes one image that the scene cannot do without.
pub(in crate::import) fn decode_one(
    bytes: &[u8],
    extension: Option<&str>,
) -> Result<Decoded, String> {
    let encoding = inspect(bytes, extension, &mut Budget::images(bytes.len() as u64))?;
    decode(bytes, encoding)
}

/// A decoded image without a name.
pub(in crate::import) struct Decoded {
    width: u32,
    height: u32,
    /// The texels.
    pub(in crate::import) texels: Texels,
    /// What was ignored, replaced or guessed.
    remarks: Vec<String>,
}

impl Decoded {
    /// Reports what is not as it is in the file.
    pub(in crate::import) fn warn(&self, place: &str, warnings: &mut Warnings) {
        for remark in &self.remarks {
            warnings.push(place, remark);
        }
    }

    /// Names it.
    pub(in crate::import) fn into_desc(self, name: String) -> ImageDesc {
        ImageDesc {
            name,
            width: self.width,
            height: self.height,
            texels: self.texels,
        }
    }
}

/// Finds the encoding and refuses sizes beyond the limits, before anything is allocated.
pub(super) fn inspect(
    bytes: &[u8],
    extension: Option<&str>,
    budget: &mut Budget,
) -> Result<Encoding, String> {
    let (encoding, [width, height], texel_bytes) = without_panic(|| look(bytes, extension))?;
    if width == 0 || height == 0 || width > MAX_EXTENT || height > MAX_EXTENT {
        return Err(format!(
            "has {width} × {height} texels; 1 to {MAX_EXTENT} each way are read"
        ));
    }
    budget
        .charge(u64::from(width) * u64::from(height), texel_bytes, "images")
        .map_err(|fault| format!("makes {}", fault.problem))?;
    Ok(encoding)
}

/// The encoding, width and height, and the bytes that a texel will take.
fn look(bytes: &[u8], extension: Option<&str>) -> Result<(Encoding, [u32; 2], u64), String> {
    if openexr::is_openexr(bytes) {
        let layout = openexr::layout(bytes)?;
        let size = [layout.width, layout.height];
        return Ok((Encoding::OpenExr(layout), size, 16));
    }
    if basis::is_ktx2(bytes) {
        let size = basis::size(bytes)?;
        return Ok((Encoding::Basis(size), size, 4));
    }
    if radiance::is_radiance(bytes) {
        let header = radiance::header(bytes)?;
        let size = [header.width, header.height];
        return Ok((Encoding::Radiance(header), size, 16));
    }
    let mut reader = ImageReader::new(Cursor::new(bytes));
    if let Some(format) = extension.and_then(ImageFormat::from_extension) {
        reader.set_format(format);
    }
    let reader = reader.with_guessed_format().map_err(unreadable)?;
    let format = reader.format().ok_or("has an unknown format")?;
    let decoder = reader.into_decoder().map_err(unreadable)?;
    let texel_bytes = match decoder.color_type() {
        ColorType::L16 | ColorType::La16 | ColorType::Rgb16 | ColorType::Rgba16 => 8,
        ColorType::Rgb32F | ColorType::Rgba32F => 16,
        _ => 4,
    };
    let size = decoder.dimensions().into();
    Ok((Encoding::Image(format), size, texel_bytes))
}

/// Decodes an image whose encoding [`inspect`] found.
pub(super) fn decode(bytes: &[u8], encoding: Encoding) -> Result<Decoded, String> {
    without_panic(|| match encoding {
        Encoding::OpenExr(layout) => {
            let texels = openexr::texels(bytes, &layout)?;
            let size = [layout.width, layout.height];
            Ok(valid(size, texels, layout.largest, layout.remarks))
        }
        Encoding::Basis([width, height]) => {
            let texels = basis::texels(bytes)?;
            if texels.len() as u64 != u64::from(width) * u64::from(height) {
                return Err("has another number of texels than its size says".into());
            }
            Ok(Decoded {
                width,
                height,
                texels: Texels::Rgba8(texels),
                remarks: Vec::new(),
            })
        }
        Encoding::Radiance(header) => {
            let texels = radiance::texels(bytes, &header)?;
            let size = [header.width, header.height];
            Ok(valid(size, texels, LARGEST_RADIANCE, header.remarks))
        }
        Encoding::Image(format) => decode_with_image(bytes, format),
    })
}

fn decode_with_image(bytes: &[u8], format: ImageFormat) -> Result<Decoded, String> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(1 << 30);
    reader.limits(limits);
    let image = reader.decode().map_err(unreadable)?;
    let (width, height) = (image.width(), image.height());
    let texels = match image {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let texels = image.into_rgba32f().into_raw().as_chunks().0.to_vec();
            return Ok(valid([width, height], texels, LARGEST_RADIANCE, Vec::new()));
        }
        DynamicImage::ImageLuma16(_)
        | DynamicImage::ImageLumaA16(_)
        | DynamicImage::ImageRgb16(_)
        | DynamicImage::ImageRgba16(_) => of_16_bits(image.into_rgba16().into_raw().as_chunks().0),
        _ => Texels::Rgba8(image.into_rgba8().into_raw().as_chunks().0.to_vec()),
    };
    Ok(Decoded {
        width,
        height,
        texels,
        remarks: Vec::new(),
    })
}

/// Makes numbers of texels of any bits.
fn valid(
    [width, height]: [u32; 2],
    mut texels: Vec<[f32; 4]>,
    largest: f32,
    mut remarks: Vec<String>,
) -> Decoded {
    let (mut replaced, mut infinite) = (0, 0);
    for texel in &mut texels {
        if texel.iter().all(|&value| (0.0..=largest).contains(&value)) {
            continue;
        }
        replaced += usize::from(!texel.iter().all(|&value| value >= 0.0));
        infinite += usize::from(texel.iter().any(|&value| value > largest));
        // NaN is the smaller one of nothing.
        *texel = texel.map(|value| value.max(0.0).min(largest));
    }
    for (count, problem, used) in [
        (replaced, "NaN or negative", 0.0),
        (infinite, "infinite or too large", largest),
    ] {
        if count > 0 {
            remarks.push(format!(
                "{count} texels have {problem} values; {used} is used"
            ));
        }
    }
    Decoded {
        width,
        height,
        texels: Texels::RgbaF32(texels),
        remarks,
    }
}
