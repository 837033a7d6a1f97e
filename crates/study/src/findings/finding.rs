//! What the measurements say of one configuration.

use anyhow::Result;
use residual_accuracy::comparison::{Image, Pair};
use residual_accuracy::sweep::{ErrorCurve, Measurement, Series, squared_bias};
use residual_accuracy::{Estimate, Interval, Jackknifed};

use super::level::Level;
use super::measured::{Measured, last};
use crate::configuration::Configuration;
use crate::reference::Reference;

/// 1 %, as a relative mean squared error.
pub const ONE_PERCENT: f64 = 1e-4;

/// What is known of a configuration.
#[derive(Clone, Debug)]
pub struct Finding {
    /// The configuration.
    pub configuration: &'static Configuration,
    /// Its runs.
    pub series: Series,
    /// Relative squared bias.
    pub bias: Jackknifed,
    /// The floor of its error: the squared bias where that is certain, else 0. Where the limit is the baseline's by construction, it is
    /// the baseline's: else some would seem to have none because they are noisier.
    pub floor: f64,
    /// Power of the number of samples with which the error falls.
    pub slope: Option<Jackknifed>,
    /// Error over CPU seconds.
    pub curve: Option<ErrorCurve>,
    /// CPU seconds to 1 % error, with an interval that knows how uncertain the floor is, too: its upper end is infinite if the bias may be
    /// above 1 %.
    pub to_one_percent: Option<Interval>,
    /// CPU seconds ÷ the baseline's at as many samples.
    pub time: Estimate,
    /// The baseline's error × time ÷ its own, at as many samples: how much faster it gets to the same error while noise prevails.
    pub efficiency: Estimate,
}

impl Finding {
    /// The root of the squared bias if that is certain, else what it is below, with 97.5 % confidence.
    pub fn relative_bias(&self) -> Level {
        Level::of_square(self.bias)
    }
}

/// The relative squared bias of the runs.
pub(super) fn bias(measured: &Measured, reference: &Reference) -> Result<Jackknifed> {
    let width = reference.size[0];
    let pairs = measured
        .images
        .iter()
        .map(|image| Pair::new(reference.as_image(), Image::new(image, width)))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(squared_bias(&pairs)?)
}

/// A squared bias where it is certain, else 0.
fn floor(bias: Jackknifed) -> f64 {
    if bias.value > bias.ci95 {
        bias.value
    } else {
        0.0
    }
}

/// Seconds to an error, where the floor is as uncertain as this squared bias.
fn time_to(error: f64, series: &Series, bias: Jackknifed) -> Option<Interval> {
    let Jackknifed { value, ci95 } = bias;
    let middle = series.time_to(error, floor(bias))?;
    let end = |floor: f64| series.time_to(error, floor.max(0.0));
    Some(Interval {
        value: middle.value,
        low: end(value - ci95).map_or(middle.low, |end| end.low.min(middle.low)),
        high: end(value + ci95).map_or(f64::INFINITY, |end| end.high.max(middle.high)),
    })
}

pub(super) fn finding(
    measured: &Measured,
    baseline: &Measured,
    reference: &Reference,
    shared_bias: Jackknifed,
) -> Result<Finding> {
    let series = Series::new(measured.runs.clone())?;
    let bias = bias(measured, reference)?;
    let limit = if measured.configuration.axis.keeps_limit() {
        shared_bias
    } else {
        bias
    };
    let floor = floor(limit);
    let ratios = |of: &dyn Fn(&Measurement) -> f64| {
        let runs = measured.runs.iter().zip(&baseline.runs);
        Estimate::of(
            runs.map(|(run, base)| of(last(run)) / of(last(base)))
                .collect(),
        )
    };
    let efficiency = {
        let cost = |m: &Measurement| m.seconds * m.error;
        let runs = measured.runs.iter().zip(&baseline.runs);
        Estimate::of(
            runs.map(|(run, base)| cost(last(base)) / cost(last(run)))
                .collect(),
        )
    };
    Ok(Finding {
        configuration: measured.configuration,
        slope: series.slope(floor),
        curve: series.curve(floor),
        to_one_percent: time_to(ONE_PERCENT, &series, limit),
        time: ratios(&|m| m.seconds),
        efficiency,
        series,
        bias,
        floor,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Runs whose error is 1 / N above this floor, 1 s a sample.
    fn series(floor: f64) -> Series {
        let run = |seed: u32| {
            let one = |k: u32| {
                let samples = 1_u64 << k;
                let luck = 1.0 + 0.01 * f64::from(seed);
                Measurement {
                    samples,
                    seconds: samples as f64,
                    error: floor + luck / samples as f64,
                }
            };
            (0..8).map(one).collect()
        };
        Series::new((0..6).map(run).collect()).unwrap()
    }

    #[test]
    fn times_know_how_uncertain_the_floor_is() {
        let of = |value, ci95| time_to(0.01, &series(0.005), Jackknifed { value, ci95 });
        let certain = of(0.005, 1e-6).unwrap();
        assert!(
            certain.low < 204.0 && 204.0 < certain.high && certain.high < 220.0,
            "{certain:?}"
        );
        let uncertain = of(0.005, 0.004).unwrap();
        assert!(uncertain.low < 0.8 * certain.low && uncertain.high > 2.0 * certain.high);
        assert_eq!(of(0.005, 0.0049).unwrap().value, certain.value);
        assert_eq!(of(0.0055, 0.005).unwrap().high, f64::INFINITY);
        assert_eq!(of(0.02, 0.001), None);
    }
}
