//! The image that others are compared with: converged, with its own noise known, and made in more than one way.
//!
//! Each [`Strategy`] renders the scene several times, with seeds that nothing else has. The spread over seeds is the noise of their
//! mean, whatever the points (hard case S-10 is why not the spread of samples). Strategies must agree within that noise; then
//! their means are averaged.

use std::path::Path;

use anyhow::Result;
use residual_accuracy::comparison::{Image, Pair, ZScores};
use residual_device_cpu::CpuDevice;
use residual_frontend::input;
use residual_frontend::pictures::{self, Picture};
use residual_render::sampler::AnySampler;
use residual_render::tracer::AnyMis;
use serde_json::{Value, json};

use crate::configuration::Setup;
use crate::prepared::Prepared;

/// A way to get at the same image.
#[derive(Clone, Copy, Debug)]
pub struct Strategy {
    /// Its name.
    pub name: &'static str,
    /// What it changes of the baseline.
    pub change: fn(&mut Setup),
}

/// All of them.
pub const STRATEGIES: &[Strategy] = &[
    Strategy {
        name: "Sobol points, lights sampled and found",
        change: |setup| setup.plan.sampler = AnySampler::Sobol,
    },
    Strategy {
        name: "independent points, lights sampled only",
        change: |setup| {
            setup.plan.sampler = AnySampler::Independent;
            setup.mis(AnyMis::LightsOnly);
        },
    },
];

/// The first seed of a reference: far from those of measured runs.
const FIRST_SEED: u32 = 1 << 20;

/// Paths of references end by roulette, not by their length.
pub const REFERENCE_DEPTH: u32 = 1000;

/// Strategies whose largest difference over blocks of pixels would be as large by chance less often than this disagree.
const LEAST_PROBABILITY: f64 = 1e-3;

/// How a reference is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReferenceOptions {
    /// Seeds of each strategy, at least two.
    pub seeds: u32,
    /// Samples a pixel of each seed.
    pub samples: u32,
}

/// A converged image.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Width and height in pixels.
    pub size: [usize; 2],
    /// Linear red, green and blue, row by row.
    pub image: Vec<[f32; 3]>,
    /// Standard errors of these numbers, the roots of the variance of the mean.
    pub standard_errors: Vec<[f32; 3]>,
    /// Samples of a pixel, of all strategies and seeds.
    pub samples: u64,
    /// All seeds.
    pub seeds: Vec<u32>,
    /// How far strategies are from each other.
    pub agreements: Vec<Agreement>,
}

/// The difference between two strategies.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// Their names.
    pub between: [String; 2],
    /// Mean square of the differences over blocks of pixels, in units of their noise: about 1 if the strategies agree.
    pub mean_square: f64,
    /// The probability that the largest of these differences is so large by chance.
    pub probability: f64,
}

impl Agreement {
    /// Whether the difference may be noise.
    pub fn holds(&self) -> bool {
        self.probability >= LEAST_PROBABILITY
    }
}

/// Mean over the seeds of a strategy, and its variance.
struct Replicates {
    mean: Vec<[f64; 3]>,
    variance: Vec<[f64; 3]>,
}

impl Replicates {
    fn render(
        prepared: &Prepared,
        device: &CpuDevice,
        seeds: impl ExactSizeIterator<Item = u32>,
        samples: u32,
        mut rendered: impl FnMut(),
    ) -> Self {
        let count = seeds.len() as f64;
        let (mut mean, mut deviations): (Vec<[f64; 3]>, Vec<[f64; 3]>) = Default::default();
        for (index, seed) in seeds.enumerate() {
            prepared.render(device, seed, &[samples], |so_far| {
                let image = so_far.film.image();
                mean.resize(image.len(), [0.0; 3]);
                deviations.resize(image.len(), [0.0; 3]);
                let after = index as f64 + 1.0;
                for ((pixel, mean), deviation) in image.iter().zip(&mut mean).zip(&mut deviations) {
                    for k in 0..3 {
                        let delta = f64::from(pixel[k]) - mean[k];
                        mean[k] += delta / after;
                        deviation[k] += delta * delta * (after - 1.0) / after;
                    }
                }
            });
            rendered();
        }
        let variance = |d: &[f64; 3]| d.map(|d| d / (count - 1.0) / count);
        Self {
            variance: deviations.iter().map(variance).collect(),
            mean,
        }
    }

