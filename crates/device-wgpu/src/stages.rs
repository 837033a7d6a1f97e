//! How long the stages of a launch take, by the device's own clock.

use wgpu::{BufferUsages, Features};

use crate::error::Error;
use crate::gpu::Gpu;

/// What kernels do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Making camera rays.
    Emit,
    /// Closest hits of camera rays.
    TraceCamera,
    /// Closest hits of continued paths, and occlusion.
    TraceOn,
    /// Sorting by program.
    Sort,
    /// Shading.
    Shade,
}

impl Stage {
    pub(crate) const COUNT: usize = Self::Shade as usize + 1;
}

/// Timestamps of one submission at most.
const TIMESTAMPS: u32 = 128;

/// A clock that is read between kernels; it says nothing where the adapter has none.
pub(crate) struct Stopwatch {
    clock: Option<Clock>,
    /// What ended at each timestamp since the first.
    laps: Vec<Stage>,
    /// Device seconds by stage.
    pub(crate) seconds: [f64; Stage::COUNT],
}

struct Clock {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// Seconds of a tick.
    tick: f64,
}

impl Stopwatch {
    pub(crate) fn new(gpu: &Gpu) -> Self {
        let has_clock =
            gpu.has(Features::TIMESTAMP_QUERY | Features::TIMESTAMP_QUERY_INSIDE_PASSES);
        let clock = has_clock.then(|| Clock {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stages"),
                ty: wgpu::QueryType::Timestamp,
                count: TIMESTAMPS,
            }),
            resolved: gpu.buffer(
                "timestamps",
                8 * u64::from(TIMESTAMPS),
                BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
            ),
            tick: f64::from(gpu.queue.get_timestamp_period()) * 1e-9,
        });
        Self {
            clock,
            laps: Vec::new(),
            seconds: [0.0; Stage::COUNT],
        }
    }

    /// The first timestamp of a submission.
    pub(crate) fn begin(&mut self, pass: &mut wgpu::ComputePass<'_>) {
        if let Some(clock) = &self.clock {
            pass.write_timestamp(&clock.queries, 0);
        }
    }

    /// A stage has ended.
    pub(crate) fn lap(&mut self, pass: &mut wgpu::ComputePass<'_>, stage: Stage) {
        if let Some(clock) = &self.clock {
            self.laps.push(stage);
            pass.write_timestamp(&clock.queries, self.laps.len() as u32);
        }
    }

    /// Behind the pass.
    pub(crate) fn resolve(&self, encoder: &mut wgpu::CommandEncoder) {
        if let Some(clock) = &self.clock {
            let range = 0..self.laps.len() as u32 + 1;
            encoder.resolve_query_set(&clock.queries, range, &clock.resolved, 0);
        }
    }

    /// After submission: adds up the stages.
    pub(crate) fn read(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let Some(clock) = &self.clock else {
            return Ok(());
        };
        let mut ticks = vec![0_u64; self.laps.len() + 1];
        gpu.download(&clock.resolved, bytemuck::cast_slice_mut(&mut ticks))?;
        for (stage, times) in self.laps.drain(..).zip(ticks.windows(2)) {
            self.seconds[stage as usize] += times[1].saturating_sub(times[0]) as f64 * clock.tick;
        }
        Ok(())
    }
}
