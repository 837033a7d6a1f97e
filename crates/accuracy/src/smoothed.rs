//! How bright a pixel truly is, as far as it and its neighbours know.
//!
//! Relative errors are divided by the square of a pixel's true mean. With its own noisy mean in the place of that, the quotient is
//! too small where few samples have been taken, by more than a jackknife can take out. Where neighbours differ by no more
//! than their noise, their mean says nine times as much; where they differ by more, at edges and in textures, the pixel
//! itself does. What lies between is weighed as for normal distributions (the empirical Bayes estimate of James and Stein
//! 1961, towards a local mean).

use rayon::prelude::*;

use crate::moments::CHANNELS;
use crate::plausible::plausible;

type Channels = [f32; CHANNELS];

/// Pixels that a thread takes at a time, at least.
pub(crate) const CHUNK: usize = 4096;

/// An image of noisy means, from which true ones are guessed.
pub(crate) struct Smoothed {
    /// Pixels a row.
    width: usize,
    /// Means of the pixels, as they are.
    means: Vec<Channels>,
    /// Those that their neighbours make implausible replaced.
    clipped: Vec<Channels>,
    /// Variances of the means, as of independent samples.
    noise: Vec<Channels>,
}

impl Smoothed {
    /// Of means with their variances, in rows of `width`.
    pub(crate) fn new(width: usize, means: Vec<Channels>, noise: Vec<Channels>) -> Self {
        let clip = |p: usize| {
            let own = means[p].map(f64::from);
            plausible(&means, width, p, own).map(|mean| mean as f32)
        };
        let clipped = (0..means.len())
            .into_par_iter()
            .with_min_len(CHUNK)
            .map(clip)
            .collect();
        Self {
            width,
            means,
            clipped,
            noise,
        }
    }

    /// The mean of pixel `p`.
    #[inline(always)]
    pub(crate) fn mean(&self, p: usize) -> [f64; CHANNELS] {
        self.toward_neighbors(p, self.clipped[p])
    }

    /// The mean of pixel `p`, where more is known of its own than the image says.
    pub(crate) fn mean_of(&self, p: usize, own: [f64; CHANNELS]) -> [f64; CHANNELS] {
        let own = plausible(&self.means, self.width, p, own);
        self.toward_neighbors(p, own.map(|mean| mean as f32))
    }

    #[inline(always)]
    fn toward_neighbors(&self, p: usize, own: Channels) -> [f64; CHANNELS] {
        let width = self.width;
        let height = self.clipped.len() / width;
        if width < 3 || height < 3 {
            return own.map(f64::from);
        }
        // Outside of the image, the nearest pixels inside stand in.
        let (x, y) = (p % width, p / width);
        let left = x.clamp(1, width - 2) - 1;
        let (mut sum, mut squares, mut noise) = ([0.0; CHANNELS], [0.0; CHANNELS], [0.0; CHANNELS]);
        for row in [y.max(1) - 1, y, (y + 1).min(height - 1)] {
            let first = row * width + left;
            let (means, noises) = (&self.clipped[first..][..3], &self.noise[first..][..3]);
            for (mean, variance) in means.iter().zip(noises) {
                for k in 0..CHANNELS {
                    // Relative to the pixel's own mean, so that squares do not cancel, and it counts nothing itself.
                    let delta = mean[k] - own[k];
                    sum[k] += delta;
                    squares[k] += delta * delta;
                    noise[k] += variance[k];
                }
            }
        }
        let mut smoothed = [0.0; CHANNELS];
        for k in 0..CHANNELS {
            let mean = sum[k] / NEIGHBORS;
            let noise = (noise[k] - self.noise[p][k]).max(0.0) / NEIGHBORS;
            let spread = (squares[k] - sum[k] * mean) / (NEIGHBORS - 1.0);
            // The variance of true means between pixels, and of what the neighbours say of this one.
            let signal = (spread - noise).max(0.0);
            let prior = signal + (signal + noise) / NEIGHBORS;
            let toward = if noise > 0.0 {
                noise / (prior + noise)
            } else {
                0.0
            };
            smoothed[k] = f64::from(own[k] + toward * mean);
        }
        smoothed
    }
}

/// Around a pixel.
const NEIGHBORS: f32 = 8.0;

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 9;

    /// Means by row and column, with one variance for all.
    fn smoothed(mean: impl Fn(usize, usize) -> f32, noise: f32) -> Smoothed {
        let places = (0..7).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
        let means: Vec<_> = places.map(|(x, y)| [mean(x, y); CHANNELS]).collect();
        let noise = vec![[noise; CHANNELS]; means.len()];
        Smoothed::new(WIDTH, means, noise)
    }

    fn at(image: &Smoothed, x: usize, y: usize) -> f64 {
        let p = y * WIDTH + x;
        let mean = image.mean(p);
        assert_eq!(mean, image.mean_of(p, image.means[p].map(f64::from)));
        mean[0]
    }

    #[test]
    fn without_noise_pixels_are_what_they_are() {
        let image = smoothed(|x, y| (x * x + 3 * y) as f32, 0.0);
        for (x, y) in [(0, 0), (4, 3), (8, 6), (7, 1)] {
            assert_eq!(at(&image, x, y), (x * x + 3 * y) as f64);
        }
    }

    #[test]
    fn noise_is_averaged_and_edges_stay() {
        // Neighbours that differ by less than their noise: a pixel counts as one of nine.
        let checkered = |x: usize, y: usize| if (x + y).is_multiple_of(2) { 1.1 } else { 0.9 };
        let image = smoothed(checkered, 0.02);
        let neighbors = (4.0 * 1.1 + 4.0 * 0.9) / 8.0;
        let expected = neighbors + (1.1 - neighbors) / 9.0;
        assert!(
            (at(&image, 4, 4) - expected).abs() < 1e-6,
            "{}",
            at(&image, 4, 4)
        );
        // An edge is far above the noise.
        let edge = |x: usize, _| if x < 4 { 1.0 } else { 5.0 };
        let image = smoothed(edge, 1e-3);
        assert!((at(&image, 3, 3) - 1.0).abs() < 0.01);
        assert!((at(&image, 4, 3) - 5.0).abs() < 0.01);
    }

    #[test]
    fn a_speck_neither_stays_nor_spreads() {
        let speck = |x: usize, y: usize| if (x, y) == (4, 3) { 100.0 } else { 1.0 };
        let image = smoothed(speck, 1e-3);
        for (x, y) in [(4, 3), (3, 3), (5, 4), (4, 2)] {
            assert!(
                (at(&image, x, y) - 1.0).abs() < 1e-3,
                "{x} {y}: {}",
                at(&image, x, y)
            );
        }
    }
}
