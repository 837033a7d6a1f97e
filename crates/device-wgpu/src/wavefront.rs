//! The wavefront: kernels of one kind of work each, between which paths wait in queues.

use residual_wgsl::Binding;
use wgpu::{BindGroup, BindGroupLayout, BufferUsages, ComputePipeline, PipelineLayout};

use crate::error::Error;
use crate::gpu::Gpu;
use crate::kernels::Kernels;
use crate::launch::Settings;
use crate::scene::Scene;
use crate::shader::{Dialect, pipeline};
use crate::stages::{Stage, Stopwatch};

/// Bytes of a path, a shadow ray and the entries of a path in the queues.
const PATH: u64 = 64;
const SHADOW_RAY: u64 = 48;
const ENTRIES: u64 = 12;
/// Threads of a workgroup.
const WORKGROUP: u32 = 64;
/// Vertices of paths between two looks at whether any path is left.
const VERTICES: u32 = 16;

/// Bytes that a path takes, with so many numbers a sample.
pub(crate) fn bytes_per_path(stride: usize) -> u64 {
    PATH + SHADOW_RAY + ENTRIES + 4 * stride as u64
}

/// Kernels, and the buffers that they share.
pub(crate) struct Wavefront {
    emit: ComputePipeline,
    trace: ComputePipeline,
    plan: ComputePipeline,
    scatter: ComputePipeline,
    /// Of each queue that has one.
    shade: Vec<(usize, ComputePipeline)>,
    turn: ComputePipeline,
    scene: BindGroup,
    paths: BindGroup,
    control: BindGroup,
    settings: wgpu::Buffer,
    queues: wgpu::Buffer,
    arguments: wgpu::Buffer,
    /// `samples[slot][channel]`.
    pub(crate) samples: wgpu::Buffer,
    queue_count: usize,
}

/// Rays that a launch has traced, beside those of the camera.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rays {
    pub(crate) bounce: u32,
    pub(crate) shadow: u32,
}

impl Wavefront {
    /// Compiles the kernels, and makes buffers for this many paths.
    ///
    /// # Errors
    /// If a kernel is refused.
    pub(crate) fn new(
        gpu: &Gpu,
        dialect: Dialect,
        kernels: &Kernels,
        scene: &Scene,
        slots: u32,
        stride: usize,
    ) -> Result<Self, Error> {
        let queue_count = kernels.queues();
        let storage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let slots = u64::from(slots);
        let paths = gpu.buffer("paths", slots * PATH, storage);
        let shadow_rays = gpu.buffer("shadow rays", slots * SHADOW_RAY, storage);
        let header = 4 * (6 + 3 * queue_count as u64);
        let queues = gpu.buffer("queues", header + slots * ENTRIES, storage);
        let samples = gpu.buffer("samples", slots * 4 * stride as u64, storage);
        let settings = gpu.buffer(
            "settings",
            size_of::<Settings>() as u64,
            BufferUsages::UNIFORM,
        );
        let arguments = gpu.buffer(
            "arguments",
            12 * (2 + queue_count as u64),
            BufferUsages::STORAGE | BufferUsages::INDIRECT,
        );

        let scene_layout = layout(gpu, &[Read, Read, Read, Uniform]);
        let paths_layout = layout(gpu, &[Read, Write, Write, Write, Write, Uniform]);
        let control_layout = layout(gpu, &[Write, Write, Uniform]);
        let [geometry, texels, tables] = &scene.bindings;
        const { assert!(Binding::BASES == 3) };
        let scene_group = group(
            gpu,
            &scene_layout,
            &[geometry, texels, tables, &scene.bases],
        );
        let paths_group = group(
            gpu,
            &paths_layout,
            &[
                &scene.tree,
                &paths,
                &shadow_rays,
                &queues,
                &samples,
                &settings,
            ],
        );
        let control_group = group(gpu, &control_layout, &[&queues, &arguments, &settings]);
        let work = pipeline_layout(gpu, &[&scene_layout, &paths_layout]);
        let between = pipeline_layout(gpu, &[&control_layout]);

        let make =
            |text: &str, entry_point: &str| pipeline(gpu, dialect.mode, &work, text, entry_point);
        let control = kernels.control();
        let control =
            |entry_point: &str| pipeline(gpu, dialect.mode, &between, &control, entry_point);
        let shade = (0..queue_count).filter(|&queue| kernels.has_step(queue));
        let shade = shade.map(|queue| Ok((queue, make(&kernels.shade(queue), "shade")?)));
        Ok(Self {
            emit: make(&kernels.emit(), "emit_paths")?,
            trace: make(&kernels.trace(), "trace")?,
            plan: control("plan")?,
            scatter: make(&kernels.scatter(), "scatter")?,
            shade: shade.collect::<Result<_, Error>>()?,
            turn: control("turn")?,
            scene: scene_group,
            paths: paths_group,
            control: control_group,
            settings,
            queues,
            arguments,
            samples,
            queue_count,
        })
    }

