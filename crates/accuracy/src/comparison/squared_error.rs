//! Squared errors, and what noise adds to them.

use super::pair::Pair;
use crate::relative_mse::{RelativeScale, relative_mse};

/// A mean of squared differences, with its parts that are noise where standard errors say how much that is.
///
/// If the errors of two images are independent, the expectation of their squared difference is the squared difference of what
/// they converge to, and the variance of either. So noise can be subtracted. The result is free of bias and may be negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SquaredError {
    /// What is measured: with the noise of both images.
    pub measured: f64,
    /// What the reference's noise adds to it in expectation, where it is known.
    pub reference_noise: Option<f64>,
    /// What the test's noise adds to it in expectation, where it is known.
    pub test_noise: Option<f64>,
}

impl SquaredError {
    /// Mean squared error, in squared units of the image.
    pub fn mse(pair: &Pair<'_>) -> Self {
        let mean = |terms: &mut dyn Iterator<Item = f64>| terms.sum::<f64>() / pair.count() as f64;
        Self {
            measured: mean(&mut pair.values().map(|(r, t)| (t - r).powi(2))),
            reference_noise: pair.reference().variances().map(|mut all| mean(&mut all)),
            test_noise: pair.test().variances().map(|mut all| mean(&mut all)),
        }
    }

    /// Relative mean squared error, as [`relative_mse`] has it.
    ///
    /// What is noise is to first order: that the reference is noisy where it divides, too, is not corrected. That matters
    /// where its standard error is not small against √(reference² + ε).
    pub fn relmse(pair: &Pair<'_>) -> Self {
        let reference = pair.reference().values();
        let scale = RelativeScale::of(reference.clone());
        let mean = |variances: &mut dyn Iterator<Item = f64>| {
            let relative = variances
                .zip(reference.clone())
                .map(|(variance, reference)| variance / scale.square(reference));
            relative.sum::<f64>() / pair.count() as f64
        };
        Self {
            measured: relative_mse(pair.reference().pixels(), pair.test().pixels()),
            reference_noise: pair.reference().variances().map(|mut all| mean(&mut all)),
            test_noise: pair.test().variances().map(|mut all| mean(&mut all)),
        }
    }

    /// The error of the test against what the reference converges to, if the reference's noise is known.
    pub fn without_reference_noise(&self) -> Option<f64> {
        Some(self.measured - self.reference_noise?)
    }

    /// The squared difference of what both converge to (squared bias), if the noise of both is known.
    pub fn without_noise(&self) -> Option<f64> {
        Some(self.without_reference_noise()? - self.test_noise?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::image::Image;

    #[test]
    fn squared_errors_have_closed_forms() {
        let reference = [[1.0, 2.0, 3.0], [0.0, 2.0, 4.0]];
        let test = [[1.5, 2.0, 3.0], [0.0, 2.0, 2.0]];
        let (reference, test) = (Image::new(&reference, 2), Image::new(&test, 2));
        let pair = Pair::new(reference, test).unwrap();
        let mse = SquaredError::mse(&pair);
        assert_eq!(mse.measured, (0.25 + 4.0) / 6.0);
        assert_eq!((mse.reference_noise, mse.without_noise()), (None, None));
        // The mean is 2.
        let expected = (0.25 / 1.04 + 4.0 / 16.04) / 6.0;
        assert!((SquaredError::relmse(&pair).measured - expected).abs() < 1e-15);
        let errors = ([[0.1; 3]; 2], [[0.2, 0.0, 0.0]; 2]);
        let noisy = Pair::new(
            reference.with_standard_errors(&errors.0),
            test.with_standard_errors(&errors.1),
        );
        let mse = SquaredError::mse(&noisy.unwrap());
        let close = |a: Option<f64>, b: f64| (a.unwrap() - b).abs() < 1e-8;
        assert!(close(mse.reference_noise, 0.01) && close(mse.test_noise, 0.04 / 3.0));
        let relmse = SquaredError::relmse(&noisy.unwrap());
        let scales = [1.04, 4.04, 9.04, 0.04, 4.04, 16.04];
        let noise: f64 = scales.iter().map(|scale| 0.01 / scale / 6.0).sum();
        assert!(close(relmse.reference_noise, noise));
        assert!(close(
            relmse.test_noise,
            0.04 / 6.0 * (1.0 / 1.04 + 1.0 / 0.04)
        ));
        assert_eq!(
            relmse.without_reference_noise().unwrap() - relmse.test_noise.unwrap(),
            relmse.without_noise().unwrap()
        );
    }

    /// Of noisy images of one truth nothing is left, of a test that is off by a tenth its square.
    #[test]
    fn without_noise_the_bias_is_left() {
        let mut state = 1_u64;
        let mut noise = || {
            // Twelve uniform numbers make a nearly normal one of variance 1.
            (0..12).fold(-6.0, |sum, _| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1);
                sum + (state >> 40) as f32 / (1 << 24) as f32
            })
        };
        let mut image = |mean: f32, deviation: f32| -> Vec<[f32; 3]> {
            (0..40_000)
                .map(|_| [0; 3].map(|_| mean + deviation * noise()))
                .collect()
        };
        let (reference, test, biased) = (image(1.0, 0.1), image(1.0, 0.3), image(1.1, 0.3));
        let (little, much) = (vec![[0.1; 3]; 40_000], vec![[0.3; 3]; 40_000]);
        let reference = Image::new(&reference, 200).with_standard_errors(&little);
        for (test, bias) in [(&test, 0.0_f64), (&biased, 0.1)] {
            let test = Image::new(test, 200).with_standard_errors(&much);
            let mse = SquaredError::mse(&Pair::new(reference, test).unwrap());
            // Four standard deviations: a squared normal number of variance 0.1 has one of √2·0.1, and there are 120,000.
            let tolerance =
                4.0 * f64::sqrt(2.0 * 0.01 + 4.0 * 0.1 * bias * bias) / 120_000_f64.sqrt();
            let of_truth = mse.without_reference_noise().unwrap();
            assert!(
                (of_truth - 0.09 - bias * bias).abs() < tolerance,
                "{of_truth}"
            );
            let left = mse.without_noise().unwrap();
            assert!((left - bias * bias).abs() < tolerance, "{left}");
        }
    }
}
