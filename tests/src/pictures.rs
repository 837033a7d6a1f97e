//! Comparing pictures, and reading those of others.

use std::path::Path;

use exr::prelude::*;

/// Where and how two pictures first differ in bits; `None` if they are the same.
#[must_use]
pub fn first_difference(a: &[[f32; 3]], b: &[[f32; 3]]) -> Option<String> {
    if a.len() != b.len() {
        return Some(format!("{} and {} pixels", a.len(), b.len()));
    }
    let bits = |rgb: &[f32; 3]| rgb.map(f32::to_bits);
    let differs = |at: &usize| bits(&a[*at]) != bits(&b[*at]);
    let first = (0..a.len()).find(differs)?;
    let count = (0..a.len()).filter(differs).count();
    Some(format!(
        "{count} of {} pixels, first number {first}: {:?} and {:?}",
        a.len(),
        a[first],
        b[first]
    ))
}

/// Mean of each channel.
pub fn mean(pixels: &[[f32; 3]]) -> [f64; 3] {
    let sum = pixels.iter().fold([0.0; 3], |sum: [f64; 3], rgb| {
        [0, 1, 2].map(|k| sum[k] + f64::from(rgb[k]))
    });
    sum.map(|c| c / pixels.len() as f64)
}

/// Channel by channel, one mean over another.
pub fn ratios(ours: [f64; 3], theirs: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| ours[k] / theirs[k])
}

/// Whether every ratio is within a tolerance of 1.
#[must_use]
pub fn within(ratios: [f64; 3], tolerance: f64) -> bool {
    ratios.iter().all(|ratio| (ratio - 1.0).abs() <= tolerance)
}

/// The pixels of an EXR image, row by row, with its width.
///
/// # Errors
/// If it cannot be read.
pub fn read_exr(path: &Path) -> exr::error::Result<(usize, Vec<[f32; 3]>)> {
    let image = read_first_rgba_layer_from_file(
        path,
        |size, _| (size.width(), vec![[0.0; 3]; size.area()]),
        |(width, pixels): &mut (usize, Vec<[f32; 3]>), at, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[at.y() * *width + at.x()] = [r, g, b];
        },
    )?;
    Ok(image.layer_data.channel_data.pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The comparisons fail where they should.
    #[test]
    fn perturbed_pictures_differ() {
        let picture = vec![[0.25, 0.5, 0.75]; 12];
        assert_eq!(first_difference(&picture, &picture), None);
        for (pixel, channel) in [(0, 0), (7, 2), (11, 1)] {
            let mut other = picture.clone();
            other[pixel][channel] = other[pixel][channel].next_up();
            assert!(
                first_difference(&picture, &other)
                    .unwrap()
                    .starts_with("1 of 12 pixels")
            );
        }
        assert!(first_difference(&[[0.0; 3]], &[[-0.0, 0.0, 0.0]]).is_some());
        assert!(first_difference(&picture, &picture[1..]).is_some());
    }

    #[test]
    fn a_wrong_channel_is_out_of_tolerance() {
        let theirs = mean(&[[1.0, 2.0, 3.0], [3.0, 2.0, 1.0]]);
        assert_eq!(theirs, [2.0; 3]);
        assert!(within(ratios([2.01, 1.99, 2.0], theirs), 0.006));
        for channel in 0..3 {
            let mut ours = theirs;
            ours[channel] *= 1.02;
            assert!(!within(ratios(ours, theirs), 0.015));
            ours[channel] = f64::NAN;
            assert!(!within(ratios(ours, theirs), 0.015));
        }
    }
}
