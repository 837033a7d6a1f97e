//! What the measurements of a study say.

use anyhow::Result;
use residual_accuracy::comparison::{Image, Pair};
use residual_accuracy::sweep::{
    ErrorCurve, FailureRate, Measurement, Series, knee, pareto_front, squared_bias,
};
use residual_accuracy::{Estimate, Interval, Jackknifed};

use crate::configuration::{Configuration, Removes, SWITCHES, Switch, Tier, TraversalPrecision};
use crate::probe::sums::Sums;
use crate::reference::Reference;

/// 1 %, as a relative mean squared error.
pub const ONE_PERCENT: f64 = 1e-4;

/// Points of the front err less by this part than all that are faster: configurations with the same images differ in time only.
const LEAST_GAIN: f64 = 0.01;

/// All that was measured.
#[derive(Clone, Debug)]
pub struct Study {
    /// Name of the scene.
    pub scene: String,
    /// Its triangles.
    pub triangles: usize,
    /// Threads of the measured runs.
    pub threads: usize,
    /// How renderers were made, but where that was switched.
    pub tier: Tier,
    /// Seeds of the measured runs.
    pub seeds: Vec<u32>,
    /// What errors are relative to.
    pub reference: Reference,
    /// All runs, by configuration; the baseline first.
    pub measured: Vec<Measured>,
    /// Rays that passed between triangles; empty if no triangles share an edge.
    pub misses: Vec<(TraversalPrecision, FailureRate)>,
    /// Sums in `f32`; none if the middle of the image is black.
    pub sums: Option<Sums>,
    /// Images after the same time.
    pub crops: Vec<Crop>,
    /// Where and of what.
    pub provenance: Provenance,
}

/// The runs of a configuration.
#[derive(Clone, Debug)]
pub struct Measured {
    /// The configuration.
    pub configuration: &'static Configuration,
    /// By seed, what was reached after each number of samples.
    pub runs: Vec<Vec<Measurement>>,
    /// By seed, the image after all samples.
    pub images: Vec<Vec<[f32; 3]>>,
}

impl Measured {
    /// No runs yet.
    pub fn none(configuration: &'static Configuration) -> Self {
        Self {
            configuration,
            runs: Vec::new(),
            images: Vec::new(),
        }
    }

    /// Seconds of each run until its end.
    fn seconds(&self) -> impl Iterator<Item = f64> {
        self.runs.iter().map(|run| last(run).seconds)
    }
}

fn last(run: &[Measurement]) -> &Measurement {
    run.last().expect("runs were looked at")
}

/// An image, and the time that it took.
#[derive(Clone, Debug)]
pub struct Crop {
    /// The configuration.
    pub configuration: &'static Configuration,
    /// Samples a pixel.
    pub samples: u32,
    /// CPU seconds.
    pub seconds: f64,
    /// Relative mean squared error.
    pub error: f64,
    /// The whole image.
    pub image: Vec<[f32; 3]>,
}

/// Where and of what numbers were measured.
#[derive(Clone, Debug)]
pub struct Provenance {
    /// Machines.
    pub machines: Vec<String>,
    /// Commits.
    pub commits: Vec<String>,
}

/// Samples of each configuration that take as long as a quarter of the baseline's.
pub fn equal_time_samples(measured: &[Measured]) -> Vec<u32> {
    let pace = |measured: &Measured| {
        let samples = last(&measured.runs[0]).samples as f64;
        Estimate::of(measured.seconds().collect()).median / samples
    };
    let time = 0.25 * last(&measured[0].runs[0]).samples as f64 * pace(&measured[0]);
    let samples = measured.iter().map(|m| (time / pace(m)).round().max(1.0));
    samples.map(|samples| samples as u32).collect()
}

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

/// A number that may be too small to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// With its interval.
    Seen {
        /// The number.
        value: f64,
        /// Lower and upper end.
        interval: [f64; 2],
    },
    /// It is below this one.
    Below(f64),
}

impl Level {
    fn of_square(square: Jackknifed) -> Self {
        let Jackknifed { value, ci95 } = square;
        if value > ci95 {
            Self::Seen {
                value: value.sqrt(),
                interval: [value - ci95, value + ci95].map(f64::sqrt),
            }
        } else {
            Self::Below((value + ci95).max(0.0).sqrt())
        }
    }

    fn of_rate(rate: FailureRate) -> Self {
        match rate.failures {
            0 => Self::Below(rate.interval()[1]),
            _ => Self::Seen {
                value: rate.rate(),
                interval: rate.interval(),
            },
        }
    }
}

/// A switch between time and truth, with its price and what that buys.
#[derive(Clone, Debug)]
pub struct Rung {
    /// The switch.
    pub switch: &'static Switch,
    /// Time with it ÷ time without it − 1; none where it costs nothing that could be measured.
    pub time: Estimate,
    /// What is wrong without it.
    pub without: Level,
    /// What is wrong with it.
    pub with: Level,
}

