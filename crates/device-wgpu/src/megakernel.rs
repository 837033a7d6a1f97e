//! The megakernel: one kernel, in which a thread follows a path to its end.

use residual_wgsl::KernelTexts;
use wgpu::ComputePipeline;

use crate::error::Error;
use crate::gpu::Gpu;
use crate::launch::Settings;
use crate::shader::{Mode, pipeline};
use crate::stages::Stage;
use crate::state::{Launched, Shown, State};

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
        kernels: KernelTexts<'_>,
        state: &State,
    ) -> Result<Self, Error> {
        let name = "megakernel";
        let text = kernels.text(name).ok_or(Error::NoKernel { name })?;
        pipeline(gpu, mode, &state.work, text, "follow_path").map(Self)
    }

    /// Renders `settings.count` samples, whose `bytes` are to come back through one of the staging buffers.
    pub(crate) fn launch(
        &self,
        gpu: &Gpu,
        state: Shown<'_>,
        settings: &Settings,
        (staging, bytes): (usize, u64),
    ) -> Launched {
        let groups = state.begin(gpu, settings);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let laps = {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            let mut laps = state.clock.begin(&mut pass);
            state.bind(&mut pass, &self.0);
            pass.dispatch_workgroups(groups, 1, 1);
            state.clock.lap(&mut pass, &mut laps, Stage::Shade);
            laps
        };
        state.submit(gpu, encoder, laps, staging, bytes)
    }
}
