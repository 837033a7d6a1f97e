//! Metrics that are means over pixels.

use super::pair::Pair;
use super::tile::{Tile, TileError};
use crate::luminance::luminance;
use crate::relative_mse::RelativeScale;

/// Mean absolute error, in units of the image.
pub(super) fn mean_absolute_error(pair: &Pair<'_>) -> f64 {
    let errors = pair
        .values()
        .map(|(reference, test)| (test - reference).abs());
    errors.sum::<f64>() / pair.count() as f64
}

/// Mean absolute percentage error as a part of 1: the mean of |test − reference| / √(reference² + ε). Its terms are the
/// roots of those of the relative mean squared error, so that its square is never above that.
pub(super) fn mean_absolute_percentage_error(pair: &Pair<'_>) -> f64 {
    let scale = RelativeScale::of(pair.reference().values());
    let relative = pair
        .values()
        .map(|(reference, test)| (test - reference).abs() / scale.square(reference).sqrt());
    relative.sum::<f64>() / pair.count() as f64
}

/// Symmetric mean absolute percentage error: the mean of 2·|test − reference| / (|test| + |reference|), 0 where both are 0;
/// from 0 to 2 (Makridakis 1993).
pub(super) fn symmetric_mean_absolute_percentage_error(pair: &Pair<'_>) -> f64 {
    let terms = pair.values().map(|(reference, test)| {
        let size = test.abs() + reference.abs();
        if size > 0.0 {
            2.0 * (test - reference).abs() / size
        } else {
            0.0
        }
    });
    terms.sum::<f64>() / pair.count() as f64
}

/// Relative mean squared error of luminance: one number a pixel, with ε of the reference's mean luminance. Errors of colour
/// that leave the luminance as it is are not seen.
pub(super) fn luminance_relmse(pair: &Pair<'_>) -> f64 {
    let reference = || pair.reference().pixels().iter().map(|&rgb| luminance(rgb));
    let test = pair.test().pixels().iter().map(|&rgb| luminance(rgb));
    let scale = RelativeScale::of(reference());
    let relative = reference()
        .zip(test)
        .map(|(reference, test)| (test - reference).powi(2) / scale.square(reference));
    relative.sum::<f64>() / pair.reference().pixels().len() as f64
}

/// The test's mean over the reference's, channel by channel; `None` where the latter is 0.
pub(super) fn mean_ratios(pair: &Pair<'_>) -> [Option<f64>; 3] {
    let sum = |pixels: &[[f32; 3]], channel: usize| -> f64 {
        pixels.iter().map(|rgb| f64::from(rgb[channel])).sum()
    };
    [0, 1, 2].map(|channel| {
        let reference = sum(pair.reference().pixels(), channel);
        (reference != 0.0).then(|| sum(pair.test().pixels(), channel) / reference)
    })
}

/// The relative squared error of each pixel, which is the mean over its channels; their mean is the relative mean squared
/// error.
#[derive(Clone, Debug, PartialEq)]
pub struct PixelErrors {
    values: Vec<f64>,
    width: usize,
}

/// A mean without the largest values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trimmed {
    /// The mean of what is left.
    pub mean: f64,
    /// How many pixels were left out.
    pub left_out: usize,
}

impl PixelErrors {
    /// The errors of a pair.
    pub fn of(pair: &Pair<'_>) -> Self {
        let scale = RelativeScale::of(pair.reference().values());
        let pixels = pair.reference().pixels().iter().zip(pair.test().pixels());
        let error = |(reference, test): (&[f32; 3], &[f32; 3])| {
            let channels = [0, 1, 2].map(|k| {
                let (reference, test) = (f64::from(reference[k]), f64::from(test[k]));
                (test - reference).powi(2) / scale.square(reference)
            });
            channels.iter().sum::<f64>() / 3.0
        };
        Self {
            values: pixels.map(error).collect(),
            width: pair.size()[0],
        }
    }

    /// The errors, row by row.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The mean without the worst pixels, `part` of all of them, rounded down.
    ///
    /// It says what the error is away from a few bright outliers, which for light transport are errors like any other. Never
    /// read it alone: an image with fireflies everywhere, or with its brightest light missing, may trim well.
    ///
    /// # Panics
    /// Unless `part` is from 0 to below 1.
    pub fn trimmed(&self, part: f64) -> Trimmed {
        assert!((0.0..1.0).contains(&part));
        let left_out = (part * self.values.len() as f64) as usize;
        let mut values = self.values.clone();
        let kept = values.len() - left_out;
        values.select_nth_unstable_by(kept - 1, f64::total_cmp);
        Trimmed {
            mean: values[..kept].iter().sum::<f64>() / kept as f64,
            left_out,
        }
    }