/// What a study says.
#[derive(Clone, Debug)]
pub struct Findings {
    /// Of each configuration; the baseline first.
    pub configurations: Vec<Finding>,
    /// What each accuracy switch costs, and what it removes.
    pub ladder: Vec<Rung>,
    /// Median time and error of each configuration after each number of samples.
    pub points: Vec<Point>,
    /// Indices of the points that no other beats.
    pub front: Vec<usize>,
    /// The point after which time buys less.
    pub knee: Option<usize>,
}

/// A configuration after a number of samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Index of the configuration.
    pub configuration: usize,
    /// Samples a pixel.
    pub samples: u64,
    /// CPU seconds.
    pub seconds: f64,
    /// Relative mean squared error.
    pub error: f64,
}

impl Findings {
    /// What the measurements say.
    ///
    /// # Errors
    /// If runs do not fit each other, or images are not finite.
    pub fn of(study: &Study) -> Result<Self> {
        let baseline = &study.measured[0];
        let shared_bias = bias(baseline, &study.reference)?;
        let configurations = study
            .measured
            .iter()
            .map(|measured| finding(measured, baseline, &study.reference, shared_bias))
            .collect::<Result<Vec<_>>>()?;
        let points = points(&configurations);
        let places: Vec<[f64; 2]> = points.iter().map(|p| [p.seconds, p.error]).collect();
        let front = pareto_front(&places, LEAST_GAIN);
        Ok(Self {
            ladder: ladder(study, &configurations),
            knee: knee(&places, &front),
            configurations,
            points,
            front,
        })
    }
}

/// The relative squared bias of the runs.
fn bias(measured: &Measured, reference: &Reference) -> Result<Jackknifed> {
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

fn finding(
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

/// Points with an error above 0: below, the noise of the reference is all that is left.
fn points(configurations: &[Finding]) -> Vec<Point> {
    let of = |(configuration, finding): (usize, &Finding)| {
        let levels = finding.series.levels().into_iter();
        let points = levels.map(move |level| Point {
            configuration,
            samples: level.samples,
            seconds: level.seconds.median,
            error: level.error.median,
        });
        points.filter(|point| point.error > 0.0).collect::<Vec<_>>()
    };
    configurations.iter().enumerate().flat_map(of).collect()
}

/// The switches between configurations that were measured.
fn ladder(study: &Study, findings: &[Finding]) -> Vec<Rung> {
    let measured = |name: &str| {
        let is = |m: &&Measured| m.configuration.name == name;
        study.measured.iter().find(is)
    };
    let found = |name: &str| findings.iter().find(|f| f.configuration.name == name);
    let rung = |switch: &'static Switch| {
        let (without, with) = (measured(switch.without)?, measured(switch.with)?);
        let ratios = with.seconds().zip(without.seconds());
        let time = Estimate::of(ratios.map(|(with, without)| with / without - 1.0).collect());
        let (time, without, with) = match switch.removes {
            Removes::Bias => (
                time,
                found(switch.without)?.relative_bias(),
                found(switch.with)?.relative_bias(),
            ),
            Removes::Misses(without, with) => {
                let level = |precision| {
                    let (_, rate) = study.misses.iter().find(|(of, _)| *of == precision)?;
                    Some(Level::of_rate(*rate))
                };
                (time, level(without)?, level(with)?)
            }
            Removes::Stagnation => {
                let sums = study.sums.as_ref()?;
                let pixels = study.reference.image.len() as f64;
                let samples = last(&with.runs[0]).samples as f64;
                // Both are sums of the samples; what a sample takes in all is measured, and has both in it.
                let parts = with
                    .seconds()
                    .map(|seconds| sums.seconds * pixels * samples / seconds);
                let unit = f64::EPSILON / 2.0;
                let value = sums.named_error();
                let without = Level::Seen {
                    value,
                    interval: [value; 2],
                };
                // The bound of a sum of as many numbers of one sign, n·u (Higham 2002, 4.2).
                let bound = crate::probe::sums::NAMED as f64 * unit;
                (Estimate::of(parts.collect()), without, Level::Below(bound))
            }
        };
        Some(Rung {
            switch,
            time,
            without,
            with,
        })
    };
    SWITCHES.iter().filter_map(rung).collect()
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

    #[test]
    fn what_is_not_certain_is_a_bound() {
        let square = |value, ci95| Level::of_square(Jackknifed { value, ci95 });
        assert_eq!(square(0.0, 0.04), Level::Below(0.2));
        assert_eq!(square(-0.05, 0.04), Level::Below(0.0));
        let Level::Seen { value, interval } = square(0.25, 0.11) else {
            panic!("it is certain")
        };
        assert!(value == 0.5 && (interval[1] - 0.6).abs() < 1e-12);
        let rate = |failures| {
            Level::of_rate(FailureRate {
                failures,
                trials: 1000,
            })
        };
        assert_eq!(rate(0), Level::Below(0.003));
        assert!(matches!(rate(5), Level::Seen { value, .. } if value == 0.005));
    }
}
