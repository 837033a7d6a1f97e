//! The images of one renderer: how wrong each is, measured against the mean of all others.

use residual_accuracy::relative_mse;

use super::contender::Series;

/// All images of a renderer, of any samplers and numbers of samples. Their mean, each weighed by its samples, is as good a converged
/// image as there is time for.
pub struct Pool<'a> {
    groups: Vec<&'a Series>,
    /// Σ weight · image.
    sum: Vec<[f64; 3]>,
    /// Σ weight.
    weight: f64,
}

/// How often group errors are corrected by one another: each time, what is wrong falls by the reference's part of it.
const CORRECTIONS: usize = 100;

impl<'a> Pool<'a> {
    /// The pool of series that show the same, with at least two images together.
    pub fn of(series: impl IntoIterator<Item = &'a Series>) -> Self {
        let groups: Vec<_> = series.into_iter().collect();
        let pixels = groups[0].runs[0].image.len();
        let mut sum = vec![[0.0; 3]; pixels];
        let mut weight = 0.0;
        for group in &groups {
            for run in &group.runs {
                weight += weight_of(group);
                for (sum, pixel) in sum.iter_mut().zip(&run.image) {
                    *sum = std::array::from_fn(|k| sum[k] + weight_of(group) * f64::from(pixel[k]));
                }
            }
        }
        Self {
            groups,
            sum,
            weight,
        }
    }

    /// The mean of all images.
    pub fn image(&self) -> Vec<[f32; 3]> {
        let mean = |pixel: &[f64; 3]| pixel.map(|c| (c / self.weight) as f32);
        self.sum.iter().map(mean).collect()
    }

    /// The mean of all images and pixels.
    pub fn mean(&self) -> [f64; 3] {
        let count = self.sum.len() as f64 * self.weight;
        let sum = self.sum.iter().fold([0.0; 3], |sum, pixel| {
            std::array::from_fn(|k| sum[k] + pixel[k])
        });
        sum.map(|c| c / count)
    }

    /// The relative mean squared error of each image of each series: that against the mean of all others, without what the
    /// noise of that mean adds to it. (That noise in the denominator is left: a mean with a relative error of 0.1 % overstates
    /// errors by 0.3 %.)
    pub fn errors(&self) -> Vec<Vec<f64>> {
        let measured: Vec<Vec<f64>> = self
            .groups
            .iter()
            .map(|group| {
                let against =
                    |image: &Vec<[f32; 3]>| relative_mse(&self.without(group, image), image);
                group.runs.iter().map(|run| against(&run.image)).collect()
            })
            .collect();
        let means: Vec<f64> = measured
            .iter()
            .map(|errors| errors.iter().sum::<f64>() / errors.len() as f64)
            .collect();
        // An image differs from the mean of the others by its own error and by theirs, each times its squared weight. Which
        // gives the groups' errors: by scaling, so that they stay positive.
        let mut errors = means.clone();
        for _ in 0..CORRECTIONS {
            let noise = self.reference_noise(&errors);
            for ((error, mean), noise) in errors.iter_mut().zip(&means).zip(noise) {
                let expected = *error + noise;
                if expected > 0.0 {
                    *error *= mean / expected;
                }
            }
        }
        let noise = self.reference_noise(&errors);
        let own = |(errors, noise): (Vec<f64>, f64)| errors.iter().map(|e| e - noise).collect();
        measured.into_iter().zip(noise).map(own).collect()
    }

    /// The mean of all images but one, of this series.
    fn without(&self, group: &Series, image: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let (own, rest) = (weight_of(group), self.weight - weight_of(group));
        let pixels = self.sum.iter().zip(image);
        pixels
            .map(|(sum, pixel)| {
                std::array::from_fn(|k| ((sum[k] - own * f64::from(pixel[k])) / rest) as f32)
            })
            .collect()
    }

    /// The error of the mean of all images but one of each group, if single images have these errors.
    fn reference_noise(&self, errors: &[f64]) -> Vec<f64> {
        let squared = |group: &Series| weight_of(group).powi(2);
        let groups = || self.groups.iter().zip(errors);
        let all: f64 = groups()
            .map(|(group, error)| group.runs.len() as f64 * squared(group) * error)
            .sum();
        groups()
            .map(|(group, error)| {
                (all - squared(group) * error) / (self.weight - weight_of(group)).powi(2)
            })
            .collect()
    }
}

