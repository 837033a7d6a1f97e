//! How far an image is from its limit, from its own samples.
//!
//! What is estimated is the relative mean squared error that [`relative_mse`](crate::relative_mse()) would find beside the
//! true image: the mean over pixels of (x − μ)² / (μ² + ε), where x is a pixel's mean of N samples, μ the true one, and ε a
//! hundredth of the squared mean of the image. Three things stand in the way.
//!
//! *The variance of well-distributed points cannot be seen from inside.* The samples' own variance over N, which would be
//! the squared error of independent samples, overstates that of Sobol points; by how much depends on the scene. So some
//! pixels are sampled a second time, with points that know nothing of the first: half of the squared difference of both
//! means has the expectation of the squared error, whatever the points. What it says less than the samples' own variance,
//! on average over these [`Replicate`]s, is taken off the sum over all pixels: the difference estimator of two-phase
//! sampling (Neyman 1938; Cochran, *Sampling Techniques*, 12.9). It is exact on average, and no single bright sample
//! disturbs it, since the two contain the same one.
//!
//! *The denominator is noisy.* A pixel's mean is drawn to its neighbours' as far as they differ by noise alone
//! (`smoothed.rs`). What noise is left rises together with the error, and the quotient falls short by a part that shrinks as
//! 1/N. The same statistic of the even and of the odd samples falls short by twice that part: twice the one less the other
//! is rid of it (the jackknife of halves; Quenouille 1949). And no pixel counts as far brighter than its neighbours
//! (`plausible.rs`).
//!
//! *The interval is of the error of this image.* Where ε_i is the error of sample i of N independent ones, (x − μ)² differs from
//! the samples' variance over N by Σ ε_i ε_j / N(N−1) over all i ≠ j, whose variance is 2 σ⁴ / N(N−1) for samples
//! of any distribution: the squares, and with them the bright samples, cancel. The product of the two halves' variances
//! estimates σ⁴ without bias.

use crate::contributions::{Contributions, Twice};
use crate::distrust::Distrust;
use crate::moments::{CHANNELS, Y};
use crate::sampled::{Replicate, Sampled};

/// Fewest samples of a pixel that say something of its error: two in each half.
pub const FEWEST_SAMPLES: u64 = 4;

/// A number with the interval that holds the truth with 95 % confidence.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// The estimate.
    pub value: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// An estimate of the relative mean squared error of an image, by which it differs from the true one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Of red, green and blue together: their mean.
    pub relmse: Interval,
    /// Of red, green and blue, with the same ε.
    pub channels: [Interval; 3],
    /// Of luminance, whose ε is from the mean luminance.
    pub luminance: Interval,
    /// Variance of these points ÷ variance of independent ones (Kish's design effect), over red, green and blue.
    pub design_effect: f64,
    /// Why the interval should not be relied on, if it should not.
    pub distrust: Option<Distrust>,
}

/// Below this many pixels that carry the error in effect, it has heavy tails.
const FEWEST_CARRIERS: f64 = 600.0;
/// Above this part of the estimate, the correction for noisy means is too large to trust what is left.
const LARGEST_CORRECTION: f64 = 0.07;
/// Above this error, pixels are so noisy that what the correction leaves is large, too: 7 to 10 % of the error in rooms at 16
/// samples per pixel.
const LARGEST_NOISE: f64 = 0.02;
/// Fewest replicates from which a standard error can be had.
const FEWEST_REPLICATES: usize = 16;
/// Above this standard error, relative to the estimate, its distribution is not known well enough for an interval.
const LARGEST_ERROR: f64 = 0.35;

/// The estimate, from its parts.
#[derive(Clone, Copy, Debug)]
struct Sums {
    /// The estimate, and the variance that it has from the choice of replicates.
    value: f64,
    variance: f64,
    /// With the pixels' own variances and means.
    plain: f64,
    /// Without the bias of noisy means.
    jackknifed: f64,
    /// Variance of the difference to the image's own error, for independent samples.
    products: f64,
    /// Sum of squares of the pixels' contributions.
    squares: f64,
}

