//! What a study has measured.

use residual_accuracy::Estimate;
use residual_accuracy::sweep::{FailureRate, Measurement};

use crate::configuration::{Configuration, Tier};
use crate::probe::sums::Sums;
use crate::reference::Reference;
use residual_variants::TraversalPrecision;

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
    pub fn seconds(&self) -> impl Iterator<Item = f64> {
        self.runs.iter().map(|run| last(run).seconds)
    }
}

/// The end of a run.
pub(super) fn last(run: &[Measurement]) -> &Measurement {
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
