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
//! *The denominator is noisy.* With x in place of μ, error and denominator rise together, and the quotient falls short by a
//! part that shrinks as 1/N. The same statistic of the even and of the odd samples falls short by twice that part: twice
//! the one less the other is rid of it (the jackknife of halves; Quenouille 1949). And no pixel counts as far brighter
//! than its neighbours (`plausible.rs`).
//!
//! *The interval is of the error of this image.* Where ε_i is the error of sample i of N independent ones, (x − μ)² differs from
//! the samples' variance over N by Σ ε_i ε_j / N(N−1) over all i ≠ j, whose variance is 2 σ⁴ / N(N−1) for samples
//! of any distribution: the squares, and with them the bright samples, cancel. The product of the two halves' variances
//! estimates σ⁴ without bias.

use crate::moments::{CHANNELS, MeanVariance, PixelMoments, Y};
use crate::plausible::{Plausible, plausible};

/// Fewest samples of a pixel that say something of its error: two in each half.
pub const FEWEST_SAMPLES: u64 = 4;

/// A pixel's samples.
#[derive(Clone, Copy, Debug)]
pub struct Sampled<'a> {
    /// Their sums.
    pub moments: &'a PixelMoments,
    /// How many there are.
    pub samples: u64,
}

impl Sampled<'_> {
    fn channel(&self, channel: usize) -> MeanVariance {
        self.moments.channel(channel, self.samples)
    }

    fn halves(&self, channel: usize) -> [MeanVariance; 2] {
        self.moments.halves_of_channel(channel, self.samples)
    }

    /// Variance over the number of samples times a weight, by the jackknife of halves, each of which has its own weight.
    fn jackknifed(&self, channel: usize, weight: f64, of_halves: [f64; 2]) -> f64 {
        // Mean squared deviations, whose bias the jackknife takes out with that of the weights.
        let squares = |variance: f64, count: u64| variance * (1.0 - 1.0 / count as f64);
        let all = squares(self.channel(channel).variance, self.samples) * weight;
        let halves = self.halves(channel);
        let counts = [self.samples.div_ceil(2), self.samples / 2];
        let half = |k: usize| squares(halves[k].variance, counts[k]) * of_halves[k];
        (2.0 * all - 0.5 * (half(0) + half(1))) / self.samples as f64
    }
}

/// A second, independent set of as many samples of a pixel, with points of the same kind.
#[derive(Clone, Copy, Debug)]
pub struct Replicate<'a> {
    /// Index of the pixel.
    pub pixel: usize,
    /// Its second set of samples.
    pub sampled: Sampled<'a>,
}

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

/// Why a stated interval may not hold the truth as often as it says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distrust {
    /// Few bright samples carry the error: there may be others that no path has found yet.
    HeavyTails {
        /// Over how many pixels the error is spread, in effect: (Σ c)² ÷ Σ c² of the pixels' contributions.
        pixels: f64,
    },
    /// The pixels' means are too noisy to say what a relative error is relative to.
    NoisyMeans,
    /// Too few pixels were sampled a second time.
    FewReplicates {
        /// How many were.
        replicates: usize,
    },
    /// The second samples say too little of how well the points are distributed.
    WideInterval {
        /// Standard error of the estimate, relative to it.
        relative: f64,
    },
}

impl std::fmt::Display for Distrust {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::HeavyTails { pixels } => write!(
                f,
                "few bright samples carry the error, that of {pixels:.0} pixels in effect; \
                 there may be others that no path has found yet"
            ),
            Self::NoisyMeans => {
                f.write_str("the pixels are too noisy to say what their error is relative to; more samples say more")
            }
            Self::FewReplicates { replicates } => {
                write!(f, "only {replicates} pixels were sampled twice")
            }
            Self::WideInterval { relative } => write!(
                f,
                "its own standard error is {:.0} % of it; larger images say more",
                100.0 * relative
            ),
        }
    }
}

