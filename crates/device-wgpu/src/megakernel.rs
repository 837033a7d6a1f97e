//! The megakernel: one kernel, in which a thread follows a path to its end.

use wgpu::ComputePipeline;

use crate::error::Error;
use crate::gpu::Gpu;
use crate::kernels::Kernels;
use crate::launch::Settings;
use crate::shader::{Mode, pipeline};
use crate::stages::{Stage, Stopwatch};
use crate::state::{Header, State};

/// The kernel.
pub(crate) struct Megakernel(ComputePipeline);

impl Megakernel {
    /// Compiles it.
    ///
    /// # Errors
    /// If it is refused.
    pub(crate) fn new(
        gpu: &Gpu,
        mode: Mode,
        kernels: &Kernels,
        state: &State,
    ) -> Result<Self, Error> {
        let text = kernels.megakernel();
        pipeline(gpu, mode, &state.work, &text, "follow_path").map(Self)
    }

    /// Renders `settings.count` samples.
    ///
    /// # Errors
    /// If the device fails.
    pub(crate) fn launch(
        &self,
        gpu: &Gpu,
        state: &State,
        settings: &Settings,
        watch: &mut Stopwatch,
    ) -> Result<Header, Error> {
        let groups = state.begin(gpu, settings);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            watch.begin(&mut pass);
            state.bind(&mut pass, &self.0);
            pass.dispatch_workgroups(groups, 1, 1);
            watch.lap(&mut pass, Stage::Shade);
        }
        watch.resolve(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
        watch.read(gpu)?;
        state.header(gpu)
    }
}
