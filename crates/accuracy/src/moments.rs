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

    /// Mean and variance of a channel of `count` samples.
    #[inline(always)]
    fn channel(&self, channel: usize, count: u64) -> MeanVariance {
        MeanVariance {
            mean: self.sum[channel] / count.max(1) as f64,
            variance: self.deviations[channel] / count.saturating_sub(1).max(1) as f64,
        }
    }
}

/// Mean of samples, 0 of none, and variance of one of them, without bias, 0 of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanVariance {
    /// Mean.
    pub mean: f64,
    /// Variance of a sample, not of the mean.
    pub variance: f64,
}

/// Sums of the samples of one pixel, even and odd samples apart: what one half says can be weighed by what the other says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PixelMoments {
    halves: [Moments; 2],
}

/// How many of `count` samples are in the even and in the odd half.
fn halves_of(count: u64) -> [u64; 2] {
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

    /// Mean and variance of a channel of all `count` samples (Chan, Golub and LeVeque 1979).
    #[inline(always)]
    pub fn channel(&self, channel: usize, count: u64) -> MeanVariance {
        let [even, odd] = self.halves_of_channel(channel, count);
        let counts = halves_of(count).map(|count| count as f64);
        let between = (even.mean - odd.mean).powi(2) * counts[0] * counts[1];
        let [a, b] = &self.halves;
        let all = count.max(1) as f64;
        let deviations = a.deviations[channel] + b.deviations[channel] + between / all;
        MeanVariance {
            mean: (a.sum[channel] + b.sum[channel]) / all,
            variance: deviations / (all - 1.0).max(1.0),
        }
    }

    /// The same of the even and of the odd ones.
    #[inline(always)]
    pub fn halves_of_channel(&self, channel: usize, count: u64) -> [MeanVariance; 2] {
        let counts = halves_of(count);
        [0, 1].map(|half| self.halves[half].channel(channel, counts[half]))
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
        let close = |ours: &dyn Fn(usize) -> MeanVariance, values: &[f64]| {
            let [mean, variance] = direct(values);
            assert!((ours(0).mean - mean).abs() < 1e-12);
            assert!((ours(0).variance - variance).abs() < 1e-12);
            assert!((ours(1).variance - 4.0 * variance).abs() < 1e-11);
            assert!(ours(2).variance < 1e-20);
            let y = luminance([1.0, 2.0, 0.0]);
            assert!((ours(Y).variance - y * y * variance).abs() < 1e-11);
        };
        let half =
            |parity| -> Vec<f64> { values.iter().copied().skip(parity).step_by(2).collect() };
        close(&|k| pixel.halves_of_channel(k, 13)[0], &half(0));
        close(&|k| pixel.halves_of_channel(k, 13)[1], &half(1));
        close(&|k| pixel.channel(k, 13), &values);
    }

    /// S-02: a mean that is large beside the deviations.
    #[test]
    fn variances_do_not_cancel() {
        let mut pixel = PixelMoments::default();
        for index in 0..1 << 16 {
            let value = 1e6 + if index / 2 % 2 == 0 { 0.5 } else { -0.5 };
            pixel.add([value; 3], SampleIndex::new(index));
        }
        let variance = pixel.channel(0, 1 << 16).variance;
        assert!((variance / 0.25 - 1.0).abs() < 1e-4, "{variance}");
    }

    #[test]
    fn nothing_has_no_moments() {
        let pixel = PixelMoments::default();
        let nothing = MeanVariance {
            mean: 0.0,
            variance: 0.0,
        };
        assert_eq!(pixel.channel(0, 0), nothing);
        assert_eq!(pixel.channel(Y, 1), nothing);
        assert_eq!(halves_of(5), [3, 2]);
    }
}
