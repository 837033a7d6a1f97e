//! What the measurements of a study say.

mod finding;
mod ladder;
mod level;
mod measured;

use anyhow::Result;
use residual_accuracy::sweep::{knee, pareto_front};

pub use finding::{Finding, ONE_PERCENT};
pub use ladder::Rung;
pub use level::Level;
pub use measured::{Crop, Measured, Provenance, Study, equal_time_samples};

use self::finding::{bias, finding};
use self::ladder::ladder;

/// Points of the front err less by this part than all that are faster: configurations with the same images differ in time only.
const LEAST_GAIN: f64 = 0.01;

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
