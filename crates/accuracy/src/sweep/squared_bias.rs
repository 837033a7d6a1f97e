//! Bias, apart from noise, from images of independent seeds.

use crate::comparison::{MissingStandardError, Pair, Role};
use crate::jackknife::Jackknifed;
use crate::relative_mse::RelativeScale;

/// The relative squared bias of what several images of independent seeds converge to, beside a reference that is noisy itself:
/// the mean over pixels and channels of (E x − μ)² / (μ² + ε), with the scale of [`relative_mse`](crate::relative_mse()).
///
/// For two different images i and j, the expectation of (x_i − r)(x_j − r) is (E x − μ)² and the variance of r, whatever the noise of
/// the images. The variance is known, and is subtracted. So the result is without bias, negative half of the time where there is
/// nothing to be found, and certain to a small part of the error of a single image. Its interval knows the noise of the images (the
/// jackknife over them) and of the reference. It is to first order: the reference's noise where it divides is not corrected.
///
/// # Errors
/// If the reference comes without standard errors.
///
/// # Panics
/// If there are fewer than three pairs.
///
/// ```
/// use residual_accuracy::comparison::{Image, Pair};
/// use residual_accuracy::sweep::squared_bias;
///
/// // Images that are a tenth too bright, and noisy.
/// let reference = vec![[1.0; 3]; 64 * 64];
/// let errors = vec![[1e-6; 3]; 64 * 64];
/// let noisy = |seed: usize| -> Vec<[f32; 3]> {
///     (0..64 * 64).map(|k| [1.1 + 0.5 * (1e3 * (k * (2 * seed + 3)) as f32).sin(); 3]).collect()
/// };
/// let images: Vec<_> = (0..8).map(noisy).collect();
/// let reference = Image::new(&reference, 64).with_standard_errors(&errors);
/// let pairs: Vec<_> = images.iter().map(|image| Pair::new(reference, Image::new(image, 64)).unwrap()).collect();
/// let bias = squared_bias(&pairs)?;
/// assert!((bias.value - 0.01).abs() < 1e-3 && bias.ci95 < 5e-3);
/// # Ok::<(), residual_accuracy::comparison::MissingStandardError>(())
/// ```
pub fn squared_bias(pairs: &[Pair<'_>]) -> Result<Jackknifed, MissingStandardError> {
    assert!(pairs.len() >= 3, "an interval takes three images");
    let reference = pairs[0].reference();
    let variances = reference
        .variances()
        .ok_or(MissingStandardError(Role::Reference))?;
    let scale = RelativeScale::of(reference.values());
    let count = pairs[0].count() as f64;
    let weights: Vec<f64> = reference
        .values()
        .map(|value| 1.0 / (scale.square(value) * count))
        .collect();
    let images = pairs.len() as f64;
    let mut differences: Vec<_> = pairs
        .iter()
        .map(|pair| pair.values().map(|(r, x)| x - r))
        .collect();
    // What the reference's noise e adds to the product is e² − 2be, where b is the bias.
    let (mut noise, mut variance_of_square, mut variance_of_product) = (0.0, 0.0, 0.0);
    for (variance, weight) in variances.zip(&weights) {
        let (mut sum, mut squares) = (0.0, 0.0);
        for image in &mut differences {
            let difference = image.next().expect("images are of one size");
            sum += difference;
            squares += difference * difference;
        }
        let of_bias = (sum * sum - squares) / (images * (images - 1.0)) - variance;
        noise += weight * variance;
        // Of a squared normal number.
        variance_of_square += 2.0 * (weight * variance).powi(2);
        variance_of_product += 4.0 * weight * weight * variance * of_bias;
    }
    let of_reference = variance_of_square + variance_of_product.max(0.0);
    let product = |a: &Pair<'_>, b: &Pair<'_>| -> f64 {
        let both = a.values().zip(b.values()).zip(&weights);
        both.map(|(((r, x), (_, y)), weight)| weight * (x - r) * (y - r))
            .sum()
    };
    let products: Vec<Vec<f64>> = (0..pairs.len())
        .map(|i| (0..i).map(|j| product(&pairs[i], &pairs[j])).collect())
        .collect();
    let mut bias = Jackknifed::of(pairs.len(), |used| {
        let (mut sum, mut number) = (0.0, 0.0);
        for (_, row) in products.iter().enumerate().filter(|(i, _)| used(*i)) {
            for (_, product) in row.iter().enumerate().filter(|(j, _)| used(*j)) {
                sum += product;
                number += 1.0;
            }
        }
        sum / number - noise
    });
    bias.ci95 = bias.ci95.hypot(1.96 * of_reference.sqrt());
    Ok(bias)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::Image;

    /// Nearly normal noise of variance 1.
    fn noise(state: &mut u64) -> f32 {
        (0..12).fold(-6.0, |sum, _| {
            *state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
            sum + (*state >> 40) as f32 / (1 << 24) as f32
        })
    }

    /// In 100 experiments the interval holds the truth in all but a few, with bias and without.
    #[test]
    fn intervals_hold_the_truth() {
        const PIXELS: usize = 400;
        let mut state = 7;
        for bias in [0.0_f32, 0.005] {
            let mut held = 0;
            let mut sum = 0.0;
            for _ in 0..100 {
                let mut image = |mean: f32, deviation: f32| -> Vec<[f32; 3]> {
                    let value = |_: usize| [0; 3].map(|_| mean + deviation * noise(&mut state));
                    (0..PIXELS).map(value).collect()
                };
                let (reference, errors) = (image(1.0, 0.005), vec![[0.005; 3]; PIXELS]);
                let images: Vec<_> = (0..12).map(|_| image(1.0 + bias, 0.02)).collect();
                let reference = Image::new(&reference, 20).with_standard_errors(&errors);
                let pairs: Vec<_> = images
                    .iter()
                    .map(|image| Pair::new(reference, Image::new(image, 20)).unwrap())
                    .collect();
                let found = squared_bias(&pairs).unwrap();
                // Of a reference of 1.
                let truth = f64::from(bias).powi(2) / 1.01;
                held += usize::from((found.value - truth).abs() <= found.ci95);
                sum += found.value - truth;
            }
            assert!((86..=100).contains(&held), "bias {bias}: {held} of 100");
            // One is certain to 2·10⁻⁶, the mean of a hundred to a tenth of that.
            assert!(sum.abs() / 100.0 < 1e-6, "bias {bias}: {}", sum / 100.0);
        }
    }

    #[test]
    fn a_reference_without_noise_is_refused() {
        let image = vec![[1.0; 3]; 4];
        let pair = || Pair::new(Image::new(&image, 2), Image::new(&image, 2)).unwrap();
        assert!(squared_bias(&[pair(), pair(), pair()]).is_err());
    }
}
