//! Ray queries on a device, apart from any scene.

use residual_bvh::{Bvh, Hit, Ray};
use residual_wgsl::{WORKGROUP, rays_kernel};
use wgpu::{BufferUsages, ComputePipeline, Features};

use crate::bindings::Access::{Read, Uniform, Write};
use crate::bindings::{group, layout, pipeline_layout};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::shader::{Dialect, pipeline};
use crate::stages::{Clock, Stage};
use crate::tree::Tree;

/// A hierarchy on a device.
pub struct RayQueries<'g> {
    gpu: &'g Gpu,
    kernel: ComputePipeline,
    layout: wgpu::BindGroupLayout,
    tree: wgpu::Buffer,
    first_packet: u32,
}

impl<'g> RayQueries<'g> {
    /// Copies a hierarchy to the device.
    ///
    /// # Errors
    /// If it is too deep for the kernel's stack, or the kernel is refused.
    pub fn new(gpu: &'g Gpu, dialect: Dialect, bvh: &Bvh<4>) -> Result<Self, Error> {
        let Tree {
            words,
            first_packet,
        } = Tree::new(bvh)?;
        let layout = layout(gpu, &[Read, Read, Write, Uniform]);
        let pipelines = pipeline_layout(gpu, &[&layout]);
        let text = rays_kernel(dialect.arithmetic, gpu.has(Features::SHADER_F64));
        Ok(Self {
            gpu,
            kernel: pipeline(gpu, dialect.mode, &pipelines, &text, "trace_rays")?,
            layout,
            tree: gpu.upload("tree", &words, BufferUsages::STORAGE),
            first_packet,
        })
    }

    /// The nearest hit of each ray, or any: at most 65,535 · 64 rays, each from its origin on. Beside the hits, the
    /// seconds that the device took, 0 where it has no clock.
    ///
    /// # Errors
    /// If the device fails.
    pub fn trace(&self, rays: &[Ray], any_hit: bool) -> Result<(Vec<Hit>, f64), Error> {
        let row = |ray: &Ray| {
            let [ox, oy, oz] = ray.org.map(f32::to_bits);
            let [dx, dy, dz] = ray.dir.map(f32::to_bits);
            [ox, oy, oz, any_hit.into(), dx, dy, dz, ray.tmax.to_bits()]
        };
        let rows: Vec<u32> = rays.iter().flat_map(row).collect();
        let from = self.gpu.upload("rays", &rows, BufferUsages::STORAGE);
        let usage = BufferUsages::STORAGE | BufferUsages::COPY_SRC;
        let to = self.gpu.buffer("hits", 16 * rays.len() as u64, usage);
        let settings = [rays.len() as u32, self.first_packet];
        let settings = self
            .gpu
            .upload("settings", &settings, BufferUsages::UNIFORM);
        let group = group(self.gpu, &self.layout, &[&self.tree, &from, &to, &settings]);
        let clock = Clock::new(self.gpu);
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let laps = {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.kernel);
            pass.set_bind_group(0, &group, &[]);
            let mut laps = clock.begin(&mut pass);
            pass.dispatch_workgroups((rays.len() as u32).div_ceil(WORKGROUP), 1, 1);
            clock.lap(&mut pass, &mut laps, Stage::TraceCamera);
            laps
        };
        let ticks = self
            .gpu
            .buffer("ticks", Clock::BYTES, BufferUsages::COPY_SRC);
        clock.copy(&mut encoder, &laps, &ticks, 0);
        self.gpu.queue.submit([encoder.finish()]);
        let (mut bytes, mut seconds) = ([0; Clock::BYTES as usize], [0.0; Stage::COUNT]);
        self.gpu.download(&ticks, &mut bytes)?;
        clock.add(&laps, &bytes, &mut seconds);
        let mut words = vec![0_u32; 4 * rays.len()];
        self.gpu
            .download(&to, bytemuck::cast_slice_mut(&mut words))?;
        let hits = words.as_chunks().0.iter().map(|&[t, u, v, prim]| Hit {
            t: f32::from_bits(t),
            u: f32::from_bits(u),
            v: f32::from_bits(v),
            prim,
        });
        Ok((hits.collect(), seconds[Stage::TraceCamera as usize]))
    }
}