/// Below this many pixels that carry the error in effect, it has heavy tails.
const FEWEST_CARRIERS: f64 = 400.0;
/// Above this part of the estimate, the correction for noisy means is too large to trust what is left.
const LARGEST_CORRECTION: f64 = 0.15;
/// Above this error, pixels are so noisy that what the correction leaves is large, too.
const LARGEST_NOISE: f64 = 0.2;
/// Fewest replicates from which a standard error can be had.
const FEWEST_REPLICATES: usize = 16;
/// Above this standard error, relative to the estimate, its distribution is not known well enough for an interval.
const LARGEST_ERROR: f64 = 0.35;

/// What one channel says, or the mean of several.
#[derive(Clone, Debug, Default)]
struct Parts {
    /// By which pixels.
    contributions: Vec<f32>,
    /// By which replicates.
    replicates: Vec<Twice>,
    /// Variance of the difference to the image's own error, for independent samples.
    products: f64,
    /// With the pixels' means as they are.
    plain: f64,
    /// Without the bias of that.
    jackknifed: f64,
}

/// What a pixel that is sampled twice says of its squared error, relative to the square of its mean.
#[derive(Clone, Copy, Debug)]
struct Twice {
    /// By the difference of the two sets.
    between: f64,
    /// By the variances within them, as if samples were independent.
    within: f64,
}

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
        let count = pixels.len() as f64;
        let means: [f64; CHANNELS] = std::array::from_fn(|k| {
            pixels
                .iter()
                .map(|pixel| pixel.channel(k).mean)
                .sum::<f64>()
                / count
        });
        let color = (means[0] + means[1] + means[2]) / 3.0;
        let used = replicates.unwrap_or(&[]);
        let parts = [0, 1, 2, Y].map(|channel| {
            let mean = if channel == Y { means[Y] } else { color };
            Parts::of(width, pixels, used, channel, 1e-2 * mean * mean)
        });
        let colors = Parts::together(&parts[..Y]).sums();
        let [red, green, blue, luminance] = parts.map(|parts| parts.sums());
        Some(Self {
            relmse: colors.interval(used.len()),
            channels: [red, green, blue].map(|sums| sums.interval(used.len())),
            luminance: luminance.interval(used.len()),
            design_effect: colors.design_effect(),
            distrust: colors.distrust(replicates.map(<[_]>::len)),
        })
    }
}

