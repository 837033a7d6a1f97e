//! Image files to compare: EXR and Radiance HDR as they are, PNG and other 8- or 16-bit files decoded from sRGB.

use std::fs;
use std::io::Cursor;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use exr::prelude::{AnyChannels, FlatSamples, ReadChannels, ReadLayers};
use image::{DynamicImage, ImageReader};
use residual_render::texture::srgb_decoded;

/// The largest image that is read: what a comparison keeps of so many pixels still fits a workstation's memory.
const MOST_PIXELS: u64 = 1 << 27;

/// Before the channels of the standard errors of pixels in an EXR.
const STANDARD_ERROR: &str = "standard_error.";

/// What the numbers in a file are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Radiance, without an upper bound.
    Linear,
    /// Encoded for a screen (sRGB): what was brighter than white is white, and the rest is rounded.
    Srgb,
}

/// An image that was read.
#[derive(Clone, Debug)]
pub struct ReadImage {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Linear red, green and blue, row by row. An image of luminance has it in each.
    pub pixels: Vec<[f32; 3]>,
    /// Standard errors of the pixels, from the channels `standard_error.R`, `.G` and `.B` of an EXR.
    pub standard_errors: Option<Vec<[f32; 3]>>,
    /// What was in the file.
    pub encoding: Encoding,
    /// What an EXR says of itself.
    pub comment: Option<String>,
}

/// Reads an image; alpha is ignored.
///
/// # Errors
/// If the file cannot be read, is no image of a known format, or is too large. The message names the file.
pub fn read(path: &Path) -> Result<ReadImage> {
    let bytes = fs::read(path).with_context(|| format!("{}: cannot be read", path.display()))?;
    let decode = || match bytes.starts_with(&[0x76, 0x2f, 0x31, 0x01]) {
        true => read_exr(&bytes),
        false => read_other(&bytes, path),
    };
    // Decoders have had index panics on hostile input; what they held is dropped with the closure.
    let read = catch_unwind(AssertUnwindSafe(decode));
    read.unwrap_or_else(|_| Err(anyhow!("the decoder gave up on malformed data")))
        .with_context(|| format!("{}: cannot be read", path.display()))
}

fn check_size(width: u64, height: u64) -> Result<()> {
    let fits = width.checked_mul(height).is_some_and(|n| n <= MOST_PIXELS);
    ensure!(
        fits,
        "has {width} × {height} pixels; at most {MOST_PIXELS} are read"
    );
    Ok(())
}

fn read_other(bytes: &[u8], path: &Path) -> Result<ReadImage> {
    let open = || -> Result<_> {
        let mut reader = ImageReader::new(Cursor::new(bytes));
        if let Ok(format) = image::ImageFormat::from_path(path) {
            reader.set_format(format);
        }
        Ok(reader.with_guessed_format()?)
    };
    ensure!(
        open()?.format().is_some(),
        "is no image of a known format (.exr, .png, .hdr)"
    );
    let (width, height) = open()?.into_dimensions()?;
    check_size(width.into(), height.into())?;
    let mut reader = open()?;
    reader.no_limits();
    let image = reader.decode()?;
    let (pixels, encoding) = match image {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let pixels = image.into_rgb32f().into_raw().as_chunks().0.to_vec();
            (pixels, Encoding::Linear)
        }
        // Codes of 8 bits are so many 257ths of those of 16.
        _ => {
            let codes = image.into_rgb16().into_raw();
            let decoded = |code: u16| srgb_decoded(f64::from(code) / 65535.0) as f32;
            let codes = codes.as_chunks().0.iter();
            (codes.map(|rgb| rgb.map(decoded)).collect(), Encoding::Srgb)
        }
    };
    Ok(ReadImage {
        size: [width as usize, height as usize],
        pixels,
        standard_errors: None,
        encoding,
        comment: None,
    })
}

fn read_exr(bytes: &[u8]) -> Result<ReadImage> {
    let meta = exr::meta::MetaData::read_from_buffered(Cursor::new(bytes), false)?;
    let size = meta.headers.first().context("has no layers")?.layer_size;
    check_size(size.width() as u64, size.height() as u64)?;
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_buffered(Cursor::new(bytes))?;
    let size = [
        image.layer_data.size.width(),
        image.layer_data.size.height(),
    ];
    let channels = &image.layer_data.channel_data;
    let has = |name: &str| channel(channels, name).is_some();
    let names = match (has("R"), has("Y")) {
        (false, true) => ["Y"; 3],
        _ => ["R", "G", "B"],
    };
    let standard_errors = match names
        .iter()
        .any(|name| has(&format!("{STANDARD_ERROR}{name}")))
    {
        true => Some(three(
            channels,
            size,
            names.map(|name| format!("{STANDARD_ERROR}{name}")),
        )?),
        false => None,
    };
    Ok(ReadImage {
        size,
        pixels: three(channels, size, names.map(str::to_owned))?,
        standard_errors,
        encoding: Encoding::Linear,
        comment: image
            .layer_data
            .attributes
            .comments
            .map(|text| text.to_string()),
    })
}

