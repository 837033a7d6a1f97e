//! The wavefront: kernels of one kind of work each, between which paths wait in queues.

use rayon::prelude::*;
use wgpu::ComputePipeline;

use crate::error::Error;
use crate::gpu::Gpu;
use crate::kernels::Kernels;
use crate::launch::Settings;
use crate::shader::{Mode, pipeline};
use crate::stages::{Stage, Stopwatch};
use crate::state::{Header, State};

/// Vertices of paths between two looks at whether any path is left.
const VERTICES: u32 = 16;

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
        kernels: &Kernels,
        state: &State,
    ) -> Result<Self, Error> {
        let work = |text: String, entry: &str| pipeline(gpu, mode, &state.work, &text, entry);
        let between = |entry: &str| pipeline(gpu, mode, &state.between, &kernels.control(), entry);
        let queues: Vec<_> = kernels.queues_with_steps().collect();
        let shade = || {
            let shade = |&queue: &usize| Ok((queue, work(kernels.shade(queue), "shade")?));
            queues.par_iter().map(shade).collect()
        };
        let trace = || work(kernels.trace(), "trace");
        // The longest first.
        let (trace, shade): (_, Result<_, Error>) = rayon::join(trace, shade);
        Ok(Self {
            emit: work(kernels.emit(), "emit_paths")?,
            trace: trace?,
            plan: between("plan")?,
            scatter: work(kernels.scatter(), "scatter")?,
            shade: shade?,
            turn: between("turn")?,
        })
    }

    /// Renders `settings.count` samples, of paths of at most this many vertices.
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
        let mut done = 0;
        loop {
            let vertices = VERTICES.min(settings.max_depth - done);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                watch.begin(&mut pass);
                if done == 0 {
                    state.bind(&mut pass, &self.emit);
                    pass.dispatch_workgroups(groups, 1, 1);
                    watch.lap(&mut pass, Stage::Emit);
                }
                for vertex in done..done + vertices {
                    self.step(&mut pass, state, watch, vertex);
                }
                done += vertices;
                if done == settings.max_depth {
                    // The last shadow rays.
                    self.trace(&mut pass, state);
                    watch.lap(&mut pass, Stage::TraceOn);
                }
            }
            watch.resolve(&mut encoder);
            gpu.queue.submit([encoder.finish()]);
            watch.read(gpu)?;
            let header = state.header(gpu)?;
            if done == settings.max_depth || header.is_done() {
                return Ok(header);
            }
        }
    }

    /// One vertex of all paths.
    fn step(
        &self,
        pass: &mut wgpu::ComputePass<'_>,
        state: &State,
        watch: &mut Stopwatch,
        vertex: u32,
    ) {
        self.trace(pass, state);
        let is_first = vertex == 0;
        watch.lap(
            pass,
            if is_first {
                Stage::TraceCamera
            } else {
                Stage::TraceOn
            },
        );
        between(pass, state, &self.plan);
        state.bind(pass, &self.scatter);
        pass.dispatch_workgroups_indirect(&state.arguments, 12);
        watch.lap(pass, Stage::Sort);
        for (queue, shade) in &self.shade {
            state.bind(pass, shade);
            pass.dispatch_workgroups_indirect(&state.arguments, 12 * (2 + *queue as u64));
        }
        between(pass, state, &self.turn);
        watch.lap(pass, Stage::Shade);
    }

    fn trace(&self, pass: &mut wgpu::ComputePass<'_>, state: &State) {
        state.bind(pass, &self.trace);
        pass.dispatch_workgroups_indirect(&state.arguments, 0);
    }
}

/// Runs a kernel of one thread.
fn between(pass: &mut wgpu::ComputePass<'_>, state: &State, kernel: &ComputePipeline) {
    pass.set_pipeline(kernel);
    pass.set_bind_group(0, &state.control, &[]);
    pass.dispatch_workgroups(1, 1, 1);
}
