//! Sums of samples in `f32`, beside those in `f64` that the film has (hard case S-01).

use std::hint::black_box;

use residual_frontend::process_time;
use serde_json::{Value, json};

/// What sums of a scene's own samples lose, and what it costs not to lose it.
#[derive(Clone, Debug, PartialEq)]
pub struct Sums {
    /// Number of samples, and the relative error of their sum in `f32`.
    pub errors: Vec<(u64, f64)>,
    /// Seconds that a sum in `f64` takes more than one in `f32`, for a sample of three channels; may be negative.
    pub seconds: f64,
}

/// Numbers of samples that are looked at, as powers of two.
const POWERS: [u32; 6] = [12, 16, 20, 22, 24, 26];

/// The number of samples that reports name.
pub const NAMED: u64 = 1 << 24;

/// How often sums are timed; the fastest counts.
const TIMED: usize = 5;

impl Sums {
    /// Adds these samples again and again, channel by channel. `None` if they are all black.
    pub fn of(samples: &[[f32; 3]]) -> Option<Self> {
        let most = 1_u64 << POWERS[POWERS.len() - 1];
        let (mut single, mut double) = ([0.0_f32; 3], [0.0_f64; 3]);
        let mut errors = Vec::new();
        for (count, sample) in (1..=most).zip(samples.iter().cycle()) {
            for k in 0..3 {
                single[k] += sample[k];
                double[k] += f64::from(sample[k]);
            }
            if count.is_power_of_two() && POWERS.contains(&count.trailing_zeros()) {
                let total: f64 = double.iter().sum();
                let off: f64 = (0..3)
                    .map(|k| (f64::from(single[k]) - double[k]).abs())
                    .sum();
                errors.push((count, off / total));
            }
        }
        let seconds = fastest(|| {
            let mut sum = [0.0_f64; 3];
            for sample in samples {
                (0..3).for_each(|k| sum[k] += f64::from(black_box(sample[k])));
            }
            black_box(sum);
        }) - fastest(|| {
            let mut sum = [0.0_f32; 3];
            for sample in samples {
                (0..3).for_each(|k| sum[k] += black_box(sample[k]));
            }
            black_box(sum);
        });
        errors
            .iter()
            .all(|(_, error)| error.is_finite())
            .then(|| Self {
                errors,
                seconds: seconds / samples.len() as f64,
            })
    }

    /// The relative error after [`NAMED`] samples.
    pub fn named_error(&self) -> f64 {
        let named = self.errors.iter().find(|(count, _)| *count == NAMED);
        named.map_or(f64::NAN, |(_, error)| *error)
    }

    /// As JSON.
    pub fn to_json(&self) -> Value {
        json!({ "errors": self.errors, "seconds": self.seconds })
    }

    /// What [`Sums::to_json`] wrote.
    pub fn from_json(value: &Value) -> Option<Self> {
        let errors = value["errors"].as_array()?.iter();
        Some(Self {
            errors: errors
                .map(|row| Some((row[0].as_u64()?, row[1].as_f64()?)))
                .collect::<Option<_>>()?,
            seconds: value["seconds"].as_f64()?,
        })
    }
}

fn fastest(mut what: impl FnMut()) -> f64 {
    let time = |_| {
        let before = process_time();
        what();
        (process_time() - before).as_secs_f64()
    };
    (0..TIMED).map(time).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ones can be added up to 2²⁴, then the sum stands still.
    #[test]
    fn sums_of_ones_stop_where_f32_does() {
        let sums = Sums::of(&[[1.0; 3]; 1000]).unwrap();
        assert_eq!(sums.named_error(), 0.0);
        assert_eq!(sums.errors.last(), Some(&(1 << 26, 0.75)));
        assert_eq!(Sums::from_json(&sums.to_json()), Some(sums));
        assert_eq!(Sums::of(&[[0.0; 3]; 10]), None);
    }
}
