//! What is to be measured, and how configurations are set up for it.

use std::path::PathBuf;

use residual_device_cpu::LaneCount;
use residual_render::passes::RenderOptions;
use residual_scenegen::plan::{CameraChoice, PlanOptions};

use crate::configuration::{BASELINE, CONFIGURATIONS, Configuration, Extent, Setup, Tier};
use crate::reference::{ReferenceOptions, STRATEGIES};
use residual_variants::TraversalPrecision;

/// What is to be measured.
#[derive(Clone, Debug)]
pub struct StudyOptions {
    /// Where everything is kept.
    pub folder: PathBuf,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Which camera.
    pub camera: CameraChoice,
    /// Measured runs of each configuration, with the seeds from 1 on; at least three.
    pub seeds: u32,
    /// Samples a pixel at which runs are looked at, ascending.
    pub counts: Vec<u32>,
    /// How the reference is made.
    pub reference: ReferenceOptions,
    /// Which configurations.
    pub extent: Extent,
    /// How renderers are made, but where that is what is switched.
    pub tier: Tier,
    /// Threads of the measured runs; 0 is one for each processor. The reference has all.
    pub threads: usize,
    /// Aimed rays for each precision.
    pub aimed_rays: u64,
}

/// What is measured in a study with these options.
pub(super) fn configurations(
    options: &StudyOptions,
) -> impl Iterator<Item = &'static Configuration> + use<'_> {
    CONFIGURATIONS.iter().filter(|configuration| {
        let in_extent = options.extent == Extent::Full || configuration.extent == Extent::Quick;
        let setup = options.setup(configuration);
        let is_baseline = configuration.name == BASELINE;
        // Without a compiler, and on machines of few lanes, some are the baseline.
        let is_other = is_baseline || !setup.is_as(&options.baseline());
        in_extent && is_other
    })
}

impl StudyOptions {
    pub(super) fn baseline(&self) -> Setup {
        Setup {
            plan: PlanOptions {
                size: self.size,
                camera: self.camera.clone(),
                ..PlanOptions::default()
            },
            render: RenderOptions {
                size: self.size,
                samples: None,
                ..RenderOptions::default()
            },
            precision: TraversalPrecision::Watertight,
            tier: self.tier,
            lanes: LaneCount::native(),
            clamp: None,
        }
    }

    pub(super) fn setup(&self, configuration: &Configuration) -> Setup {
        let mut setup = self.baseline();
        (configuration.change)(&mut setup);
        // What makes a difference to compiled renderers only.
        if self.tier == Tier::Interpreted {
            setup.plan.binding = self.baseline().plan.binding;
        }
        setup
    }

    /// Samples a pixel that are to be rendered.
    pub(super) fn work(&self) -> u64 {
        let reference = self.reference.seeds * self.reference.samples * STRATEGIES.len() as u32;
        u64::from(reference) + configurations(self).count() as u64 * self.work_of_round()
    }

    fn work_of_round(&self) -> u64 {
        u64::from(self.seeds) * u64::from(self.most_samples())
    }

    pub(super) fn most_samples(&self) -> u32 {
        *self.counts.last().expect("some number of samples")
    }
}
