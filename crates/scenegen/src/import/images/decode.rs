//! Decoding one image, of a size that is looked at first.

use std::io::Cursor;

use exr::prelude::{ReadChannels, ReadLayers};
use image::{DynamicImage, ImageFormat, ImageReader};

use crate::desc::{ImageDesc, Texels};
use crate::import::budget::Budget;
use crate::import::guard::without_panic;
use crate::import::warnings::Warnings;

/// The largest width and height.
const MAX_EXTENT: u32 = 16384;

/// How a file is encoded.
#[derive(Clone, Copy)]
pub(super) enum Encoding {
    Image(ImageFormat),
    OpenExr,
}

/// Decodes one image that the scene cannot do without.
pub(in crate::import) fn decode_one(
    bytes: &[u8],
    extension: Option<&str>,
) -> Result<Decoded, String> {
    let encoding = inspect(bytes, extension, &mut Budget::images())?;
    decode(bytes, encoding)
}

/// A decoded image without a name.
pub(in crate::import) struct Decoded {
    width: u32,
    height: u32,
    /// The texels.
    pub(in crate::import) texels: Texels,
    /// How many float texels were negative, infinite or NaN and are 0 now.
    replaced: usize,
}

impl Decoded {
    /// Reports replaced texels.
    pub(in crate::import) fn warn(&self, place: &str, warnings: &mut Warnings) {
        if self.replaced > 0 {
            let message = format!(
                "{} texels have NaN, infinite or negative values; 0 is used",
                self.replaced
            );
            warnings.push(place, message);
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
    let (encoding, width, height) = without_panic(|| {
        if bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
            let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false)
                .map_err(unreadable)?;
            let size = meta.headers.first().ok_or("has no layers")?.layer_size;
            let extent = |size: usize| u32::try_from(size).map_err(|_| "is too large");
            return Ok((
                Encoding::OpenExr,
                extent(size.width())?,
                extent(size.height())?,
            ));
        }
        let mut reader = ImageReader::new(Cursor::new(bytes));
        if let Some(format) = extension.and_then(ImageFormat::from_extension) {
            reader.set_format(format);
        }
        let reader = reader.with_guessed_format().map_err(unreadable)?;
        let format = reader.format().ok_or("has an unknown format")?;
        let (width, height) = reader.into_dimensions().map_err(unreadable)?;
        Ok((Encoding::Image(format), width, height))
    })?;
    if width == 0 || height == 0 || width > MAX_EXTENT || height > MAX_EXTENT {
        return Err(format!(
            "has {width} × {height} texels; 1 to {MAX_EXTENT} each way are read"
        ));
    }
    let texel_bytes = match encoding {
        Encoding::OpenExr | Encoding::Image(ImageFormat::Hdr) => 16,
        Encoding::Image(_) => 4,
    };
    budget
        .charge(u64::from(width) * u64::from(height), texel_bytes, "images")
        .map_err(|fault| format!("makes {}", fault.problem))?;
    Ok(encoding)
}

fn unreadable(error: impl std::fmt::Display) -> String {
    format!("cannot be read ({error})")
}

/// Decodes an image whose encoding [`inspect`] found.
pub(super) fn decode(bytes: &[u8], encoding: Encoding) -> Result<Decoded, String> {
    without_panic(|| match encoding {
        Encoding::OpenExr => decode_exr(bytes),
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
    Ok(match image {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let texels = image.into_rgba32f().into_raw().as_chunks().0.to_vec();
            finite(width, height, texels)
        }
        // 16-bit images are rounded to 8 bits: whether they are sRGB-encoded is known only by their use.
        _ => {
            let texels = image.into_rgba8().into_raw().as_chunks().0.to_vec();
            Decoded {
                width,
                height,
                texels: Texels::Rgba8(texels),
                replaced: 0,
            }
        }
    })
}

fn decode_exr(bytes: &[u8]) -> Result<Decoded, String> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgba_channels(
            |size, _| (size.width(), vec![[0.0_f32; 4]; size.area()]),
            |(width, texels), at, (r, g, b, a): (f32, f32, f32, f32)| {
                texels[at.y() * *width + at.x()] = [r, g, b, a]
            },
        )
        .first_valid_layer()
        .all_attributes()
        .non_parallel()
        .from_buffered(Cursor::new(bytes))
        .map_err(unreadable)?;
    let size = image.layer_data.size;
    let (_, texels) = image.layer_data.channel_data.pixels;
    Ok(finite(size.width() as u32, size.height() as u32, texels))
}

fn finite(width: u32, height: u32, mut texels: Vec<[f32; 4]>) -> Decoded {
    let mut replaced = 0;
    for texel in &mut texels {
        let is_valid = |value: f32| value.is_finite() && value >= 0.0;
        if !texel.iter().all(|&value| is_valid(value)) {
            replaced += 1;
            *texel = texel.map(|value| if is_valid(value) { value } else { 0.0 });
        }
    }
    Decoded {
        width,
        height,
        texels: Texels::RgbaF32(texels),
        replaced,
    }
}
