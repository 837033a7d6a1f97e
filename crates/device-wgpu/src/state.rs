//! What kernels of every mapping share: the buffers of a scene, of the paths under way, and of their samples.

use std::ops::Deref;

use bytemuck::Zeroable;
use residual_wgsl::{Binding, WORKGROUP};
use wgpu::{BindGroup, BindGroupLayout, BufferUsages, CommandEncoder, PipelineLayout};

use crate::bindings::Access::{Read, Uniform, Write};
use crate::bindings::{group, layout, pipeline_layout};
use crate::error::Error;
use crate::gpu::{Gpu, MapRequest};
use crate::launch::Settings;
use crate::scene::Scene;
use crate::stages::{Clock, Laps, StageSeconds};

/// Bytes of a path, of one in a scene with light paths, a shadow ray and the entries of a path in the queues.
const PATH: u64 = 64;
const PATH_OF_EITHER_END: u64 = 80;
const SHADOW_RAY: u64 = 48;
const ENTRIES: u64 = 12;
/// Words of the queues before what there is of each program, and words of each program.
const HEADER: usize = 7;
const OF_QUEUE: usize = 3;

/// Numbers of a splat.
pub(crate) const SPLAT: usize = 4;
/// There is room for the splats of a path, however long it is.
const LONGEST_PATH: u64 = 1024;

/// What sizes of buffers depend on.
#[derive(Clone, Copy)]
pub(crate) struct Shape {
    /// Queues of hits.
    pub(crate) queues: usize,
    /// Numbers of a sample.
    pub(crate) stride: usize,
    /// Paths begin at both ends.
    pub(crate) has_light_paths: bool,
}

impl Shape {
    fn path(self) -> u64 {
        match self.has_light_paths {
            true => PATH_OF_EITHER_END,
            false => PATH,
        }
    }

    /// Bytes of the samples of so many paths, or of splats.
    fn samples(self, slots: u64) -> u64 {
        let bytes = slots * 4 * self.stride as u64;
        match self.has_light_paths {
            true => bytes.max(4 * SPLAT as u64 * LONGEST_PATH),
            false => bytes,
        }
    }

    /// Bytes that a path takes.
    pub(crate) fn bytes_per_path(self) -> u64 {
        self.path() + SHADOW_RAY + ENTRIES + 4 * self.stride as u64
    }
}

/// Buffers, bound.
pub(crate) struct State {
    /// Bytes of all of them, but for the scene's.
    pub(crate) bytes: u64,
    /// Of the groups 0 and 1 of the kernels that work on paths.
    layouts: [BindGroupLayout; 2],
    pub(crate) work: PipelineLayout,
    /// Group 0 of those that schedule.
    pub(crate) control: BindGroup,
    pub(crate) between: PipelineLayout,
    /// Workgroups of indirect dispatches.
    pub(crate) arguments: wgpu::Buffer,
    /// `samples[slot][channel]`.
    pub(crate) samples: wgpu::Buffer,
    settings: wgpu::Buffer,
    paths: wgpu::Buffer,
    shadow_rays: wgpu::Buffer,
    queues: wgpu::Buffer,
    queue_count: usize,
    pub(crate) clock: Clock,
    /// What comes back of a launch, and of the one behind it: [`Header`], timestamps, samples.
    staging: [wgpu::Buffer; 2],
}

/// The buffers of a scene, or of a pose of it, bound together with those of the paths under way.
pub(crate) struct Bound {
    /// Group 0 and 1 of the kernels that work on paths.
    groups: [BindGroup; 2],
}

/// Buffers, and the pose of the scene that is rendered.
#[derive(Clone, Copy)]
pub(crate) struct Shown<'a> {
    pub(crate) state: &'a State,
    pub(crate) pose: &'a Bound,
}

impl Deref for Shown<'_> {
    type Target = State;

    fn deref(&self) -> &State {
        self.state
    }
}

impl Shown<'_> {
    /// Binds what kernels on paths need.
    pub(crate) fn bind(&self, pass: &mut wgpu::ComputePass<'_>, kernel: &wgpu::ComputePipeline) {
        pass.set_pipeline(kernel);
        for (index, group) in (0..).zip(&self.pose.groups) {
            pass.set_bind_group(index, group, &[]);
        }
    }
}

/// Where timestamps and samples begin in what comes back.
const TICKS_AT: u64 = 32;
const SAMPLES_AT: u64 = TICKS_AT + Clock::BYTES;

/// A launch that is under way.
pub(crate) struct Launched {
    laps: Laps,
    staging: usize,
    submission: wgpu::SubmissionIndex,
    request: MapRequest,
}

/// The first words of the queues: the kernels' `Queues`.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Header {
    live: u32,
    side: u32,
    next: u32,
    shadows: u32,
    pub(crate) bounce_rays: u32,
    pub(crate) shadow_rays: u32,
    pub(crate) splats: u32,
}

impl Header {
    /// No path is left, and no shadow ray.
    pub(crate) fn is_done(&self) -> bool {
        self.live == 0 && self.shadows == 0
    }
}

const _: () = assert!(size_of::<Header>() == 4 * HEADER);

