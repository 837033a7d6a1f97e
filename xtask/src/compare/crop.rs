//! A rectangle of the images.

use std::str::FromStr;

use anyhow::{Result, ensure};
use residual_frontend::input::ReadImage;

/// A rectangle of pixels: left column, upper row, width, height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Crop([usize; 4]);

impl FromStr for Crop {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<usize>> = text
            .split(',')
            .map(|part| part.trim().parse().ok())
            .collect();
        let crop = numbers.and_then(|numbers| <[usize; 4]>::try_from(numbers).ok());
        match crop {
            Some(crop) if crop[2] > 0 && crop[3] > 0 => Ok(Self(crop)),
            _ => Err(
                "expected left column, upper row, width and height, as in 64,0,32,32".to_owned(),
            ),
        }
    }
}

impl Crop {
    /// The rectangle of an image.
    ///
    /// # Errors
    /// If it is not inside.
    pub(super) fn of(self, image: ReadImage) -> Result<ReadImage> {
        let Self([x, y, width, height]) = self;
        let [whole_width, whole_height] = image.size;
        let ends_within = |start: usize, size: usize, whole: usize| {
            start.checked_add(size).is_some_and(|end| end <= whole)
        };
        ensure!(
            ends_within(x, width, whole_width) && ends_within(y, height, whole_height),
            "--crop {x},{y},{width},{height} is not inside of {whole_width} × {whole_height} pixels"
        );
        let rows = |pixels: &[[f32; 3]]| -> Vec<[f32; 3]> {
            let rows = pixels.chunks(whole_width).skip(y).take(height);
            rows.flat_map(|row| &row[x..x + width]).copied().collect()
        };
        Ok(ReadImage {
            size: [width, height],
            pixels: rows(&image.pixels),
            standard_errors: image.standard_errors.as_deref().map(rows),
            encoding: image.encoding,
            comment: image.comment.clone(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use residual_frontend::input::Encoding;

    #[test]
    fn crops_parse() {
        assert_eq!("1, 2,3,4".parse(), Ok(Crop([1, 2, 3, 4])));
        for text in ["", "1,2,3", "1,2,3,4,5", "1,2,0,4", "1,2,3,0", "-1,2,3,4"] {
            assert!(text.parse::<Crop>().is_err(), "{text}");
        }
    }

    #[test]
    fn a_crop_has_the_rows_and_columns_asked_for() {
        let image = || ReadImage {
            size: [4, 3],
            pixels: (0..12).map(|k| [k as f32; 3]).collect(),
            standard_errors: Some((0..12).map(|k| [-(k as f32); 3]).collect()),
            encoding: Encoding::Linear,
            comment: None,
        };
        let cropped = Crop([1, 1, 2, 2]).of(image()).unwrap();
        assert_eq!(cropped.size, [2, 2]);
        assert_eq!(cropped.pixels, [5.0, 6.0, 9.0, 10.0].map(|k| [k; 3]));
        assert_eq!(cropped.standard_errors.unwrap()[3], [-10.0; 3]);
        for outside in [[3, 0, 2, 1], [0, 2, 1, 2], [usize::MAX, 0, 2, 1]] {
            assert!(Crop(outside).of(image()).is_err(), "{outside:?}");
        }
    }
}
