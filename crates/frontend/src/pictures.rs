//! Pictures of numbers: a PNG has their colours, an EXR the numbers themselves.

use std::io::Cursor;
use std::path::Path;

use anyhow::Result;
use exr::prelude::*;

use crate::output::{Format, encode_png, write_atomically};

/// Numbers of each pixel, and their colours.
pub struct Picture {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// 8-bit sRGB, row by row.
    pub colors: Vec<[u8; 3]>,
    /// Channels of an EXR, each with one number for each pixel.
    pub channels: Vec<(&'static str, Vec<f32>)>,
    /// What an EXR says of itself.
    pub comment: Option<String>,
}

/// Writes a picture, whole or not at all.
///
/// # Errors
/// If the file cannot be written, or is of neither format.
pub fn write(path: &Path, picture: &Picture) -> Result<()> {
    let bytes = match Format::of(path)? {
        Format::Png => encode_png(picture.size, picture.colors.as_flattened().to_vec())?,
        Format::Exr => encode_exr(picture)?,
    };
    write_atomically(path, &bytes)
}

fn encode_exr(picture: &Picture) -> Result<Vec<u8>> {
    let channels = picture
        .channels
        .iter()
        .map(|(name, values)| AnyChannel::new(*name, FlatSamples::F32(values.clone())));
    let channels = AnyChannels::sort(channels.collect());
    let mut attributes = LayerAttributes::named("");
    attributes.comments = picture.comment.as_deref().and_then(Text::new_or_none);
    let size = (picture.size[0], picture.size[1]);
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
    let mut bytes = Cursor::new(Vec::new());
    Image::from_layer(layer).write().to_buffered(&mut bytes)?;
    Ok(bytes.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_png_has_the_colours_and_an_exr_the_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let picture = Picture {
            size: [2, 1],
            colors: vec![[1, 2, 3], [4, 5, 6]],
            channels: vec![("Y", vec![-0.5, f32::INFINITY])],
            comment: Some("of a test".to_owned()),
        };
        let [png, exr] = ["a.png", "a.EXR"].map(|name| folder.path().join(name));
        write(&png, &picture).unwrap();
        let read = image::open(&png).unwrap().to_rgb8();
        assert_eq!(read.dimensions(), (2, 1));
        assert_eq!(read.into_raw(), [1, 2, 3, 4, 5, 6]);
        write(&exr, &picture).unwrap();
        let read = read_first_flat_layer_from_file(&exr).unwrap();
        let channel = &read.layer_data.channel_data.list[0];
        let values: Vec<_> = channel.sample_data.values_as_f32().collect();
        assert_eq!(
            (channel.name.to_string(), values),
            ("Y".to_owned(), vec![-0.5, f32::INFINITY])
        );
        assert_eq!(crate::input::read(&exr).unwrap().comment, picture.comment);
        assert!(write(&folder.path().join("a.jpg"), &picture).is_err());
    }
}
