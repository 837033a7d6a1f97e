//! The relative mean squared error of an image.

/// What squared errors are relative to: reference² + ε, where ε is a hundredth of the squared mean of the reference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RelativeScale {
    epsilon: f64,
}

impl RelativeScale {
    /// The scale of all values of a reference.
    pub(crate) fn of(reference: impl Iterator<Item = f64>) -> Self {
        let (mut sum, mut count) = (0.0, 0_usize);
        for value in reference {
            sum += value;
            count += 1;
        }
        let mean = sum / count.max(1) as f64;
        Self {
            epsilon: 1e-2 * mean * mean,
        }
    }

    /// The square that a squared error at this value of the reference is divided by; 1 where that would be 0, in a black
    /// reference.
    pub(crate) fn square(self, reference: f64) -> f64 {
        let square = reference * reference + self.epsilon;
        if square > 0.0 { square } else { 1.0 }
    }
}

/// Relative mean squared error: the mean over pixels and channels of (test − reference)² / (reference² + ε), where ε is a
/// hundredth of the squared mean of the reference, as in the `Film::error` of renders.
///
/// # Panics
/// If the images differ in size.
pub fn relative_mse(reference: &[[f32; 3]], test: &[[f32; 3]]) -> f64 {
    assert_eq!(reference.len(), test.len());
    let count = (3 * reference.len()).max(1) as f64;
    let values = || reference.as_flattened().iter().map(|&c| f64::from(c));
    let scale = RelativeScale::of(values());
    let tested = test.as_flattened().iter().map(|&c| f64::from(c));
    let relative =
        |(reference, test): (f64, f64)| (test - reference).powi(2) / scale.square(reference);
    values().zip(tested).map(relative).sum::<f64>() / count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_relative() {
        let (reference, test) = ([[1.0; 3]; 4], [[1.1; 3]; 4]);
        let expected = 0.1_f64.powi(2) / 1.01;
        assert!((relative_mse(&reference, &test) - expected).abs() < 1e-7);
        assert_eq!(relative_mse(&reference, &reference), 0.0);
        assert_eq!(relative_mse(&[[0.0; 3]], &[[0.0; 3]]), 0.0);
    }
}