    /// The square tile of `side` pixels, cut off at the right and the lower border, whose mean error is the largest: the
    /// first of them, row by row.
    ///
    /// # Panics
    /// If `side` is 0.
    pub fn worst_tile(&self, side: usize) -> TileError {
        let size = [self.width, self.values.len() / self.width];
        let errors = Tile::all(size, side).map(|tile| {
            let sum: f64 = tile.indices(self.width).map(|k| self.values[k]).sum();
            TileError {
                tile,
                relmse: sum / tile.pixels() as f64,
            }
        });
        errors
            .reduce(|worst, next| {
                if next.relmse > worst.relmse {
                    next
                } else {
                    worst
                }
            })
            .expect("pairs have pixels")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::image::Image;
    use crate::comparison::squared_error::SquaredError;
    use crate::relative_mse::relative_mse;

    fn pair<'a>(reference: &'a [[f32; 3]], test: &'a [[f32; 3]], width: usize) -> Pair<'a> {
        Pair::new(Image::new(reference, width), Image::new(test, width)).unwrap()
    }

    /// Numbers in (0, 4), the same for the same seed.
    fn random(seed: u64, pixels: usize) -> Vec<[f32; 3]> {
        let mut state = seed;
        let mut next = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            ((state >> 40) as f32 + 0.5) / (1 << 22) as f32
        };
        (0..pixels).map(|_| [next(), next(), next()]).collect()
    }