impl State {
    /// Buffers for this many paths under way, and as many of them in queues.
    pub(crate) fn new(gpu: &Gpu, shape: Shape, slots: u32, queued: u32) -> Self {
        let queue_count = shape.queues;
        let storage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let [slots, queued] = [slots, queued].map(u64::from);
        let paths = gpu.buffer("paths", queued * shape.path(), storage);
        let shadow_rays = gpu.buffer("shadow rays", queued * SHADOW_RAY, storage);
        let header = 4 * (HEADER + OF_QUEUE * queue_count) as u64;
        let queues = gpu.buffer("queues", header + queued * ENTRIES, storage);
        let sample_bytes = shape.samples(slots);
        let samples = gpu.buffer("samples", sample_bytes, storage);
        let size = size_of::<Settings>() as u64;
        let settings = gpu.buffer("settings", size, BufferUsages::UNIFORM);
        let arguments = gpu.buffer(
            "arguments",
            // For tracing, scattering, each queue and the folded ones.
            12 * (3 + queue_count as u64),
            BufferUsages::STORAGE | BufferUsages::INDIRECT,
        );

        let size = |buffer: &wgpu::Buffer| buffer.size();
        let bytes = [&paths, &shadow_rays, &queues, &samples]
            .map(size)
            .iter()
            .sum();
        let scene_layout = layout(gpu, &[Read, Read, Read, Uniform]);
        let paths_layout = layout(gpu, &[Read, Write, Write, Write, Write, Uniform]);
        let control_layout = layout(gpu, &[Write, Write, Uniform]);
        Self {
            bytes,
            work: pipeline_layout(gpu, &[&scene_layout, &paths_layout]),
            layouts: [scene_layout, paths_layout],
            control: group(gpu, &control_layout, &[&queues, &arguments, &settings]),
            between: pipeline_layout(gpu, &[&control_layout]),
            arguments,
            samples,
            settings,
            paths,
            shadow_rays,
            queues,
            queue_count,
            clock: Clock::new(gpu),
            staging: [(); 2].map(|()| {
                gpu.device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some("staging"),
                    size: SAMPLES_AT + sample_bytes,
                    usage: BufferUsages::MAP_READ | BufferUsages::COPY_DST,
                    mapped_at_creation: false,
                })
            }),
        }
    }

    /// Binds the buffers of a scene, or of a pose of it.
    pub(crate) fn bound(&self, gpu: &Gpu, scene: &Scene) -> Bound {
        let [geometry, texels, tables] = &scene.bindings;
        const { assert!(Binding::BASES == 3) };
        let of_scene = [geometry, texels, tables, &scene.bases];
        let of_paths = [
            &scene.tree,
            &self.paths,
            &self.shadow_rays,
            &self.queues,
            &self.samples,
            &self.settings,
        ];
        let [scene_layout, paths_layout] = &self.layouts;
        Bound {
            groups: [
                group(gpu, scene_layout, &of_scene),
                group(gpu, paths_layout, &of_paths),
            ],
        }
    }

    /// Splats that fit where samples are kept.
    pub(crate) fn splats_that_fit(&self) -> u64 {
        self.samples.size() / (4 * SPLAT as u64)
    }

    /// Empties the list of splats, which have been collected.
    pub(crate) fn clear_splats(&self, gpu: &Gpu) {
        let at = std::mem::offset_of!(Header, splats) as u64;
        gpu.queue.write_buffer(&self.queues, at, &[0; 4]);
    }

    /// Sets everything up for a launch; returns its workgroups.
    pub(crate) fn begin(&self, gpu: &Gpu, settings: &Settings) -> u32 {
        let write = |buffer, bytes: &[u8]| gpu.queue.write_buffer(buffer, 0, bytes);
        write(&self.settings, bytemuck::bytes_of(settings));
        let mut words = vec![0; HEADER + OF_QUEUE * self.queue_count];
        words[0] = settings.count;
        write(&self.queues, bytemuck::cast_slice(&words));
        let groups = settings.count.div_ceil(WORKGROUP);
        let arguments = [groups, 1, 1, groups, 1, 1];
        write(&self.arguments, bytemuck::cast_slice(&arguments));
        groups
    }

    /// Submits a launch; `bytes` of its samples are to come back through one of the two staging buffers, which must not be
    /// in use.
    pub(crate) fn submit(
        &self,
        gpu: &Gpu,
        mut encoder: CommandEncoder,
        laps: Laps,
        staging: usize,
        bytes: u64,
    ) -> Launched {
        let to = &self.staging[staging];
        let header = size_of::<Header>() as u64;
        encoder.copy_buffer_to_buffer(&self.queues, 0, to, 0, header);
        self.clock.copy(&mut encoder, &laps, to, TICKS_AT);
        encoder.copy_buffer_to_buffer(&self.samples, 0, to, SAMPLES_AT, bytes);
        let submission = gpu.queue.submit([encoder.finish()]);
        let request = MapRequest::new(to, SAMPLES_AT + bytes);
        Launched {
            laps,
            staging,
            submission,
            request,
        }
    }

    /// Waits for a launch, and hands out its samples.
    ///
    /// # Errors
    /// If the device fails.
    pub(crate) fn collect(
        &self,
        gpu: &Gpu,
        launched: &Launched,
        seconds: &mut StageSeconds,
        samples: impl FnOnce(&Header, &[f32]),
    ) -> Result<Header, Error> {
        gpu.wait_for(Some(launched.submission.clone()))?;
        let staging = &self.staging[launched.staging];
        let header = {
            let mapped = launched.request.view(gpu, staging)?;
            let (head, of_samples) = mapped.split_at(SAMPLES_AT as usize);
            let (header, ticks) = head.split_at(TICKS_AT as usize);
            self.clock.add(&launched.laps, ticks, seconds);
            let header = bytemuck::pod_read_unaligned(&header[..size_of::<Header>()]);
            samples(&header, bytemuck::cast_slice(of_samples));
            header
        };
        staging.unmap();
        Ok(header)
    }
}