fn channel<'a>(channels: &'a AnyChannels<FlatSamples>, name: &str) -> Option<&'a FlatSamples> {
    let found = channels.list.iter().find(|channel| channel.name == *name);
    found.map(|channel| &channel.sample_data)
}

/// Three channels, pixel by pixel.
fn three(
    channels: &AnyChannels<FlatSamples>,
    [width, height]: [usize; 2],
    names: [String; 3],
) -> Result<Vec<[f32; 3]>> {
    let mut pixels = vec![[0.0; 3]; width * height];
    for (k, name) in names.iter().enumerate() {
        let Some(samples) = channel(channels, name) else {
            let there: Vec<_> = channels.list.iter().map(|c| c.name.to_string()).collect();
            bail!(
                "has no channel {name:?}; its channels are {}",
                there.join(", ")
            );
        };
        ensure!(
            samples.len() == pixels.len(),
            "the channel {name:?} is of a lower resolution"
        );
        for (pixel, value) in pixels.iter_mut().zip(samples.values_as_f32()) {
            pixel[k] = value;
        }
    }
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use exr::prelude::*;

    fn exr(path: &Path, channels: &[(&str, [f32; 2])]) {
        let channels = channels
            .iter()
            .map(|(name, values)| AnyChannel::new(*name, FlatSamples::F32(values.to_vec())));
        let channels = AnyChannels::sort(channels.collect());
        let image = Image::from_channels((2, 1), channels);
        image.write().to_file(path).unwrap();
    }

    fn message(path: &Path) -> String {
        format!("{:#}", super::read(path).unwrap_err())
    }

    #[test]
    fn channels_of_an_exr_are_read_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let radiance = [("R", [1.0, 4.0]), ("G", [2.0, 5.0]), ("B", [-3.0, 6e6])];
        exr(&path, &radiance);
        let image = super::read(&path).unwrap();
        assert_eq!(image.size, [2, 1]);
        assert_eq!(image.pixels, [[1.0, 2.0, -3.0], [4.0, 5.0, 6e6]]);
        assert_eq!(
            (image.encoding, image.standard_errors),
            (super::Encoding::Linear, None)
        );
        let errors = [
            ("standard_error.R", [0.1, 0.4]),
            ("standard_error.G", [0.2, 0.5]),
            ("standard_error.B", [0.3, 0.6]),
        ];
        exr(&path, &[radiance, errors].concat());
        let errors_read = super::read(&path).unwrap().standard_errors.unwrap();
        assert_eq!(errors_read, [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]);
        exr(&path, &[&radiance[..], &errors[..2]].concat());
        assert!(
            message(&path).contains("standard_error.B"),
            "{}",
            message(&path)
        );
        exr(
            &path,
            &[("Y", [0.5, 0.25]), ("standard_error.Y", [0.0, 0.1])],
        );
        let grey = super::read(&path).unwrap();
        assert_eq!(grey.pixels, [[0.5; 3], [0.25; 3]]);
        assert_eq!(grey.standard_errors.unwrap(), [[0.0; 3], [0.1; 3]]);
        exr(&path, &[("depth.Z", [0.5, 0.25])]);
        assert!(message(&path).contains("depth.Z"), "{}", message(&path));
    }

    #[test]
    fn codes_are_decoded() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let codes = vec![0, 10, 11, 128, 254, 255];
        let image = image::RgbImage::from_raw(2, 1, codes.clone()).unwrap();
        image.save(&path).unwrap();
        let image = super::read(&path).unwrap();
        assert_eq!(image.encoding, super::Encoding::Srgb);
        let table = residual_render::texture::srgb_table();
        let expected: Vec<_> = codes.iter().map(|&code| table[usize::from(code)]).collect();
        assert_eq!(image.pixels.as_flattened(), expected);
    }

    #[test]
    fn what_is_no_image_is_refused_by_name() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        assert!(message(&file("missing.exr")).contains("missing.exr"));
        fs::write(file("text"), "not an image").unwrap();
        assert!(message(&file("text")).contains("known format"));
        fs::write(file("text.png"), "not an image").unwrap();
        assert!(message(&file("text.png")).contains("text.png"));
        exr(
            &file("good.exr"),
            &[("R", [1.0; 2]), ("G", [1.0; 2]), ("B", [1.0; 2])],
        );
        let bytes = fs::read(file("good.exr")).unwrap();
        for length in 0..bytes.len() {
            fs::write(file("cut.exr"), &bytes[..length]).unwrap();
            assert!(message(&file("cut.exr")).contains("cut.exr"));
        }
    }
}