    /// Sum of all variances.
    fn noise(&self) -> f64 {
        self.variance.as_flattened().iter().sum()
    }
}

fn single(numbers: &[[f64; 3]]) -> Vec<[f32; 3]> {
    numbers.iter().map(|rgb| rgb.map(|x| x as f32)).collect()
}

fn roots(numbers: &[[f64; 3]]) -> Vec<[f32; 3]> {
    numbers
        .iter()
        .map(|rgb| rgb.map(|x| x.sqrt() as f32))
        .collect()
}

impl Reference {
    /// Renders it with these strategies. `rendered` is called after each seed of each.
    ///
    /// # Panics
    /// Without strategies, or with fewer than two seeds.
    pub fn render(
        strategies: &[(&str, &Prepared)],
        device: &CpuDevice,
        size: [u32; 2],
        options: ReferenceOptions,
        mut rendered: impl FnMut(),
    ) -> Self {
        assert!(!strategies.is_empty() && options.seeds >= 2);
        let size = size.map(|length| length as usize);
        let mut seeds = Vec::new();
        let parts: Vec<(&str, Replicates)> = strategies
            .iter()
            .zip(0_u32..)
            .map(|((name, prepared), index)| {
                let first = FIRST_SEED + index * options.seeds;
                let own = first..first + options.seeds;
                seeds.extend(own.clone());
                let replicates =
                    Replicates::render(prepared, device, own, options.samples, &mut rendered);
                (*name, replicates)
            })
            .collect();
        // The less noisy strategy counts more; by one weight for the whole image, which no pixel's own noise decides.
        let weights: Vec<f64> = parts
            .iter()
            .map(|(_, part)| 1.0 / part.noise().max(f64::MIN_POSITIVE))
            .collect();
        let total: f64 = weights.iter().sum();
        let mut mean = vec![[0.0; 3]; size[0] * size[1]];
        let mut variance = mean.clone();
        for ((_, part), weight) in parts.iter().zip(&weights) {
            let share = weight / total;
            for (to, from) in mean.iter_mut().zip(&part.mean) {
                *to = std::array::from_fn(|k| to[k] + share * from[k]);
            }
            for (to, from) in variance.iter_mut().zip(&part.variance) {
                *to = std::array::from_fn(|k| to[k] + share * share * from[k]);
            }
        }
        Self {
            size,
            image: single(&mean),
            standard_errors: roots(&variance),
            samples: u64::from(options.samples) * seeds.len() as u64,
            seeds,
            agreements: agreements(&parts, size),
        }
    }

    /// The image with its noise.
    pub fn as_image(&self) -> Image<'_> {
        Image::new(&self.image, self.size[0]).with_standard_errors(&self.standard_errors)
    }

    /// Whether all strategies agree.
    pub fn is_trusted(&self) -> bool {
        self.agreements.iter().all(Agreement::holds)
    }

    /// Writes it as an EXR, with what it is, under this key.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn store(&self, path: &Path, key: &str) -> Result<()> {
        let channel =
            |of: &[[f32; 3]], k: usize| -> Vec<f32> { of.iter().map(|rgb| rgb[k]).collect() };
        let (image, errors) = (&self.image, &self.standard_errors);
        let agreements: Vec<_> = self
            .agreements
            .iter()
            .map(|a| json!([a.between[0], a.between[1], a.mean_square, a.probability]))
            .collect();
        let comment = json!({
            "reference": key,
            "samples": self.samples,
            "seeds": self.seeds,
            "agreements": agreements,
        });
        let picture = Picture {
            size: self.size,
            colors: Vec::new(),
            channels: vec![
                ("R", channel(image, 0)),
                ("G", channel(image, 1)),
                ("B", channel(image, 2)),
                ("standard_error.R", channel(errors, 0)),
                ("standard_error.G", channel(errors, 1)),
                ("standard_error.B", channel(errors, 2)),
            ],
            comment: Some(comment.to_string()),
        };
        pictures::write(path, &picture)
    }

    /// Reads what [`Reference::store`] wrote; `None` if there is no such file, or one with another key.
    ///
    /// # Errors
    /// If there is a file of that name that cannot be read.
    pub fn load(path: &Path, key: &str) -> Result<Option<Self>> {
        if !path.exists() {
            return Ok(None);
        }
        let read = input::read(path)?;
        let parsed = || -> Option<Self> {
            let comment: Value = serde_json::from_str(&read.comment?).ok()?;
            if comment["reference"].as_str()? != key {
                return None;
            }
            let seeds = comment["seeds"].as_array()?.iter();
            let agreements = comment["agreements"].as_array()?.iter().map(|a| {
                let name = |k: usize| Some(a[k].as_str()?.to_owned());
                Some(Agreement {
                    between: [name(0)?, name(1)?],
                    mean_square: a[2].as_f64()?,
                    probability: a[3].as_f64()?,
                })
            });
            Some(Self {
                size: read.size,
                image: read.pixels,
                standard_errors: read.standard_errors?,
                samples: comment["samples"].as_u64()?,
                seeds: seeds
                    .map(|s| s.as_u64().map(|s| s as u32))
                    .collect::<Option<_>>()?,
                agreements: agreements.collect::<Option<_>>()?,
            })
        };
        Ok(parsed())
    }
}