impl ErrorEstimate {
    /// The error of an image of `width` pixels a row. Without replicates, samples are taken to be independent.
    ///
    /// `None` if a pixel has less than [`FEWEST_SAMPLES`], or there are no pixels.
    ///
    /// # Panics
    /// If pixels do not fill rows, or a replicate is of none of them.
    pub fn of(
        width: usize,
        pixels: &[Sampled<'_>],
        replicates: Option<&[Replicate<'_>]>,
    ) -> Option<Self> {
        if pixels.is_empty() || pixels.iter().any(|pixel| pixel.samples < FEWEST_SAMPLES) {
            return None;
        }
        assert_eq!(pixels.len() % width, 0, "whole rows");
        let replicated = replicates.unwrap_or(&[]);
        let contributions = Contributions::of(width, pixels, replicated);
        let colors = Sums::of(&contributions, [0, 1, 2]);
        let [red, green, blue, luminance] =
            [0, 1, 2, Y].map(|channel| Sums::of(&contributions, [channel]));
        let used = replicated.len();
        Some(Self {
            relmse: colors.interval(used),
            channels: [red, green, blue].map(|sums| sums.interval(used)),
            luminance: luminance.interval(used),
            design_effect: colors.design_effect(),
            distrust: colors.distrust(replicates.map(<[_]>::len)),
        })
    }
}

impl Sums {
    /// The mean of channels.
    fn of<const N: usize>(contributions: &Contributions, channels: [usize; N]) -> Self {
        let one_over = 1.0 / N as f64;
        let mean =
            |of: &dyn Fn(usize) -> f64| channels.iter().map(|&k| of(k)).sum::<f64>() * one_over;
        let plain = mean(&|k| contributions.plain[k]);
        let jackknifed = mean(&|k| contributions.jackknifed[k]);
        // Paths shade all channels: their errors are taken to rise and fall as one.
        let products = mean(&|k| contributions.products[k].sqrt()).powi(2);
        let of_pixels = || {
            let of_pixel = |c: &[f32; CHANNELS]| {
                channels.iter().map(|&k| f64::from(c[k])).sum::<f64>() * one_over
            };
            contributions.of_pixels.iter().map(of_pixel)
        };
        let replicates: Vec<[f64; 2]> = contributions
            .of_replicates
            .iter()
            .map(|Twice { between, within }| [mean(&|k| between[k]), mean(&|k| within[k])])
            .collect();
        let pixels = contributions.of_pixels.len() as f64;
        let squares = of_pixels().map(|c| c * c).sum::<f64>() / pixels / pixels;
        if replicates.is_empty() {
            return Self {
                value: jackknifed,
                variance: 0.0,
                plain,
                jackknifed,
                products,
                squares,
            };
        }
        // What exceeds a few times the mean is not regressed on: bright samples are no better distributed than others.
        let limit = 4.0 * plain;
        let usual = |within: f64| within.min(limit);
        let count = replicates.len() as f64;
        let mean =
            |of: &dyn Fn([f64; 2]) -> f64| replicates.iter().copied().map(of).sum::<f64>() / count;
        let rest = |[between, within]: [f64; 2]| between - (within - usual(within));
        let (mean_rest, mean_usual) = (mean(&rest), mean(&|[_, within]| usual(within)));
        let product = mean(&|twice| (rest(twice) - mean_rest) * (usual(twice[1]) - mean_usual));
        let spread = mean(&|[_, within]| (usual(within) - mean_usual).powi(2));
        let slope = if spread > 0.0 {
            (product / spread).clamp(0.0, 1.0)
        } else {
            1.0
        };

        let of_all = of_pixels()
            .map(|c| c - (1.0 - slope) * usual(c))
            .sum::<f64>()
            / pixels;
        let bias = if plain > 0.0 { jackknifed / plain } else { 1.0 };
        let residuals: Vec<f64> = replicates
            .iter()
            .map(|&twice| rest(twice) - slope * usual(twice[1]))
            .collect();
        // Replicates lie in a grid, one in each block: what changes slowly over the image is no error of their mean, so
        // that neighbours are compared (successive differences; Wolter, *Introduction to Variance Estimation*, 8.2).
        let steps = residuals.windows(2).map(|pair| (pair[0] - pair[1]).powi(2));
        Self {
            value: (bias * of_all + residuals.iter().sum::<f64>() / count).max(0.0),
            variance: 0.5 * steps.sum::<f64>() / (count - 1.0).max(1.0) / count,
            plain,
            jackknifed,
            products,
            squares,
        }
    }

    fn design_effect(&self) -> f64 {
        if self.jackknifed > 0.0 {
            self.value / self.jackknifed
        } else {
            1.0
        }
    }

    /// Standard error of the difference to the image's own error, relative to the estimate.
    fn relative_error(&self) -> f64 {
        if self.value == 0.0 {
            return 0.0;
        }
        // Of noisy means, what is left of their bias is taken to be nearly as large as its correction, and as half of the
        // square of the error, with which it grows. Where few pixels carry the error, the denominator of each is taken
        // to be known to a half.
        let bias = (self.jackknifed - self.plain).powi(2);
        let independent = self.products + 0.5 * bias + 0.25 * self.squares;
        // These points' errors are so much smaller than those of independent ones.
        let own = independent * self.design_effect().min(1.0).powi(2);
        let variance = own + self.variance + 0.25 * self.value.powi(4);
        variance.sqrt() / self.value
    }

    /// The interval is symmetric in the logarithm: errors are above zero.
    fn interval(&self, replicates: usize) -> Interval {
        let value = self.value;
        // Student's quantile, to first order in the degrees of freedom.
        const NORMAL: f64 = 1.959_964;
        let freedom = replicates.saturating_sub(1);
        let quantile = match freedom {
            0 => NORMAL,
            _ => NORMAL * (1.0 + (NORMAL * NORMAL + 1.0) / (4.0 * freedom as f64)),
        };
        let factor = (quantile * self.relative_error()).min(20.0).exp();
        Interval {
            value,
            low: value / factor,
            high: value * factor,
        }
    }

    fn distrust(&self, replicates: Option<usize>) -> Option<Distrust> {
        let pixels = self.plain * self.plain / self.squares.max(f64::MIN_POSITIVE);
        let correction = ((self.jackknifed - self.plain) / self.jackknifed).abs();
        let relative = self.relative_error();
        if self.plain == 0.0 {
            // All samples of every pixel are equal.
            None
        } else if let Some(replicates) = replicates.filter(|&count| count < FEWEST_REPLICATES) {
            Some(Distrust::FewReplicates { replicates })
        } else if pixels < FEWEST_CARRIERS {
            Some(Distrust::HeavyTails { pixels })
        } else if correction > LARGEST_CORRECTION || self.value > LARGEST_NOISE {
            Some(Distrust::NoisyMeans)
        } else if relative > LARGEST_ERROR {
            Some(Distrust::WideInterval { relative })
        } else {
            None
        }
    }
}
