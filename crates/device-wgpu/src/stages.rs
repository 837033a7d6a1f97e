//! How long the stages of a launch take, by the device's own clock.

use wgpu::{BufferUsages, CommandEncoder, ComputePass, Features};

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
const TIMESTAMPS: u32 = 64;

/// A clock that is read between kernels; it says nothing where the adapter has none.
pub(crate) struct Clock {
    parts: Option<Parts>,
}

struct Parts {
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
    /// Seconds of a tick.
    tick: f64,
}

/// What ended at each timestamp of a submission since the first.
#[derive(Debug, Default)]
pub(crate) struct Laps(Vec<Stage>);

/// Device seconds by stage.
pub(crate) type StageSeconds = [f64; Stage::COUNT];

impl Clock {
    /// Bytes of a submission's timestamps.
    pub(crate) const BYTES: u64 = 8 * TIMESTAMPS as u64;

    pub(crate) fn new(gpu: &Gpu) -> Self {
        let has_clock =
            gpu.has(Features::TIMESTAMP_QUERY | Features::TIMESTAMP_QUERY_INSIDE_PASSES);
        let parts = has_clock.then(|| Parts {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("stages"),
                ty: wgpu::QueryType::Timestamp,
                count: TIMESTAMPS,
            }),
            resolved: gpu.buffer(
                "timestamps",
                Self::BYTES,
                BufferUsages::QUERY_RESOLVE | BufferUsages::COPY_SRC,
            ),
            tick: f64::from(gpu.queue.get_timestamp_period()) * 1e-9,
        });
        Self { parts }
    }

    /// The first timestamp of a submission.
    pub(crate) fn begin(&self, pass: &mut ComputePass<'_>) -> Laps {
        if let Some(parts) = &self.parts {
            pass.write_timestamp(&parts.queries, 0);
        }
        Laps::default()
    }

    /// A stage has ended.
    pub(crate) fn lap(&self, pass: &mut ComputePass<'_>, laps: &mut Laps, stage: Stage) {
        if let Some(parts) = &self.parts {
            laps.0.push(stage);
            pass.write_timestamp(&parts.queries, laps.0.len() as u32);
        }
    }

    /// Behind the pass: copies the timestamps to a place in a buffer.
    pub(crate) fn copy(
        &self,
        encoder: &mut CommandEncoder,
        laps: &Laps,
        to: &wgpu::Buffer,
        at: u64,
    ) {
        if let Some(parts) = &self.parts {
            let count = laps.0.len() as u32 + 1;
            encoder.resolve_query_set(&parts.queries, 0..count, &parts.resolved, 0);
            let bytes = 8 * u64::from(count);
            encoder.copy_buffer_to_buffer(&parts.resolved, 0, to, at, bytes);
        }
    }

    /// Adds up what was copied.
    pub(crate) fn add(&self, laps: &Laps, bytes: &[u8], seconds: &mut StageSeconds) {
        let Some(parts) = &self.parts else {
            return;
        };
        let ticks = bytes.as_chunks().0.iter();
        let ticks: Vec<u64> = ticks.map(|&tick| u64::from_le_bytes(tick)).collect();
        for (stage, times) in laps.0.iter().zip(ticks.windows(2)) {
            seconds[*stage as usize] += times[1].saturating_sub(times[0]) as f64 * parts.tick;
        }
    }
}