/// Each pair of strategies.
fn agreements(parts: &[(&str, Replicates)], size: [usize; 2]) -> Vec<Agreement> {
    let images: Vec<_> = parts
        .iter()
        .map(|(name, part)| (*name, single(&part.mean), roots(&part.variance)))
        .collect();
    let mut agreements = Vec::new();
    for (index, (second, mean, errors)) in images.iter().enumerate() {
        for (first, other_mean, other_errors) in &images[..index] {
            let image = Image::new(mean, size[0]).with_standard_errors(errors);
            let other = Image::new(other_mean, size[0]).with_standard_errors(other_errors);
            let pair = Pair::new(other, image).expect("finite images of one size");
            let scores = ZScores::of(&pair).expect("standard errors are there");
            agreements.push(Agreement {
                between: [(*first).to_owned(), (*second).to_owned()],
                mean_square: scores.blocks.mean_square,
                probability: scores.blocks.largest.map_or(1.0, |block| block.probability),
            });
        }
    }
    agreements
}

#[cfg(test)]
mod tests {
    use super::*;

    fn reference() -> Reference {
        Reference {
            size: [2, 1],
            image: vec![[1.0, 2.0, 3.0], [0.5, 0.25, 0.0]],
            standard_errors: vec![[0.1, 0.2, 0.3], [0.0, 0.0, 1e-9]],
            samples: 4096,
            seeds: vec![7, 8],
            agreements: vec![Agreement {
                between: ["a".to_owned(), "b".to_owned()],
                mean_square: 1.25,
                probability: 0.125,
            }],
        }
    }

    #[test]
    fn references_read_back_under_their_key_only() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("reference.exr");
        assert_eq!(Reference::load(&path, "k").unwrap(), None);
        reference().store(&path, "k").unwrap();
        assert_eq!(Reference::load(&path, "k").unwrap(), Some(reference()));
        assert_eq!(Reference::load(&path, "other").unwrap(), None);
        std::fs::write(&path, "no image").unwrap();
        assert!(Reference::load(&path, "k").is_err());
    }

    /// Strategies that differ by a hundredth, with a noise of a thousandth, do not agree; with the same mean they do.
    #[test]
    fn a_biased_strategy_is_found_out() {
        let part = |mean: f64| Replicates {
            mean: (0..64 * 64)
                .map(|k| [mean + 1e-3 * (f64::from(k) * 1.3).sin(); 3])
                .collect(),
            variance: vec![[5e-7; 3]; 64 * 64],
        };
        let same = agreements(&[("a", part(1.0)), ("b", part(1.0))], [64, 64]);
        assert!(same[0].holds(), "{same:?}");
        let other = agreements(&[("a", part(1.0)), ("b", part(1.01))], [64, 64]);
        assert!(!other[0].holds() && other[0].between == ["a", "b"]);
    }
}