impl Parts {
    fn of(
        width: usize,
        pixels: &[Sampled<'_>],
        replicates: &[Replicate<'_>],
        channel: usize,
        floor: f64,
    ) -> Self {
        let image = |mean: &dyn Fn(&Sampled<'_>) -> f64| -> Vec<f32> {
            pixels.iter().map(|pixel| mean(pixel) as f32).collect()
        };
        let limits = plausible(&image(&|pixel| pixel.channel(channel).mean), width);
        let half_limits =
            [0, 1].map(|half| plausible(&image(&|pixel| pixel.halves(channel)[half].mean), width));
        // One over the squared mean, as far as that is plausible.
        let scale = |mean: f64, limit: Plausible| {
            let squared = limit.limit(mean).powi(2) + floor;
            if squared > 0.0 { 1.0 / squared } else { 0.0 }
        };
        let mut sums = Self::default();
        let mut jackknifed = 0.0;
        for (p, pixel) in pixels.iter().enumerate() {
            let samples = pixel.samples as f64;
            let MeanVariance { mean, variance } = pixel.channel(channel);
            let weight = scale(mean, limits[p]);
            let contribution = variance / samples * weight;
            sums.plain += contribution;
            sums.contributions.push(contribution as f32);
            let halves = pixel.halves(channel);
            let product = halves[0].variance * halves[1].variance;
            sums.products += 2.0 * product * (weight / samples).powi(2);
            let of_half = |half: usize| scale(halves[half].mean, half_limits[half][p]);
            jackknifed += pixel.jackknifed(channel, weight, [of_half(0), of_half(1)]);
        }
        let count = pixels.len() as f64;
        sums.plain /= count;
        // A larger correction is no longer one.
        sums.jackknifed = (jackknifed / count).clamp(0.5 * sums.plain, 2.0 * sums.plain);
        sums.products /= count * count;

        sums.replicates.extend(replicates.iter().map(|replicate| {
            let pair = [pixels[replicate.pixel], replicate.sampled];
            let [first, second] = pair.map(|sampled| sampled.channel(channel).mean);
            let weight = scale(0.5 * (first + second), limits[replicate.pixel]);
            let within = pair.map(|sampled| sampled.jackknifed(channel, weight, [weight; 2]));
            Twice {
                between: 0.5 * (first - second).powi(2) * weight,
                within: 0.5 * (within[0] + within[1]),
            }
        }));
        sums
    }

    /// The mean of channels.
    fn together(channels: &[Self]) -> Self {
        let count = channels.len() as f64;
        let mean = |of: fn(&Self) -> f64| channels.iter().map(of).sum::<f64>() / count;
        let contribution =
            |p| channels.iter().map(|c| c.contributions[p]).sum::<f32>() / count as f32;
        let twice = |r| {
            let mean = |of: fn(&Twice) -> f64| {
                channels.iter().map(|c| of(&c.replicates[r])).sum::<f64>() / count
            };
            Twice {
                between: mean(|twice| twice.between),
                within: mean(|twice| twice.within),
            }
        };
        Self {
            contributions: (0..channels[0].contributions.len())
                .map(contribution)
                .collect(),
            replicates: (0..channels[0].replicates.len()).map(twice).collect(),
            // Paths shade all channels: their errors are taken to rise and fall as one.
            products: mean(|c| c.products.sqrt()).powi(2),
            plain: mean(|c| c.plain),
            jackknifed: mean(|c| c.jackknifed),
        }
    }

    fn sums(&self) -> Sums {
        let pixels = self.contributions.len() as f64;
        let contributions = || self.contributions.iter().map(|c| f64::from(*c));
        let squares = contributions().map(|c| c * c).sum::<f64>() / pixels / pixels;
        if self.replicates.is_empty() {
            return Sums {
                value: self.jackknifed,
                variance: 0.0,
                plain: self.plain,
                jackknifed: self.jackknifed,
                products: self.products,
                squares,
            };
        }
        // What exceeds a few times the mean is not regressed on: bright samples are no better distributed than others.
        let limit = 4.0 * self.plain;
        let usual = |within: f64| within.min(limit);
        let count = self.replicates.len() as f64;
        let mean = |of: &dyn Fn(&Twice) -> f64| self.replicates.iter().map(of).sum::<f64>() / count;
        let rest = |twice: &Twice| twice.between - (twice.within - usual(twice.within));
        let (mean_rest, mean_usual) = (mean(&rest), mean(&|twice| usual(twice.within)));
        let product = mean(&|twice| (rest(twice) - mean_rest) * (usual(twice.within) - mean_usual));
        let spread = mean(&|twice| (usual(twice.within) - mean_usual).powi(2));
        let slope = if spread > 0.0 {
            (product / spread).clamp(0.0, 1.0)
        } else {
            1.0
        };

        let of_all = contributions()
            .map(|c| c - (1.0 - slope) * usual(c))
            .sum::<f64>()
            / pixels;
        let bias = if self.plain > 0.0 {
            self.jackknifed / self.plain
        } else {
            1.0
        };
        let residuals: Vec<f64> = self
            .replicates
            .iter()
            .map(|twice| rest(twice) - slope * usual(twice.within))
            .collect();
        // Replicates lie in a grid, one in each block: what changes slowly over the image is no error of their mean, so
        // that neighbours are compared (successive differences; Wolter, *Introduction to Variance Estimation*, 8.2).
        let steps = residuals.windows(2).map(|pair| (pair[0] - pair[1]).powi(2));
        Sums {
            value: (bias * of_all + residuals.iter().sum::<f64>() / count).max(0.0),
            variance: 0.5 * steps.sum::<f64>() / (count - 1.0).max(1.0) / count,
            plain: self.plain,
            jackknifed: self.jackknifed,
            products: self.products,
            squares,
        }
    }
}

impl Sums {
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
        // Of noisy means, what is left of their bias is taken to be as large as half of its correction, and half of the
        // square of the error, with which it grows. Where few pixels carry the error, the denominator of each is taken
        // to be known to a half.
        let bias = (self.jackknifed - self.plain).powi(2);
        let independent = self.products + 0.25 * (bias + self.squares);
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
