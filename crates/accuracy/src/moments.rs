//! Running sums of the samples of a pixel: what an error estimate is made from.

use crate::luminance::luminance;

/// Red, green, blue and luminance.
pub const CHANNELS: usize = 4;

/// Luminance among the [`CHANNELS`].
pub const Y: usize = 3;

/// Sums of a number of samples, which is kept elsewhere: pixels of a tile have the same.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Moments {
    /// Sum of the samples, by channel.
    sum: [f64; CHANNELS],
    /// Sum of squared deviations from their mean (Welford 1962), which does not cancel as sums of squares do.
    deviations: [f64; CHANNELS],
}

/// What adding a sample needs of the number of those before it; the same for all pixels that get one.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// One over the number of samples before; 0 for the first.
    one_over_before: f64,
    /// Number before ÷ number after.
    share: f64,
}

impl Step {
    fn after(before: u64) -> Self {
        let before = before as f64;
        Self {
            one_over_before: if before > 0.0 { 1.0 / before } else { 0.0 },
            share: before / (before + 1.0),
        }
    }
}

impl Moments {
    #[inline(always)]
    fn add(&mut self, values: [f64; CHANNELS], step: Step) {
        for (k, value) in values.into_iter().enumerate() {
            let delta = value - self.sum[k] * step.one_over_before;
            self.deviations[k] += delta * delta * step.share;
            self.sum[k] += value;
        }
    }

    fn statistics(&self, count: u64) -> MeanVariance {
        let one_over = 1.0 / count.max(1) as f64;
        let one_over_freedom = 1.0 / count.saturating_sub(1).max(1) as f64;
        MeanVariance {
            mean: self.sum.map(|sum| sum * one_over),
            variance: self.deviations.map(|squares| squares * one_over_freedom),
        }
    }
}

/// Mean of samples, 0 of none, and variance of one of them, without bias, 0 of one; of red, green, blue and luminance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanVariance {
    /// Mean.
    pub mean: [f64; CHANNELS],
    /// Variance of a sample, not of the mean.
    pub variance: [f64; CHANNELS],
}

/// Sums of the samples of one pixel, even and odd samples apart: what one half says can be weighed by what the other says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelMoments {
    halves: [Moments; 2],
}

/// How many of `count` samples are in the even and in the odd half.
pub(crate) fn halves_of(count: u64) -> [u64; 2] {
    [count.div_ceil(2), count / 2]
}

/// Where one sample goes, for all pixels that have as many.
#[derive(Clone, Copy, Debug)]
pub struct SampleIndex {
    half: usize,
    step: Step,
}

impl SampleIndex {
    /// Sample `index`, counted from 0, which must be added in order.
    pub fn new(index: u64) -> Self {
        Self {
            half: (index % 2) as usize,
            step: Step::after(index / 2),
        }
    }
}

impl PixelMoments {
    /// Adds a sample: linear red, green and blue.
    #[inline(always)]
    pub fn add(&mut self, rgb: [f64; 3], at: SampleIndex) {
        self.halves[at.half].add([rgb[0], rgb[1], rgb[2], luminance(rgb)], at.step);
    }

    /// Mean of all `count` samples, of red, green, blue and luminance.
    #[inline(always)]
    pub fn mean(&self, count: u64) -> [f64; CHANNELS] {
        let one_over = 1.0 / count.max(1) as f64;
        let [a, b] = &self.halves;
        std::array::from_fn(|k| (a.sum[k] + b.sum[k]) * one_over)
    }

    /// Mean and variance of all `count` samples (Chan, Golub and LeVeque 1979), and of the even and of the odd ones.
    #[inline(always)]
    pub fn statistics(&self, count: u64) -> (MeanVariance, [MeanVariance; 2]) {
        let counts = halves_of(count);
        let [a, b] = &self.halves;
        let halves = [a.statistics(counts[0]), b.statistics(counts[1])];
        let weight = counts[0] as f64 * counts[1] as f64 / count.max(1) as f64;
        let one_over_freedom = 1.0 / count.saturating_sub(1).max(1) as f64;
        let mut variance = [0.0; CHANNELS];
        for (k, variance) in variance.iter_mut().enumerate() {
            let between = halves[0].mean[k] - halves[1].mean[k];
            let squares = a.deviations[k] + b.deviations[k] + between * between * weight;
            *variance = squares * one_over_freedom;
        }
        let all = MeanVariance {
            mean: self.mean(count),
            variance,
        };
        (all, halves)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and variance, from their definitions.
    fn direct(values: &[f64]) -> [f64; 2] {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        [mean, squares / (count - 1.0)]
    }

    #[test]
    fn moments_are_those_of_the_definitions() {
        let values: Vec<f64> = (0..13).map(|k| f64::from(k * k % 7) + 0.1).collect();
        let mut pixel = PixelMoments::default();
        for (index, &value) in values.iter().enumerate() {
            pixel.add([value, 2.0 * value, 0.5], SampleIndex::new(index as u64));
        }
        let close = |ours: MeanVariance, values: &[f64]| {
            let [mean, variance] = direct(values);
            assert!((ours.mean[0] - mean).abs() < 1e-12);
            assert!((ours.variance[0] - variance).abs() < 1e-12);
            assert!((ours.variance[1] - 4.0 * variance).abs() < 1e-11);
            assert!(ours.variance[2] < 1e-20);
            let y = luminance([1.0, 2.0, 0.0]);
            assert!((ours.variance[Y] - y * y * variance).abs() < 1e-11);
        };
        let half =
            |parity| -> Vec<f64> { values.iter().copied().skip(parity).step_by(2).collect() };
        let (all, halves) = pixel.statistics(13);
        close(halves[0], &half(0));
        close(halves[1], &half(1));
        close(all, &values);
    }

    /// S-02: a mean that is large beside the deviations.
    #[test]
    fn variances_do_not_cancel() {
        let mut pixel = PixelMoments::default();
        for index in 0..1 << 16 {
            let value = 1e6 + if index / 2 % 2 == 0 { 0.5 } else { -0.5 };
            pixel.add([value; 3], SampleIndex::new(index));
        }
        let variance = pixel.statistics(1 << 16).0.variance[0];
        assert!((variance / 0.25 - 1.0).abs() < 1e-4, "{variance}");
    }

    #[test]
    fn nothing_has_no_moments() {
        let pixel = PixelMoments::default();
        let nothing = MeanVariance {
            mean: [0.0; CHANNELS],
            variance: [0.0; CHANNELS],
        };
        assert_eq!(pixel.statistics(0), (nothing, [nothing; 2]));
        assert_eq!(pixel.statistics(1).0, nothing);
        assert_eq!(halves_of(5), [3, 2]);
    }
}