fn weight_of(group: &Series) -> f64 {
    f64::from(group.samples)
}

#[cfg(test)]
mod tests {
    use super::super::contender::{Label, Run};
    use super::*;

    /// Numbers that are uniform in [−1, 1), by a linear congruential generator.
    struct Noise(u64);

    impl Noise {
        fn next(&mut self) -> f64 {
            self.0 = self
                .0
                .wrapping_mul(6364136223846793005)
                .wrapping_add(1442695040888963407);
            (self.0 >> 33) as f64 / f64::from(1_u32 << 30) - 1.0
        }
    }

    /// Images of a gradient with noise whose variance per pixel is `variance · truth² ÷ samples`.
    fn series(samples: u32, variance: f64, count: usize, noise: &mut Noise) -> Series {
        let amplitude = (3.0 * variance / f64::from(samples)).sqrt();
        let image = |noise: &mut Noise| {
            let value =
                |truth: f64, noise: &mut Noise| (truth * (1.0 + amplitude * noise.next())) as f32;
            (0..4000_u32)
                .map(|index| [0.5, 1.0, 2.0].map(|c| value(c + f64::from(index % 7), noise)))
                .collect()
        };
        let run = |_| Run {
            image: image(noise),
            cpu_s: 1.0,
        };
        Series {
            label: Label {
                renderer: String::new(),
                variant: String::new(),
                sampler: String::new(),
            },
            asked_for: samples,
            samples,
            runs: (0..count).map(run).collect(),
        }
    }

    /// The exact relative mean squared error for a variance relative to truth².
    fn expected(relative_variance: f64) -> f64 {
        let truths = || (0..7).flat_map(|k| [0.5, 1.0, 2.0].map(|c| c + f64::from(k)));
        let mean = truths().sum::<f64>() / 21.0;
        let of = |truth: f64| truth * truth / (truth * truth + 0.01 * mean * mean);
        relative_variance * truths().map(of).sum::<f64>() / 21.0
    }

    fn mean(values: &[f64]) -> f64 {
        values.iter().sum::<f64>() / values.len() as f64
    }

    /// Three images only: without the correction the error would be half as large again.
    #[test]
    fn the_noise_of_few_other_images_is_taken_off() {
        let mut noise = Noise(1);
        let few = series(16, 0.04, 3, &mut noise);
        let errors = Pool::of([&few]).errors();
        let ratio = mean(&errors[0]) / expected(0.04 / 16.0);
        assert!((ratio - 1.0).abs() < 0.04, "{ratio}");
    }

    /// Series of unlike quality share one reference, in which the worst has the most noise.
    #[test]
    fn errors_of_a_mixed_pool_are_those_of_their_series() {
        let mut noise = Noise(2);
        let [short, long, bad] = [(16, 0.04, 4), (256, 0.04, 3), (256, 0.4, 5)]
            .map(|(samples, variance, count)| series(samples, variance, count, &mut noise));
        let errors = Pool::of([&short, &long, &bad]).errors();
        for (errors, variance) in errors.iter().zip([0.04 / 16.0, 0.04 / 256.0, 0.4 / 256.0]) {
            let ratio = mean(errors) / expected(variance);
            assert!((ratio - 1.0).abs() < 0.05, "{variance}: {ratio}");
        }
    }

    #[test]
    fn the_mean_weighs_images_by_their_samples() {
        let constant = |samples: u32, value: f32| Series {
            runs: vec![Run {
                image: vec![[value, 2.0 * value, 0.0]; 2],
                cpu_s: 1.0,
            }],
            ..series(samples, 0.0, 0, &mut Noise(3))
        };
        let (few, many) = (constant(1, 5.0), constant(3, 1.0));
        let pool = Pool::of([&few, &many]);
        assert_eq!(pool.image(), [[2.0, 4.0, 0.0]; 2]);
        assert_eq!(pool.mean(), [2.0, 4.0, 0.0]);
        assert_eq!(Pool::of([&few, &few]).errors(), [[0.0], [0.0]]);
    }
}
