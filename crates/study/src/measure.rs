//! One measured run: a configuration, a seed, and what was reached after each number of samples.

use anyhow::{Context, Result};
use residual_accuracy::comparison::{Image, Pair, SquaredError};
use residual_accuracy::sweep::Measurement;
use residual_device_cpu::CpuDevice;
use serde_json::{Value, json};

use crate::prepared::Prepared;
use crate::reference::Reference;

/// A run, with its last image.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// After each number of samples.
    pub measured: Vec<Measurement>,
    /// The image at the end.
    pub image: Vec<[f32; 3]>,
}

/// Relative mean squared error of an image, without the noise of the reference.
///
/// # Errors
/// If pixels are not finite.
pub fn error(reference: &Reference, image: &[[f32; 3]]) -> Result<f64> {
    let pair = Pair::new(reference.as_image(), Image::new(image, reference.size[0]))?;
    let error = SquaredError::relmse(&pair).without_reference_noise();
    Ok(error.expect("references have standard errors"))
}

/// Renders with this seed and looks at the error after each of these numbers of samples.
///
/// # Errors
/// If pixels are not finite.
pub fn run(
    prepared: &Prepared,
    device: &CpuDevice,
    seed: u32,
    counts: &[u32],
    reference: &Reference,
) -> Result<Run> {
    let (mut measured, mut image) = (Vec::new(), Vec::new());
    let mut failed = None;
    prepared.render(device, seed, counts, |so_far| {
        image = so_far.film.image();
        match error(reference, &image) {
            Ok(error) => measured.push(Measurement {
                samples: u64::from(so_far.samples),
                seconds: so_far.seconds,
                error,
            }),
            Err(error) => failed = Some(error),
        }
    });
    match failed {
        Some(error) => Err(error).with_context(|| format!("the image of seed {seed}")),
        None => Ok(Run { measured, image }),
    }
}

/// Measurements as JSON: samples, seconds and error of each.
pub fn to_json(measured: &[Measurement]) -> Value {
    let row = |m: &Measurement| json!([m.samples, m.seconds, m.error]);
    measured.iter().map(row).collect()
}

/// What [`to_json`] wrote.
pub fn from_json(value: &Value) -> Option<Vec<Measurement>> {
    let rows = value.as_array()?.iter().map(|row| {
        Some(Measurement {
            samples: row[0].as_u64()?,
            seconds: row[1].as_f64()?,
            error: row[2].as_f64()?,
        })
    });
    rows.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn measurements_read_back() {
        let measured = vec![Measurement {
            samples: 64,
            seconds: 0.123456789,
            error: -1.5e-9,
        }];
        assert_eq!(from_json(&to_json(&measured)), Some(measured));
        assert_eq!(from_json(&json!([[1, 2]])), None);
    }
}
