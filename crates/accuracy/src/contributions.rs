//! What each pixel says of its error, relative to the square of its mean: the parts of an estimate.

use rayon::prelude::*;

use crate::moments::{CHANNELS, MeanVariance, halves_of};
use crate::sampled::{Replicate, Sampled};
use crate::smoothed::{CHUNK, Smoothed};

/// Of an image, by channel.
#[derive(Clone, Debug)]
pub(crate) struct Contributions {
    /// By pixel: its samples' variance over their number.
    pub(crate) of_pixels: Vec<[f32; CHANNELS]>,
    /// By replicate.
    pub(crate) of_replicates: Vec<Twice>,
    /// Mean of the contributions.
    pub(crate) plain: [f64; CHANNELS],
    /// The same without the bias of noisy means.
    pub(crate) jackknifed: [f64; CHANNELS],
    /// Variance of the difference to the image's own error, for independent samples.
    pub(crate) products: [f64; CHANNELS],
}

/// What a pixel that is sampled twice says.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Twice {
    /// By the difference of the two sets.
    pub(crate) between: [f64; CHANNELS],
    /// By the variances within them, as if samples were independent.
    pub(crate) within: [f64; CHANNELS],
}

impl Contributions {
    pub(crate) fn of(width: usize, pixels: &[Sampled<'_>], replicates: &[Replicate<'_>]) -> Self {
        let count = pixels.len() as f64;
        let images = [0, 1, 2].map(|part| smoothed(width, pixels, part));
        let mean = sum_of_means(pixels).map(|sum| sum / count);
        let color = (mean[0] + mean[1] + mean[2]) / 3.0;
        let floor = [color, color, color, mean[3]].map(|mean| 1e-2 * mean * mean);
        // One over the squared mean of a pixel.
        let scale = |mean: [f64; CHANNELS]| {
            let mut weight = [0.0; CHANNELS];
            for k in 0..CHANNELS {
                let squared = mean[k] * mean[k] + floor[k];
                weight[k] = if squared > 0.0 { 1.0 / squared } else { 0.0 };
            }
            weight
        };
        let nothing = || Self {
            of_pixels: Vec::new(),
            of_replicates: Vec::new(),
            plain: [0.0; CHANNELS],
            jackknifed: [0.0; CHANNELS],
            products: [0.0; CHANNELS],
        };

        // Sums are chunk by chunk, so that they do not depend on threads.
        let of_chunk = |(first, chunk): (usize, &[Sampled<'_>])| {
            let mut contributions = nothing();
            for (p, pixel) in (first * CHUNK..).zip(chunk) {
                let one_over = 1.0 / pixel.samples as f64;
                let statistics = pixel.moments.statistics(pixel.samples);
                let (all, halves) = &statistics;
                let weight = scale(images[0].mean(p));
                let of_halves = [0, 1].map(|half| scale(images[1 + half].mean(p)));
                let jackknifed = jackknifed(pixel.samples, &statistics, weight, of_halves);
                let mut contribution = [0.0; CHANNELS];
                for k in 0..CHANNELS {
                    let plain = all.variance[k] * one_over * weight[k];
                    let product = halves[0].variance[k] * halves[1].variance[k];
                    let squared_weight = (weight[k] * one_over) * (weight[k] * one_over);
                    contributions.plain[k] += plain;
                    contributions.products[k] += 2.0 * product * squared_weight;
                    contributions.jackknifed[k] += jackknifed[k];
                    contribution[k] = plain as f32;
                }
                contributions.of_pixels.push(contribution);
            }
            contributions
        };
        let chunks: Vec<_> = pixels.par_chunks(CHUNK).enumerate().map(of_chunk).collect();
        let mut contributions = nothing();
        for chunk in chunks {
            contributions.of_pixels.extend(chunk.of_pixels);
            for k in 0..CHANNELS {
                contributions.plain[k] += chunk.plain[k];
                contributions.jackknifed[k] += chunk.jackknifed[k];
                contributions.products[k] += chunk.products[k];
            }
        }
        for k in 0..CHANNELS {
            contributions.plain[k] /= count;
            contributions.products[k] /= count * count;
            // A larger correction is no longer one.
            let [least, most] = [0.5 * contributions.plain[k], 2.0 * contributions.plain[k]];
            contributions.jackknifed[k] = (contributions.jackknifed[k] / count).clamp(least, most);
        }

        contributions
            .of_replicates
            .extend(replicates.iter().map(|replicate| {
                let pair = [pixels[replicate.pixel], replicate.sampled];
                let statistics = pair.map(|set| set.moments.statistics(set.samples));
                let [first, second] = [&statistics[0].0.mean, &statistics[1].0.mean];
                let middle = std::array::from_fn(|k| 0.5 * (first[k] + second[k]));
                let weight = scale(images[0].mean_of(replicate.pixel, middle));
                let within = [0, 1]
                    .map(|k| jackknifed(pair[k].samples, &statistics[k], weight, [weight; 2]));
                Twice {
                    between: std::array::from_fn(|k| {
                        0.5 * (first[k] - second[k]).powi(2) * weight[k]
                    }),
                    within: std::array::from_fn(|k| 0.5 * (within[0][k] + within[1][k])),
                }
            }));
        contributions
    }
}

/// The means of all samples, of the even or of the odd ones: part 0, 1 or 2.
fn smoothed(width: usize, pixels: &[Sampled<'_>], part: usize) -> Smoothed {
    let of = |pixel: &Sampled<'_>| {
        let (all, [even, odd]) = pixel.moments.statistics(pixel.samples);
        let [even_count, odd_count] = halves_of(pixel.samples);
        let parts = [(all, pixel.samples), (even, even_count), (odd, odd_count)];
        let (MeanVariance { mean, variance }, count) = parts[part];
        let one_over = 1.0 / count as f64;
        (
            mean.map(|mean| mean as f32),
            variance.map(|variance| (variance * one_over) as f32),
        )
    };
    let (means, noise) = pixels.par_iter().with_min_len(CHUNK).map(of).unzip();
    Smoothed::new(width, means, noise)
}

/// Chunk by chunk, so that it does not depend on threads.
fn sum_of_means(pixels: &[Sampled<'_>]) -> [f64; CHANNELS] {
    let add =
        |sum: [f64; CHANNELS], mean: [f64; CHANNELS]| std::array::from_fn(|k| sum[k] + mean[k]);
    let of_chunk = |chunk: &[Sampled<'_>]| {
        let means = chunk.iter().map(|pixel| pixel.moments.mean(pixel.samples));
        means.fold([0.0; CHANNELS], add)
    };
    let sums: Vec<_> = pixels.par_chunks(CHUNK).map(of_chunk).collect();
    sums.into_iter().fold([0.0; CHANNELS], add)
}

/// Variance over the number of samples times a weight, by the jackknife of halves, each of which has its own weight.
#[inline(always)]
fn jackknifed(
    samples: u64,
    (all, halves): &(MeanVariance, [MeanVariance; 2]),
    weight: [f64; CHANNELS],
    of_halves: [[f64; CHANNELS]; 2],
) -> [f64; CHANNELS] {
    // Mean squared deviations, whose bias the jackknife takes out with that of the weights.
    let biased = |count: u64| 1.0 - 1.0 / count.max(1) as f64;
    let one_over = 1.0 / samples as f64;
    let of_all = 2.0 * biased(samples) * one_over;
    let of_half = halves_of(samples).map(|count| 0.5 * biased(count) * one_over);
    let mut result = [0.0; CHANNELS];
    for k in 0..CHANNELS {
        let in_halves = of_half[0] * halves[0].variance[k] * of_halves[0][k]
            + of_half[1] * halves[1].variance[k] * of_halves[1][k];
        result[k] = of_all * all.variance[k] * weight[k] - in_halves;
    }
    result
}
