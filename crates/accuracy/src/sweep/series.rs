//! Runs of one configuration.

use super::error_curve::ErrorCurve;
use crate::error_estimate::Interval;
use crate::estimate::Estimate;
use crate::jackknife::Jackknifed;

/// What a run had reached after some of its samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Samples so far.
    pub samples: u64,
    /// Seconds so far.
    pub seconds: f64,
    /// Mean squared error, relative or not, without the noise of the reference. So it may be slightly negative.
    pub error: f64,
}

/// Runs of one configuration with different seeds, all looked at after the same numbers of samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    runs: Vec<Vec<Measurement>>,
}

/// Runs that were not looked at after the same numbers of samples, or no runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the runs of a series are looked at after the same ascending numbers of samples")]
pub struct UnequalRuns;

/// All runs after one number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Samples.
    pub samples: u64,
    /// Seconds.
    pub seconds: Estimate,
    /// Mean squared error.
    pub error: Estimate,
}

impl Series {
    /// Runs, one for each seed.
    ///
    /// # Errors
    /// If there are none, or they were looked at after different numbers of samples, or these do not ascend.
    pub fn new(runs: Vec<Vec<Measurement>>) -> Result<Self, UnequalRuns> {
        let samples = |run: &[Measurement]| -> Vec<u64> { run.iter().map(|m| m.samples).collect() };
        let first = samples(runs.first().ok_or(UnequalRuns)?);
        let equal = runs.iter().all(|run| samples(run) == first);
        let ascending = !first.is_empty() && first.is_sorted_by(|a, b| a < b);
        if equal && ascending {
            Ok(Self { runs })
        } else {
            Err(UnequalRuns)
        }
    }

    /// The runs.
    pub fn runs(&self) -> &[Vec<Measurement>] {
        &self.runs
    }

    /// Medians after each number of samples.
    pub fn levels(&self) -> Vec<Level> {
        let level = |(index, first): (usize, &Measurement)| {
            let of = |value: &dyn Fn(&Measurement) -> f64| {
                Estimate::of(self.runs.iter().map(|run| value(&run[index])).collect())
            };
            Level {
                samples: first.samples,
                seconds: of(&|m| m.seconds),
                error: of(&|m| m.error),
            }
        };
        self.runs[0].iter().enumerate().map(level).collect()
    }

    /// Error over seconds, with this floor: the fit to the means of the runs.
    pub fn curve(&self, floor: f64) -> Option<ErrorCurve> {
        ErrorCurve::with_floor(&self.means(&|_| true, &|m| m.seconds), floor)
    }

    /// The power of the number of samples with which the error above the floor falls. Seeds are what is independent, so the
    /// interval is the jackknife's over them; samples of one run are not. `None` if nothing is above the floor.
    pub fn slope(&self, floor: f64) -> Option<Jackknifed> {
        let power = |used: &dyn Fn(usize) -> bool| {
            let points = self.means(used, &|m| m.samples as f64);
            ErrorCurve::with_floor(&points, floor).map_or(f64::NAN, |curve| curve.power)
        };
        finite(Jackknifed::of(self.runs.len(), power))
    }

    /// Seconds to an error, between the measured ones or beyond, as the fit says; with the interval of the jackknife over seeds.
    /// `None` if the floor is not below the error, or the error does not fall.
    pub fn time_to(&self, error: f64, floor: f64) -> Option<Interval> {
        let logarithm = |used: &dyn Fn(usize) -> bool| {
            let points = self.means(used, &|m| m.seconds);
            let curve = ErrorCurve::with_floor(&points, floor);
            let seconds = curve.and_then(|curve| curve.reaches(error));
            seconds.map_or(f64::NAN, f64::ln)
        };
        let Jackknifed { value, ci95 } = finite(Jackknifed::of(self.runs.len(), logarithm))?;
        Some(Interval {
            value: value.exp(),
            low: (value - ci95).exp(),
            high: (value + ci95).exp(),
        })
    }

    /// Means of x and of the error over some of the runs.
    fn means(
        &self,
        used: &dyn Fn(usize) -> bool,
        x: &dyn Fn(&Measurement) -> f64,
    ) -> Vec<[f64; 2]> {
        let runs = || (0..self.runs.len()).filter(|run| used(*run));
        let count = runs().count() as f64;
        let mean = |index: usize, of: &dyn Fn(&Measurement) -> f64| {
            runs().map(|run| of(&self.runs[run][index])).sum::<f64>() / count
        };
        (0..self.runs[0].len())
            .map(|index| [mean(index, x), mean(index, &|m| m.error)])
            .collect()
    }
}

/// What could be computed of all runs and of all but each.
fn finite(number: Jackknifed) -> Option<Jackknifed> {
    (number.value.is_finite() && !number.ci95.is_nan()).then_some(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seeds whose errors vary by a tenth, and never in the same way.
    fn series(seeds: u32, floor: f64, power: f64) -> Series {
        let run = |seed: u32| {
            let measured = |k: u32| {
                let samples = 1_u64 << k;
                let luck = 1.0 + 0.1 * (f64::from(seed * 12 + k) * 1.7).sin();
                Measurement {
                    samples,
                    seconds: 0.02 * samples as f64,
                    error: floor + luck * (samples as f64).powf(power),
                }
            };
            (0..8).map(measured).collect()
        };
        Series::new((0..seeds).map(run).collect()).unwrap()
    }

    #[test]
    fn slopes_and_times_have_intervals_that_hold_the_truth() {
        for (floor, power) in [(0.0, -1.0), (1e-3, -1.3)] {
            let series = series(16, floor, power);
            let slope = series.slope(floor).unwrap();
            assert!((slope.value - power).abs() < slope.ci95, "{slope:?}");
            assert!(slope.ci95 < 0.05);
            let truth = 0.02 * 1e-4_f64.powf(1.0 / power);
            let time = series.time_to(floor + 1e-4, floor).unwrap();
            assert!(
                time.low < truth && truth < time.high,
                "{time:?}, not {truth}"
            );
            assert!(time.high / time.low < 1.5);
        }
    }

    #[test]
    fn no_time_is_enough_for_an_error_below_the_bias() {
        assert_eq!(series(8, 0.1, -1.0).time_to(0.05, 0.1), None);
    }

    #[test]
    fn levels_are_medians() {
        let levels = series(9, 0.0, -1.0).levels();
        assert_eq!(levels.len(), 8);
        assert_eq!((levels[3].samples, levels[3].seconds.median), (8, 0.16));
        assert!((levels[3].error.median * 8.0 - 1.0).abs() < 0.1);
    }

    #[test]
    fn unequal_runs_are_refused() {
        let one = |samples| Measurement {
            samples,
            seconds: 1.0,
            error: 1.0,
        };
        assert!(Series::new(vec![]).is_err());
        assert!(Series::new(vec![vec![]]).is_err());
        assert!(Series::new(vec![vec![one(1)], vec![one(2)]]).is_err());
        assert!(Series::new(vec![vec![one(2), one(1)]]).is_err());
        assert!(Series::new(vec![vec![one(1), one(2)]]).is_ok());
    }
}
