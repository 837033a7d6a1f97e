//! An upper bound of the error that holds for any samples at all, as long as they lie between 0 and 1: ambient occlusion,
//! visibility, samples that are clamped to white.
//!
//! The interval of an [`ErrorEstimate`](crate::ErrorEstimate) rests on what has been seen: bright samples that no path has
//! found are not in it. Where samples are bounded, what was not seen is, too. Half of the squared difference of two
//! independent means of one pixel lies between 0 and 1/2, and its expectation is the pixel's expected squared error;
//! Maurer and Pontil's empirical Bernstein bound (2009, theorem 4) says how far the mean over pixels that were chosen at random
//! can be below its expectation. How far the squared error of this one image can be above that is Bernstein's inequality, over
//! all pixels. Either fails in at most 2.5 % of images.

use crate::sampled::{Replicate, Sampled};

/// The part of images whose error may exceed either of two bounds.
const RISK: f64 = 0.025;
/// The largest half of a squared difference.
const LARGEST: f64 = 0.5;

/// A mean squared error of red, green and blue that the image does not exceed with 95 % confidence, if all samples lie in [0, 1].
/// It is of the pixels from which replicates were chosen: each with the same probability, one by one.
///
/// `None` if there are fewer than two replicates.
///
/// # Panics
/// If a replicate is of none of the pixels.
pub fn guaranteed_mse(pixels: &[Sampled<'_>], replicates: &[Replicate<'_>]) -> Option<f64> {
    let count = replicates.len() as f64;
    if replicates.len() < 2 {
        return None;
    }
    let halves: Vec<f64> = replicates
        .iter()
        .map(|replicate| {
            let pair = [pixels[replicate.pixel], replicate.sampled];
            let [first, second] = pair.map(|set| set.moments.mean(set.samples));
            let half = |k: usize| 0.5 * (first[k] - second[k]).powi(2);
            (half(0) + half(1) + half(2)) / 3.0
        })
        .collect();
    let mean = halves.iter().sum::<f64>() / count;
    let squares: f64 = halves.iter().map(|half| (half - mean).powi(2)).sum();
    let variance = squares / (count - 1.0);
    let log = (2.0 / RISK).ln();
    let unseen = 7.0 * LARGEST * log / (3.0 * (count - 1.0));
    let expected = mean + (2.0 * variance * log / count).sqrt() + unseen;
    // Squared errors are at most 1, so that their variance is at most their mean.
    let (log, all) = ((1.0 / RISK).ln(), pixels.len() as f64);
    let of_image = expected + (2.0 * expected * log / all).sqrt() + log / (3.0 * all);
    Some(of_image.min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moments::{PixelMoments, SampleIndex};

    /// Random numbers (Steele, Lea and Flood 2014, SplitMix64).
    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        }
    }

    const PIXELS: usize = 4096;
    const SAMPLES: u64 = 4;

    /// The bound, half the mean squared difference, and the true mean squared error of an image whose pixels are white in one
    /// sample of so many, else black.
    fn image(random: &mut Random, white: f64) -> [f64; 3] {
        let mut sampled = || {
            let mut moments = PixelMoments::default();
            for index in 0..SAMPLES {
                let value = if random.unit() < white { 1.0 } else { 0.0 };
                moments.add([value; 3], SampleIndex::new(index));
            }
            moments
        };
        let first: Vec<_> = (0..PIXELS).map(|_| sampled()).collect();
        let second: Vec<_> = (0..PIXELS / 16).map(|_| sampled()).collect();
        let of = |moments| Sampled {
            moments,
            samples: SAMPLES,
        };
        let pixels: Vec<_> = first.iter().map(of).collect();
        let replicates: Vec<_> = second
            .iter()
            .enumerate()
            .map(|(k, moments)| Replicate {
                pixel: 16 * k + 5,
                sampled: of(moments),
            })
            .collect();
        let half = |r: &Replicate<'_>| {
            let means = [pixels[r.pixel], r.sampled].map(|s| s.moments.mean(SAMPLES)[0]);
            0.5 * (means[0] - means[1]).powi(2)
        };
        let seen = replicates.iter().map(half).sum::<f64>() / replicates.len() as f64;
        let errors = first.iter().map(|m| (m.mean(SAMPLES)[0] - white).powi(2));
        [
            guaranteed_mse(&pixels, &replicates).unwrap(),
            seen,
            errors.sum::<f64>() / PIXELS as f64,
        ]
    }

    #[test]
    fn the_bound_holds_where_nothing_was_seen() {
        let mut random = Random(7);
        for white in [0.5, 0.02, 3e-4] {
            let images: Vec<_> = (0..200).map(|_| image(&mut random, white)).collect();
            let exceeded = images.iter().filter(|[bound, _, truth]| truth > bound);
            assert_eq!(exceeded.count(), 0, "{white}");
            // What was seen by itself is no bound.
            let below = images.iter().filter(|[_, seen, truth]| truth > seen);
            assert!(below.count() > 60, "{white}");
        }
    }

    #[test]
    fn the_bound_is_the_formula() {
        // By hand: no differences among 256 replicates of 4096 pixels.
        let [bound, seen, _] = image(&mut Random(1), 0.0);
        let unseen = 7.0 * 0.5 * 80_f64.ln() / (3.0 * 255.0);
        let log = 40_f64.ln();
        let expected = unseen + (2.0 * unseen * log / 4096.0).sqrt() + log / (3.0 * 4096.0);
        assert!(
            seen == 0.0 && (bound / expected - 1.0).abs() < 1e-12,
            "{bound}"
        );
        assert_eq!(guaranteed_mse(&[], &[]), None);
    }

    #[test]
    fn of_many_pixels_the_bound_is_near() {
        let [bound, _, truth] = image(&mut Random(2), 0.5);
        assert!(bound < 1.8 * truth, "{bound} {truth}");
    }
}
