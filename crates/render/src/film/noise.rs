//! How noisy a tile is, as its first samples say.

use residual_accuracy::{CHANNELS, PixelMoments};

/// Samples of a pixel from which noise is read: this many, and then after each doubling.
pub(super) const FIRST: u64 = 16;

/// Red, green and blue of a tile's first samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Noise {
    /// Their mean.
    pub(super) mean: [f64; 3],
    /// Variance of a sample within its pixel, on average over the pixels.
    pub(super) variance: [f64; 3],
}

/// The noise after the first 16, 32, 64, … samples of a tile.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Noises(Vec<Noise>);

impl Noises {
    /// How often noise has been read.
    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    /// The noise of the first `FIRST << index` samples.
    pub(super) fn at(&self, index: usize) -> &Noise {
        &self.0[index]
    }

    /// Reads the noise, if it is time: after each sample.
    pub(super) fn note(&mut self, pixels: &[PixelMoments], samples: u64) {
        if samples != FIRST << self.0.len() {
            return;
        }
        let mut sums = [[0.0; CHANNELS]; 2];
        for pixel in pixels {
            let (all, _) = pixel.statistics(samples);
            for (sum, values) in sums.iter_mut().zip([all.mean, all.variance]) {
                *sum = std::array::from_fn(|k| sum[k] + values[k]);
            }
        }
        let count = pixels.len() as f64;
        let [mean, variance] = sums.map(|[r, g, b, _]| [r, g, b].map(|sum| sum / count));
        self.0.push(Noise { mean, variance });
    }
}

impl Noise {
    /// Variance relative to the squared mean, to which `floor` is added; the mean of the three channels.
    pub(super) fn relative(&self, floor: f64) -> f64 {
        let of = |k: usize| {
            let square = self.mean[k] * self.mean[k] + floor;
            if square > 0.0 {
                self.variance[k] / square
            } else {
                0.0
            }
        };
        (of(0) + of(1) + of(2)) / 3.0
    }
}
