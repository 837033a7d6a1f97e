//! Differences in units of their noise.
//!
//! If two images converge to the same, and their standard errors are true, then z = (test − reference) / √(σ²ₜ + σ²ᵣ) is
//! distributed with mean 0 and mean square 1, and normally where pixels have many samples. Which of these fails says what is
//! wrong: a mean square above 1 with a mean of 0 is noise that is understated, or few samples that carry much of the light; means of
//! blocks beyond what noise explains are a difference of what the images converge to (a bias of one of them).
//!
//! Scores assume that the images have independent random numbers. Pixels that share samples, by a wide pixel filter or a
//! denoiser, are correlated; then so are their scores, and those of blocks come out too large.

use super::pair::{MissingStandardError, Pair, Role};
use super::tile::Tile;
use crate::normal::{normal_cdf, two_sided_tail};

/// A score beyond this is counted as far: of a million normal numbers, 0.96 are.
pub const FAR: f64 = 4.9;

/// Width of the bins of histograms.
pub const BIN_WIDTH: f64 = 0.5;

/// Bins on each side of 0, without the open one at the end.
const BINS_A_SIDE: usize = 10;

/// Blocks are squares of so many pixels a side.
const BLOCK_SIDE: usize = 32;

/// The scores of all numbers of two images, and what they say together.
#[derive(Clone, Debug, PartialEq)]
pub struct ZScores {
    scores: Vec<[f64; 3]>,
    /// How many numbers have noise, and with it a score.
    pub scored: usize,
    /// How many numbers have no noise in either image, but for rounding, and are equal. They are left out of all else.
    pub exact: usize,
    /// How many numbers differ though neither image has noise there. Their scores are infinite: they count as far, and are
    /// left out of means.
    pub contradicting: usize,
    /// Mean of the scores: 0 if neither image is biased.
    pub mean: f64,
    /// Mean of their squares: 1 if standard errors are true.
    pub mean_square: f64,
    /// How many scores are farther from 0 than [`FAR`].
    pub far: usize,
    /// The same of sums over blocks.
    pub blocks: BlockScores,
    counts: [usize; 2 * BINS_A_SIDE + 2],
}

/// A bin of a histogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Its lower end; the first bin begins at −∞.
    pub from: f64,
    /// Its upper end; the last bin ends at ∞.
    pub to: f64,
    /// How many scores are in it.
    pub counted: usize,
    /// How many of as many normal numbers would be.
    pub expected: f64,
}

/// Scores of the sums over blocks of 32 × 32 pixels, each channel on its own. Noise is averaged out in them by a factor of
/// 32, bias is not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockScores {
    /// How many blocks and channels have noise.
    pub scored: usize,
    /// Mean of their squared scores: 1 if neither image is biased and pixels are independent.
    pub mean_square: f64,
    /// The one farthest from 0; none if nothing has noise.
    pub largest: Option<LargestBlock>,
}

/// The block whose score is the farthest from 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LargestBlock {
    /// Where it is.
    pub tile: Tile,
    /// Red, green or blue.
    pub channel: usize,
    /// The score.
    pub score: f64,
    /// The probability that the largest of so many normal numbers is as far from 0 (Šidák's bound: channels are correlated).
    pub probability: f64,
}

impl ZScores {
    /// The scores of a pair.
    ///
    /// # Errors
    /// If one of the images comes without standard errors.
    pub fn of(pair: &Pair<'_>) -> Result<Self, MissingStandardError> {
        let missing = |role| move || MissingStandardError(role);
        let reference = pair.reference().variances();
        let reference = reference.ok_or_else(missing(Role::Reference))?;
        let test = pair.test().variances();
        let test = test.ok_or_else(missing(Role::Test))?;
        let variances: Vec<f64> = reference.zip(test).map(|(a, b)| a + b).collect();
        let mut all = Self {
            scores: Vec::new(),
            scored: 0,
            exact: 0,
            contradicting: 0,
            mean: 0.0,
            mean_square: 0.0,
            far: 0,
            blocks: BlockScores::of(pair, &variances),
            counts: [0; 2 * BINS_A_SIDE + 2],
        };
        let values = pair.values().zip(&variances);
        let scores: Vec<f64> = values
            .map(|((reference, test), &variance)| all.add(reference, test, variance))
            .collect();
        all.scores = scores.as_chunks().0.to_vec();
        let scored = all.scored.max(1) as f64;
        all.mean /= scored;
        all.mean_square /= scored;
        Ok(all)
    }

