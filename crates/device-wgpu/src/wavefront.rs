//! The wavefront: kernels of one kind of work each, between which paths wait in queues.

use rayon::prelude::*;
use residual_wgsl::KernelTexts;
use wgpu::{ComputePass, ComputePipeline};

use crate::error::Error;
use crate::gpu::Gpu;
use crate::launch::Settings;
use crate::shader::{Mode, pipeline};
use crate::stages::{Laps, Stage, StageSeconds};
use crate::state::{Header, Launched, Shown, State};

/// Vertices of paths between two looks at whether any path is left.
pub(crate) const VERTICES: u32 = 16;

/// The kernels.
pub(crate) struct Wavefront {
    emit: ComputePipeline,
    trace: ComputePipeline,
    plan: ComputePipeline,
    scatter: ComputePipeline,
    /// Of each queue that has one.
    shade: Vec<(usize, ComputePipeline)>,
    turn: ComputePipeline,
}

impl Wavefront {
    /// Compiles the kernels, as many at a time as there are threads.
    ///
    /// # Errors
    /// If a kernel is refused.
    pub(crate) fn new(
        gpu: &Gpu,
        mode: Mode,
        kernels: KernelTexts<'_>,
        state: &State,
    ) -> Result<Self, Error> {
        let text = |name: &'static str| kernels.text(name).ok_or(Error::NoKernel { name });
        let work = |text: &str, entry: &str| pipeline(gpu, mode, &state.work, text, entry);
        let control = text("control")?;
        let between = |entry: &str| pipeline(gpu, mode, &state.between, control, entry);
        let shade: Vec<_> = kernels.shade().collect();
        let compile = |&(queue, text): &(usize, &str)| Ok((queue, work(text, "shade")?));
        let shade = || -> Result<Vec<_>, Error> { shade.par_iter().map(compile).collect() };
        // The longest first.
        let (trace, shade) = rayon::join(|| work(text("trace")?, "trace"), shade);
        Ok(Self {
            emit: work(text("emit")?, "emit_paths")?,
            trace: trace?,
            plan: between("plan")?,
            scatter: work(text("scatter")?, "scatter")?,
            shade: shade?,
            turn: between("turn")?,
        })
    }

    /// Renders `settings.count` samples, whose `bytes` are to come back through one of the staging buffers. `meanwhile` gets what has
    /// come back whenever the device looks whether any path is left; splats then begin anew.
    ///
    /// # Errors
    /// If the device fails.
    pub(crate) fn launch(
        &self,
        gpu: &Gpu,
        state: Shown<'_>,
        settings: &Settings,
        (staging, bytes): (usize, u64),
        seconds: &mut StageSeconds,
        mut meanwhile: impl FnMut(&Header, &[f32]),
    ) -> Result<Launched, Error> {
        let groups = state.begin(gpu, settings);
        let mut done = 0;
        loop {
            let vertices = VERTICES.min(settings.max_depth - done);
            let is_last = done + vertices == settings.max_depth;
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let laps = {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                let mut laps = state.clock.begin(&mut pass);
                if done == 0 {
                    state.bind(&mut pass, &self.emit);
                    pass.dispatch_workgroups(groups, 1, 1);
                    state.clock.lap(&mut pass, &mut laps, Stage::Emit);
                }
                for vertex in done..done + vertices {
                    self.step(&mut pass, state, &mut laps, vertex);
                }
                if is_last {
                    // The last shadow rays.
                    self.trace(&mut pass, state);
                    state.clock.lap(&mut pass, &mut laps, Stage::TraceOn);
                }
                laps
            };
            let launched = state.submit(gpu, encoder, laps, staging, bytes);
            if is_last {
                return Ok(launched);
            }
            done += vertices;
            // Long paths are rare: is any left?
            let header = state.collect(gpu, &launched, seconds, &mut meanwhile)?;
            state.clear_splats(gpu);
            if header.is_done() {
                let encoder = gpu.device.create_command_encoder(&Default::default());
                return Ok(state.submit(gpu, encoder, Laps::default(), staging, bytes));
            }
        }
    }

    /// One vertex of all paths.
    fn step(&self, pass: &mut ComputePass<'_>, state: Shown<'_>, laps: &mut Laps, vertex: u32) {
        self.trace(pass, state);
        let traced = match vertex {
            0 => Stage::TraceCamera,
            _ => Stage::TraceOn,
        };
        state.clock.lap(pass, laps, traced);
        between(pass, &state, &self.plan);
        state.bind(pass, &self.scatter);
        pass.dispatch_workgroups_indirect(&state.arguments, 12);
        state.clock.lap(pass, laps, Stage::Sort);
        for (queue, shade) in &self.shade {
            state.bind(pass, shade);
            pass.dispatch_workgroups_indirect(&state.arguments, 12 * (2 + *queue as u64));
        }
        between(pass, &state, &self.turn);
        state.clock.lap(pass, laps, Stage::Shade);
    }

    fn trace(&self, pass: &mut ComputePass<'_>, state: Shown<'_>) {
        state.bind(pass, &self.trace);
        pass.dispatch_workgroups_indirect(&state.arguments, 0);
    }
}

/// Runs a kernel of one thread.
fn between(pass: &mut ComputePass<'_>, state: &State, kernel: &ComputePipeline) {
    pass.set_pipeline(kernel);
    pass.set_bind_group(0, &state.control, &[]);
    pass.dispatch_workgroups(1, 1, 1);
}
