//! How often light samples go to each texel of an environment.

use std::f64::consts::PI;

use residual_render::alias_table::{self, AliasEntry};

use super::luminance::luminance;
use crate::desc::{ImageDesc, Texels};

/// A weight for each texel, row by row; they add up to more than 0 unless the image is black.
pub(super) struct EnvironmentWeights {
    width: usize,
    weights: Vec<f64>,
    /// Of all weights: images have millions.
    sum: f64,
}

impl EnvironmentWeights {
    /// The integral of luminance over each texel of the bilinear image, times the sine of the row's angle: the image
    /// convolved with (1, 6, 1)/8 along both axes.
    pub(super) fn of(image: &ImageDesc) -> Self {
        let (width, height) = (image.width as usize, image.height as usize);
        let Texels::RgbaF32(texels) = &image.texels else {
            unreachable!("environments are imported as floats")
        };
        let value = |x: usize, y: usize| {
            let t = texels[y * width + x];
            luminance([t[0], t[1], t[2]])
        };
        let mut weights = Vec::with_capacity(width * height);
        for y in 0..height {
            let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)];
            let sin = row_sine(y, height);
            for x in 0..width {
                let columns = [(x + width - 1) % width, x, (x + 1) % width];
                let row = |y: usize| {
                    (value(columns[0], y) + 6.0 * value(columns[1], y) + value(columns[2], y)) / 8.0
                };
                weights.push((row(rows[0]) + 6.0 * row(rows[1]) + row(rows[2])) / 8.0 * sin);
            }
        }
        let sum = weights.iter().sum();
        Self {
            width,
            weights,
            sum,
        }
    }

    /// Their mean.
    pub(super) fn mean(&self) -> f64 {
        self.sum / self.weights.len() as f64
    }

    /// The weights of samples that share their work with BSDF samples, which find the environment, too: of radiance what is above
    /// its mean over all directions, and 0 for the rest (Karlík, Šik, Vévoda, Skřivan and Křivánek 2019, "MIS Compensation: Optimizing Sampling
    /// Techniques in Multiple Importance Sampling"). An environment that is the same everywhere stays as it is.
    pub(super) fn compensated(mut self) -> Self {
        let width = self.width;
        let height = self.weights.len() / width;
        let sines: Vec<f64> = (0..height).map(|row| row_sine(row, height)).collect();
        let radiance = self.sum / (width as f64 * sines.iter().sum::<f64>());
        let excess = |weight: f64, sine: f64| (weight - radiance * sine).max(0.0);
        let rows = self.weights.chunks(width).zip(&sines);
        let sum: f64 = rows
            .flat_map(|(row, &sine)| row.iter().map(move |&weight| excess(weight, sine)))
            .sum();
        // What rounding leaves of an even environment says nothing.
        if sum <= 1e-6 * self.sum {
            return self;
        }
        for (row, &sine) in self.weights.chunks_mut(width).zip(&sines) {
            for weight in row {
                *weight = excess(*weight, sine);
            }
        }
        Self { sum, ..self }
    }

    /// The table by which texels are picked. Densities are over the unit square of image coordinates.
    pub(super) fn alias_entries(&self) -> impl ExactSizeIterator<Item = AliasEntry> {
        alias_table::alias_entries(&self.weights, self.mean())
    }
}

/// The sine of the angle between the middle of a row and +Y.
fn row_sine(row: usize, height: usize) -> f64 {
    (PI * (row as f64 + 0.5) / height as f64).sin()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grey image of as many rows as there are numbers, and two columns.
    fn rows(values: &[f32]) -> EnvironmentWeights {
        let texels = values.iter().flat_map(|&v| [[v, v, v, 1.0]; 2]);
        EnvironmentWeights::of(&ImageDesc {
            name: "sky".to_owned(),
            width: 2,
            height: values.len() as u32,
            texels: Texels::RgbaF32(texels.collect()),
        })
    }

    #[test]
    fn weights_are_integrals_over_solid_angles() {
        let weights = rows(&[1.0; 64]);
        // The mean of sin θ over all rows.
        assert!((weights.mean() - 2.0 / PI).abs() < 1e-3);
    }

    #[test]
    fn samples_go_where_radiance_is_above_its_mean() {
        let mut radiance = [1.0; 64];
        radiance[16..32].fill(5.0);
        let compensated = rows(&radiance).compensated();
        // A band from 45° to the horizon is 1/√8 of all directions.
        let mean = 1.0 + 4.0 / 8.0_f64.sqrt();
        for (row, weights) in compensated.weights.chunks(2).enumerate() {
            let expected = match row {
                // Next to the band the bilinear image is between the two.
                15 | 16 | 31 | 32 => continue,
                17..31 => (5.0 - mean) * row_sine(row, 64),
                _ => 0.0,
            };
            for weight in weights {
                assert!(
                    (weight - expected).abs() < 1e-3,
                    "{row}: {weight}, {expected}"
                );
            }
        }
    }

    #[test]
    fn what_is_the_same_everywhere_is_sampled_everywhere() {
        for radiance in [1.0, 0.1, 3.7e-5] {
            let even = rows(&[radiance; 37]);
            let before = even.weights.clone();
            assert_eq!(even.compensated().weights, before);
        }
    }
}