    /// Counts a number, and gives its score.
    fn add(&mut self, reference: f64, test: f64, variance: f64) -> f64 {
        let difference = test - reference;
        // Numbers are stored in single precision.
        let rounding = f64::from(f32::EPSILON) * reference.abs().max(test.abs());
        if variance > 0.0 {
            let score = difference / (variance + rounding * rounding).sqrt();
            self.scored += 1;
            self.mean += score;
            self.mean_square += score * score;
            self.far += usize::from(score.abs() > FAR);
            let bin = (score / BIN_WIDTH).floor() + (BINS_A_SIDE + 1) as f64;
            // The conversion takes what is below 0 to 0.
            self.counts[(bin as usize).min(2 * BINS_A_SIDE + 1)] += 1;
            score
        } else if difference.abs() <= rounding {
            self.exact += 1;
            0.0
        } else {
            self.contradicting += 1;
            difference.signum() * f64::INFINITY
        }
    }

    /// The scores of each pixel's channels, row by row: 0 where neither image has noise and both are equal, infinite where
    /// they differ without noise.
    pub fn scores(&self) -> &[[f64; 3]] {
        &self.scores
    }

    /// Of each pixel the score that is the farthest from 0, for a picture.
    pub fn farthest(&self) -> Vec<f64> {
        let farthest = |scores: &[f64; 3]| {
            let larger = |a: f64, b: f64| if b.abs() > a.abs() { b } else { a };
            larger(larger(scores[0], scores[1]), scores[2])
        };
        self.scores.iter().map(farthest).collect()
    }

    /// The part of the numbers with noise, or with a difference without noise, whose score is farther from 0 than [`FAR`].
    pub fn far_part(&self) -> f64 {
        let of = self.scored + self.contradicting;
        (self.far + self.contradicting) as f64 / of.max(1) as f64
    }

    /// The part that it would be of normal numbers.
    pub fn expected_far_part() -> f64 {
        two_sided_tail(FAR)
    }

    /// How the scores are distributed: bins of [`BIN_WIDTH`], and an open one at each end.
    pub fn histogram(&self) -> Vec<Bin> {
        let bin = |(k, &counted): (usize, &usize)| {
            let edge = |k: usize| (k as f64 - (BINS_A_SIDE + 1) as f64) * BIN_WIDTH;
            let last = self.counts.len() - 1;
            let from = if k == 0 { f64::NEG_INFINITY } else { edge(k) };
            let to = if k == last {
                f64::INFINITY
            } else {
                edge(k + 1)
            };
            Bin {
                from,
                to,
                counted,
                expected: self.scored as f64 * (normal_cdf(to) - normal_cdf(from)),
            }
        };
        self.counts.iter().enumerate().map(bin).collect()
    }
}