    /// Renders `settings.count` samples.
    ///
    /// # Errors
    /// If the device fails.
    pub(crate) fn launch(
        &self,
        gpu: &Gpu,
        settings: &Settings,
        max_depth: u32,
        watch: &mut Stopwatch,
    ) -> Result<Rays, Error> {
        let count = settings.count;
        gpu.queue
            .write_buffer(&self.settings, 0, bytemuck::bytes_of(settings));
        let mut header = vec![0; 6 + 3 * self.queue_count];
        header[0] = count;
        gpu.queue
            .write_buffer(&self.queues, 0, bytemuck::cast_slice(&header));
        let groups = count.div_ceil(WORKGROUP);
        let arguments = [groups, 1, 1, groups, 1, 1];
        gpu.queue
            .write_buffer(&self.arguments, 0, bytemuck::cast_slice(&arguments));

        let mut done = 0;
        while done < max_depth {
            let vertices = VERTICES.min(max_depth - done);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                watch.begin(&mut pass);
                if done == 0 {
                    self.work(&mut pass, &self.emit);
                    pass.dispatch_workgroups(groups, 1, 1);
                    watch.lap(&mut pass, Stage::Emit);
                }
                for vertex in done..done + vertices {
                    self.step(&mut pass, watch, vertex);
                }
                done += vertices;
                if done == max_depth {
                    self.trace(&mut pass);
                    watch.lap(&mut pass, Stage::TraceOn);
                }
            }
            watch.resolve(gpu, &mut encoder);
            gpu.queue.submit([encoder.finish()]);
            watch.read(gpu)?;
            if done < max_depth && self.header(gpu)?[0] == 0 {
                break;
            }
        }
        let header = self.header(gpu)?;
        Ok(Rays {
            bounce: header[4],
            shadow: header[5],
        })
    }

    /// One vertex of all paths.
    fn step(&self, pass: &mut wgpu::ComputePass<'_>, watch: &mut Stopwatch, vertex: u32) {
        self.trace(pass);
        let stage = if vertex == 0 {
            Stage::TraceCamera
        } else {
            Stage::TraceOn
        };
        watch.lap(pass, stage);
        self.between(pass, &self.plan);
        self.work(pass, &self.scatter);
        pass.dispatch_workgroups_indirect(&self.arguments, 12);
        watch.lap(pass, Stage::Sort);
        for (queue, shade) in &self.shade {
            self.work(pass, shade);
            pass.dispatch_workgroups_indirect(&self.arguments, 12 * (2 + *queue as u64));
        }
        self.between(pass, &self.turn);
        watch.lap(pass, Stage::Shade);
    }

    fn trace(&self, pass: &mut wgpu::ComputePass<'_>) {
        self.work(pass, &self.trace);
        pass.dispatch_workgroups_indirect(&self.arguments, 0);
    }

    fn work(&self, pass: &mut wgpu::ComputePass<'_>, pipeline: &ComputePipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.scene, &[]);
        pass.set_bind_group(1, &self.paths, &[]);
    }

    fn between(&self, pass: &mut wgpu::ComputePass<'_>, pipeline: &ComputePipeline) {
        pass.set_pipeline(pipeline);
        pass.set_bind_group(0, &self.control, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }

    /// The first words of the queues.
    fn header(&self, gpu: &Gpu) -> Result<[u32; 6], Error> {
        let mut words = [0; 6];
        gpu.download(&self.queues, bytemuck::cast_slice_mut(&mut words))?;
        Ok(words)
    }
}

use Access::{Read, Uniform, Write};

/// How kernels see a buffer.
#[derive(Clone, Copy)]
enum Access {
    Read,
    Write,
    Uniform,
}

fn layout(gpu: &Gpu, accesses: &[Access]) -> BindGroupLayout {
    let entries: Vec<_> = accesses
        .iter()
        .zip(0..)
        .map(|(access, binding)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer {
                ty: match access {
                    Read => wgpu::BufferBindingType::Storage { read_only: true },
                    Write => wgpu::BufferBindingType::Storage { read_only: false },
                    Uniform => wgpu::BufferBindingType::Uniform,
                },
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        })
        .collect();
    let descriptor = wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &entries,
    };
    gpu.device.create_bind_group_layout(&descriptor)
}

fn group(gpu: &Gpu, layout: &BindGroupLayout, buffers: &[&wgpu::Buffer]) -> BindGroup {
    let entries: Vec<_> = buffers
        .iter()
        .zip(0..)
        .map(|(buffer, binding)| wgpu::BindGroupEntry {
            binding,
            resource: buffer.as_entire_binding(),
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout,
        entries: &entries,
    })
}

fn pipeline_layout(gpu: &Gpu, groups: &[&BindGroupLayout]) -> PipelineLayout {
    let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
    gpu.device
        .create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &groups,
            immediate_size: 0,
        })
}
