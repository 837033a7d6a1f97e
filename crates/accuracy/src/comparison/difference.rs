//! Where images differ, pixel by pixel, for pictures.

use super::pair::Pair;
use crate::luminance::luminance;
use crate::relative_mse::RelativeScale;

/// (Yₜ − Yᵣ) / √(Yᵣ² + ε) of the luminances of each pixel, row by row; ε is a hundredth of the squared mean luminance of the
/// reference. Above 0 where the test is brighter.
pub fn relative_luminance_difference(pair: &Pair<'_>) -> Vec<f64> {
    let reference = || pair.reference().pixels().iter().map(|&rgb| luminance(rgb));
    let test = pair.test().pixels().iter().map(|&rgb| luminance(rgb));
    let scale = RelativeScale::of(reference());
    let relative =
        |(reference, test): (f64, f64)| (test - reference) / scale.square(reference).sqrt();
    reference().zip(test).map(relative).collect()
}

/// The mean over channels of |test − reference| of each pixel, row by row, in units of the images.
pub fn absolute_difference(pair: &Pair<'_>) -> Vec<f64> {
    let pixels = pair.reference().pixels().iter().zip(pair.test().pixels());
    let difference = |(reference, test): (&[f32; 3], &[f32; 3])| {
        let channels = [0, 1, 2].map(|k| (f64::from(test[k]) - f64::from(reference[k])).abs());
        channels.iter().sum::<f64>() / 3.0
    };
    pixels.map(difference).collect()
}

/// Up to which size values are told apart in a picture: so that 99 in 100 are, rounded up to 1, 2 or 5 times a power of ten,
/// which makes pictures of similar images comparable. 1 if all are 0.
pub fn shown_range(values: &[f64]) -> f64 {
    let mut sizes: Vec<f64> = values.iter().map(|value| value.abs()).collect();
    sizes.sort_unstable_by(f64::total_cmp);
    let percentile = sizes.get(sizes.len() * 99 / 100).copied();
    let size = percentile
        .filter(|size| *size > 0.0)
        .or(sizes.last().copied());
    let Some(size) = size.filter(|size| *size > 0.0) else {
        return 1.0;
    };
    let power = 10_f64.powf(size.log10().floor());
    // What is a round number up to rounding is that number.
    let steps = [1.0, 2.0, 5.0].into_iter().map(|step| step * power);
    steps
        .into_iter()
        .find(|step| size <= step * (1.0 + 1e-9))
        .unwrap_or(10.0 * power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::image::Image;

    #[test]
    fn differences_have_a_sign_and_a_scale() {
        let reference = [[1.0; 3], [3.0; 3]];
        let test = [[1.5, 1.5, 1.5], [2.0, 3.0, 3.5]];
        let pair = Pair::new(Image::new(&reference, 2), Image::new(&test, 2)).unwrap();
        let relative = relative_luminance_difference(&pair);
        assert!((relative[0] - 0.5 / 1.04_f64.sqrt()).abs() < 1e-12);
        let luminance = -0.2126 + 0.5 * 0.0722;
        assert!((relative[1] - luminance / 9.04_f64.sqrt()).abs() < 1e-12);
        assert_eq!(absolute_difference(&pair), [0.5, 0.5]);
    }

    #[test]
    fn ranges_are_round_numbers() {
        assert_eq!(shown_range(&[]), 1.0);
        assert_eq!(shown_range(&[0.0, 0.0]), 1.0);
        assert_eq!(shown_range(&[0.3, -0.5]), 0.5);
        assert_eq!(shown_range(&[-0.011]), 0.02);
        assert!((shown_range(&[0.0, 600.0]) - 1000.0).abs() < 1e-9);
        let mut values = vec![0.15; 1000];
        values[..9].fill(1e6);
        assert_eq!(shown_range(&values), 0.2);
        let mut lone = vec![0.0; 1000];
        lone[3] = -4.0;
        assert_eq!(shown_range(&lone), 5.0);
    }
}