impl BlockScores {
    fn of(pair: &Pair<'_>, variances: &[f64]) -> Self {
        let (reference, test) = (pair.reference().pixels(), pair.test().pixels());
        let width = pair.size()[0];
        let (mut scored, mut squares) = (0, 0.0);
        let mut largest: Option<LargestBlock> = None;
        for tile in Tile::all(pair.size(), BLOCK_SIDE) {
            for channel in 0..3 {
                let (mut difference, mut variance) = (0.0, 0.0);
                for k in tile.indices(width) {
                    difference += f64::from(test[k][channel]) - f64::from(reference[k][channel]);
                    variance += variances[3 * k + channel];
                }
                if variance == 0.0 {
                    continue;
                }
                let score = difference / variance.sqrt();
                scored += 1;
                squares += score * score;
                if largest.is_none_or(|largest| score.abs() > largest.score.abs()) {
                    largest = Some(LargestBlock {
                        tile,
                        channel,
                        score,
                        probability: 1.0,
                    });
                }
            }
        }
        if let Some(largest) = &mut largest {
            // 1 − (1 − p)ⁿ, without cancellation.
            let single = two_sided_tail(largest.score);
            largest.probability = -(f64::from(scored) * (-single).ln_1p()).exp_m1();
        }
        Self {
            scored: scored as usize,
            mean_square: squares / f64::from(scored).max(1.0),
            largest,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::comparison::image::Image;

    const WIDTH: usize = 128;
    const PIXELS: usize = 128 * 96;

    /// Normal noise of these standard deviations around a mean (Box and Muller 1958).
    fn noisy(seed: u64, mean: f64, deviations: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let mut state = seed;
        let mut uniform = || {
            state = state
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            ((state >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
        };
        let mut normal = || {
            let radius = (-2.0 * uniform().ln()).sqrt();
            radius * (std::f64::consts::TAU * uniform()).cos()
        };
        let mut pixel =
            |deviations: &[f32; 3]| deviations.map(|d| (mean + f64::from(d) * normal()) as f32);
        deviations.iter().map(&mut pixel).collect()
    }

    fn deviations(factor: f32) -> Vec<[f32; 3]> {
        let pixel = |k: usize| [0.5, 1.0, 1.5].map(|c| factor * c * (1.0 + (k % 7) as f32));
        (0..PIXELS).map(pixel).collect()
    }

    fn scores(reference: (&[[f32; 3]], &[[f32; 3]]), test: (&[[f32; 3]], &[[f32; 3]])) -> ZScores {
        let image = |(pixels, errors)| Image::new(pixels, WIDTH).with_standard_errors(errors);
        ZScores::of(&Pair::new(image(reference), image(test)).unwrap()).unwrap()
    }

    #[test]
    fn scores_of_true_standard_errors_are_normal() {
        let (little, much) = (deviations(0.003), deviations(0.01));
        let (reference, test) = (noisy(1, 2.0, &little), noisy(2, 2.0, &much));
        let z = scores((&reference, &little), (&test, &much));
        assert_eq!((z.scored, z.exact, z.contradicting), (3 * PIXELS, 0, 0));
        // Four standard deviations of means of so many numbers.
        let count = z.scored as f64;
        assert!(z.mean.abs() < 4.0 / count.sqrt(), "{}", z.mean);
        assert!((z.mean_square - 1.0).abs() < 4.0 * (2.0 / count).sqrt());
        assert!(z.far <= 2, "{}", z.far);
        let blocks = f64::from(4 * 3 * 3);
        assert_eq!(z.blocks.scored as f64, blocks);
        assert!((z.blocks.mean_square - 1.0).abs() < 4.0 * (2.0 / blocks).sqrt());
        assert!(z.blocks.largest.unwrap().probability > 0.001);
        let histogram = z.histogram();
        let sum = |f: fn(&Bin) -> f64| histogram.iter().map(f).sum::<f64>();
        assert!((sum(|bin| bin.expected) - count).abs() < 1e-6);
        assert_eq!(sum(|bin| bin.counted as f64), count);
        for bin in &histogram {
            let spread = bin.expected.max(1.0).sqrt();
            assert!(
                (bin.counted as f64 - bin.expected).abs() < 5.0 * spread,
                "{bin:?}"
            );
        }
    }

    #[test]
    fn bins_hold_what_lies_in_them() {
        let errors = vec![[1.0; 3]; 4];
        let (reference, mut test) = ([[0.0; 3]; 4], [[0.0; 3]; 4]);
        test[0] = [-7.0, 0.25, 0.5];
        test[1] = [-0.25, 4.75, 80.0];
        let image = |pixels| Image::new(pixels, 2).with_standard_errors(&errors);
        let pair = Pair::new(image(&reference), image(&test)).unwrap();
        let z = ZScores::of(&pair).unwrap();
        for bin in z.histogram() {
            let scores = z.scores().as_flattened();
            let inside = scores.iter().filter(|z| (bin.from..bin.to).contains(z));
            assert_eq!(inside.count(), bin.counted, "{bin:?}");
        }
        let root = 2_f64.sqrt();
        assert_eq!(
            z.farthest()[1],
            80.0 / (2.0 + (80.0 * f64::from(f32::EPSILON)).powi(2)).sqrt()
        );
        assert!((z.farthest()[0] + 7.0 / root).abs() < 1e-6);
        assert_eq!((z.far, z.far_part()), (2, 2.0 / 12.0));
    }

    /// Errors that are stated too small by a factor show in the mean square, a bias too small for single pixels in blocks.
    #[test]
    fn wrong_noise_and_bias_are_told_apart() {
        let (stated, real) = (deviations(0.01), deviations(0.02));
        let (reference, test) = (noisy(1, 2.0, &real), noisy(2, 2.0, &real));
        let z = scores((&reference, &stated), (&test, &stated));
        assert!((z.mean_square - 4.0).abs() < 0.2 && z.mean.abs() < 0.05);
        let mut biased = noisy(2, 2.0, &stated);
        let reference = noisy(1, 2.0, &stated);
        for k in Tile::all([WIDTH, PIXELS / WIDTH], 32)
            .nth(6)
            .unwrap()
            .indices(WIDTH)
        {
            biased[k][1] += 0.02;
        }
        let z = scores((&reference, &stated), (&biased, &stated));
        assert!(z.far <= 2 && (z.mean_square - 1.0).abs() < 0.05);
        let largest = z.blocks.largest.unwrap();
        assert_eq!(
            (largest.tile.x, largest.tile.y, largest.channel),
            (64, 32, 1)
        );
        assert!(
            largest.score > 5.0 && largest.probability < 1e-4,
            "{largest:?}"
        );
    }

    #[test]
    fn what_has_no_noise_is_equal_or_contradicts() {
        let errors = [[0.0, 0.0, 0.1]; 4];
        let reference = [[1.0, 1.0, 1.0]; 4];
        let mut test = reference;
        test[1] = [f32::next_up(1.0), 1.5, 1.0];
        test[2] = [1.0, 0.5, 1.0];
        let image = |pixels| Image::new(pixels, 2).with_standard_errors(&errors);
        let pair = Pair::new(image(&reference), image(&test)).unwrap();
        let z = ZScores::of(&pair).unwrap();
        assert_eq!((z.scored, z.exact, z.contradicting), (4, 6, 2));
        assert_eq!(z.farthest()[1..3], [f64::INFINITY, f64::NEG_INFINITY]);
        assert_eq!(z.far_part(), 2.0 / 6.0);
        assert_eq!((z.mean, z.mean_square), (0.0, 0.0));
    }

    #[test]
    fn both_images_need_their_noise() {
        let (pixels, errors) = ([[1.0; 3]; 4], [[0.1; 3]; 4]);
        let (bare, noisy) = (
            Image::new(&pixels, 2),
            Image::new(&pixels, 2).with_standard_errors(&errors),
        );
        let message = |reference, test| {
            let pair = Pair::new(reference, test).unwrap();
            ZScores::of(&pair).unwrap_err().to_string()
        };
        assert!(message(bare, noisy).contains("reference"));
        assert!(message(noisy, bare).contains("test"));
        let same = ZScores::of(&Pair::new(noisy, noisy).unwrap()).unwrap();
        assert_eq!(same.far_part(), 0.0);
    }
}