    #[test]
    fn closed_forms() {
        let reference = [[1.0, 2.0, 3.0], [0.0, 2.0, 4.0]];
        let test = [[1.5, 2.0, 3.0], [0.0, 1.0, 2.0]];
        let pair = pair(&reference, &test, 2);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} {b}");
        close(mean_absolute_error(&pair), 3.5 / 6.0);
        // The mean is 2.
        let relative = 0.5 / 1.04_f64.sqrt() + 1.0 / 4.04_f64.sqrt() + 2.0 / 16.04_f64.sqrt();
        close(mean_absolute_percentage_error(&pair), relative / 6.0);
        let symmetric = 1.0 / 2.5 + 2.0 / 3.0 + 4.0 / 6.0;
        close(
            symmetric_mean_absolute_percentage_error(&pair),
            symmetric / 6.0,
        );
        let ratios = mean_ratios(&pair);
        assert_eq!(ratios, [Some(1.5), Some(0.75), Some(5.0 / 7.0)]);
        let [a, b] = [0, 1].map(|k| luminance(reference[k]));
        let [c, d] = [0, 1].map(|k| luminance(test[k]));
        let epsilon = 0.01 * (0.5 * (a + b)).powi(2);
        let expected = (c - a).powi(2) / (a * a + epsilon) + (d - b).powi(2) / (b * b + epsilon);
        close(luminance_relmse(&pair), 0.5 * expected);
        let errors = PixelErrors::of(&pair);
        close(errors.values()[0], 0.25 / 1.04 / 3.0);
        close(errors.values()[1], (1.0 / 4.04 + 4.0 / 16.04) / 3.0);
    }

    #[test]
    fn black_references_divide_by_nothing() {
        let (black, test) = ([[0.0; 3]; 2], [[0.0, 0.0, 2.0]; 2]);
        let dark = pair(&black, &test, 1);
        assert_eq!(mean_absolute_percentage_error(&dark), 2.0 / 3.0);
        assert_eq!(symmetric_mean_absolute_percentage_error(&dark), 2.0 / 3.0);
        assert_eq!(mean_ratios(&dark), [None; 3]);
        assert_eq!(
            symmetric_mean_absolute_percentage_error(&pair(&black, &black, 1)),
            0.0
        );
        assert_eq!(PixelErrors::of(&dark).values(), [4.0 / 3.0; 2]);
    }

    #[test]
    fn metrics_have_their_symmetries() {
        for seed in 0..20 {
            let (a, b) = (random(seed, 60), random(seed + 100, 60));
            let (forth, back) = (pair(&a, &b, 10), pair(&b, &a, 10));
            let same = |metric: fn(&Pair<'_>) -> f64| {
                assert!((metric(&forth) / metric(&back) - 1.0).abs() < 1e-12);
            };
            same(mean_absolute_error);
            same(symmetric_mean_absolute_percentage_error);
            same(|pair| SquaredError::mse(pair).measured);
            // Relative to the reference, they are not the same.
            let relmse = |pair| SquaredError::relmse(pair).measured;
            assert!((relmse(&forth) / relmse(&back) - 1.0).abs() > 1e-6);
            // By a power of two, which rounds nothing.
            let scaled = |image: &[[f32; 3]]| -> Vec<_> {
                image.iter().map(|rgb| rgb.map(|c| 8.0 * c)).collect()
            };
            let (c, d) = (scaled(&a), scaled(&b));
            let brighter = pair(&c, &d, 10);
            let ratio = |metric: fn(&Pair<'_>) -> f64| metric(&brighter) / metric(&forth);
            for metric in [
                mean_absolute_percentage_error,
                symmetric_mean_absolute_percentage_error,
                luminance_relmse,
                |pair: &Pair<'_>| SquaredError::relmse(pair).measured,
                |pair: &Pair<'_>| PixelErrors::of(pair).trimmed(0.1).mean,
            ] {
                assert!((ratio(metric) - 1.0).abs() < 1e-12);
            }
            assert!((ratio(mean_absolute_error) - 8.0).abs() < 1e-12);
            assert!((ratio(|pair| SquaredError::mse(pair).measured) - 64.0).abs() < 1e-12);
            // Jensen's inequality.
            assert!(mean_absolute_percentage_error(&forth).powi(2) <= relmse(&forth));
            let symmetric = symmetric_mean_absolute_percentage_error(&forth);
            assert!((0.0..=2.0).contains(&symmetric));
        }
    }

    #[test]
    fn pixels_and_tiles_make_up_the_mean() {
        let (a, b) = (random(3, 77 * 45), random(4, 77 * 45));
        let errors = PixelErrors::of(&pair(&a, &b, 77));
        let mean = errors.trimmed(0.0);
        assert_eq!(mean.left_out, 0);
        assert!((mean.mean / relative_mse(&a, &b) - 1.0).abs() < 1e-12);
        let whole = errors.worst_tile(100);
        assert!((whole.relmse / mean.mean - 1.0).abs() < 1e-12);
        let worst = errors.worst_tile(16);
        assert!(worst.relmse > mean.mean);
    }

    #[test]
    fn trimming_leaves_out_the_worst() {
        let reference = vec![[1.0; 3]; 2000];
        let mut test = vec![[1.1; 3]; 2000];
        test[7] = [1000.0; 3];
        test[1500] = [0.0, 90.0, 0.0];
        let errors = PixelErrors::of(&pair(&reference, &test, 50));
        let trimmed = errors.trimmed(0.001);
        assert_eq!(trimmed.left_out, 2);
        assert!((trimmed.mean - 0.01 / 1.01).abs() < 1e-8, "{trimmed:?}");
        assert!(errors.trimmed(0.0006).mean > 1.0);
        // Of so few pixels none is a thousandth.
        let few = PixelErrors::of(&pair(&reference[..100], &test[..100], 50));
        assert_eq!(few.trimmed(0.001).left_out, 0);
        let worst = errors.worst_tile(32);
        assert_eq!((worst.tile.x, worst.tile.y), (0, 0));
        // The right border has tiles of 18 pixels, the lower one of 8.
        test[7] = [1.0; 3];
        let errors = PixelErrors::of(&pair(&reference, &test, 50));
        let worst = errors.worst_tile(32).tile;
        assert_eq!(
            [worst.x, worst.y, worst.width, worst.height],
            [0, 0, 32, 32]
        );
        test[1500] = [1.0; 3];
        test[39 * 50 + 49] = [2.0; 3];
        let worst = PixelErrors::of(&pair(&reference, &test, 50)).worst_tile(32);
        let tile = worst.tile;
        assert_eq!([tile.x, tile.y, tile.width, tile.height], [32, 32, 18, 8]);
        let expected = (143.0 * 0.01 + 1.0) / 144.0 / 1.01;
        assert!((worst.relmse - expected).abs() < 1e-7);
    }
}
