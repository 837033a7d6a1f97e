//! A scene on a device, rendered pass by pass into the same film as the processor's.

use std::fmt;
use std::ops::Range;

use rayon::prelude::*;
use residual_bvh::Bvh;
use residual_render::film::Film;
use residual_render::layer::Layers;
use residual_render::passes::{Counters, MAX_PASS, Pass};
use residual_render::program::Structure;
use residual_render::scene_data::SceneData;
use residual_render::tracer::{CostMap, DebugView, TracerNode, TracerOptions};

use crate::error::Error;
use crate::gpu::Gpu;
use crate::kernels::{Kernels, Traits};
use crate::launch::{Places, Settings};
use crate::megakernel::Megakernel;
use crate::scene::Scene;
use crate::shader::Dialect;
use crate::stages::{Stage, Stopwatch};
use crate::state::{Header, State, bytes_per_path};
use crate::wavefront::Wavefront;

/// Paths under way at once: enough to fill a GPU.
const PATHS: u32 = 1 << 20;

/// How work is divided into kernels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mapping {
    /// A kernel for each kind of work, between which paths wait in queues.
    #[default]
    Wavefront,
    /// One kernel, in which a thread follows a path to its end.
    Megakernel,
}

impl fmt::Display for Mapping {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Wavefront => "wavefront",
            Self::Megakernel => "megakernel",
        })
    }
}

/// Renders a scene on a GPU.
pub struct WgpuRenderer<'g> {
    gpu: &'g Gpu,
    kernels: Compiled,
    state: State,
    places: Places,
    layers: Layers,
    cost_map: Option<CostMap>,
    slots: u32,
    first_packet: u32,
    memory: u64,
}

/// Kernels of either mapping.
enum Compiled {
    Wavefront(Wavefront),
    Megakernel(Megakernel),
}

impl<'g> WgpuRenderer<'g> {
    /// Copies the scene to the device and compiles its kernels, for images of this size.
    ///
    /// # Errors
    /// If something does not fit, or a kernel is refused.
    pub fn new(
        gpu: &'g Gpu,
        dialect: Dialect,
        mapping: Mapping,
        structure: &Structure,
        data: &SceneData,
        bvh: &Bvh<4>,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let (layers, stride) = (structure.layers, structure.layers.stride());
        let shows_traversal = structure.tracer == TracerNode::Debug(DebugView::TraversalCost);
        let traits = Traits {
            sided: data.single_sided.contains(&true),
            visits: shows_traversal,
            f64: gpu.has(wgpu::Features::SHADER_F64),
        };
        let kernels = Kernels::new(structure, traits, dialect.arithmetic);
        let places = Places::new(size);
        let slots = slots(gpu, places, stride);
        let queued = match mapping {
            Mapping::Wavefront => slots,
            Mapping::Megakernel => 1,
        };
        let scene = Scene::new(gpu, data, bvh)?;
        let state = State::new(gpu, &scene, kernels.queues(), slots, queued, stride);
        let mode = dialect.mode;
        let compiled = match mapping {
            Mapping::Wavefront => Compiled::Wavefront(Wavefront::new(gpu, mode, &kernels, &state)?),
            Mapping::Megakernel => {
                Compiled::Megakernel(Megakernel::new(gpu, mode, &kernels, &state)?)
            }
        };
        gpu.check()?;
        Ok(Self {
            gpu,
            kernels: compiled,
            state,
            places,
            layers,
            cost_map: shows_traversal.then_some(CostMap),
            slots,
            first_packet: scene.first_packet,
            memory: scene.bytes + u64::from(slots) * bytes_per_path(stride),
        })
    }

    /// The image is of what traversal visits, which depends on the hierarchy.
    pub fn shows_traversal(&self) -> bool {
        self.cost_map.is_some()
    }

    /// Runs the kernels once, on few paths: some drivers compile no sooner.
    ///
    /// # Errors
    /// If the device fails.
    pub fn warm_up(&self) -> Result<(), Error> {
        let [width, height] = [64; 2];
        let options = TracerOptions {
            image: [width, height],
            seed: 0,
            max_depth: 2,
            roulette_from: 2,
            reach: f32::MAX,
        };
        let mut settings = self
            .places
            .settings(&options, self.slots, self.first_packet);
        settings.count = self.slots.min(64);
        self.launch(&settings, &mut Stopwatch::new(self.gpu))?;
        Ok(())
    }

    fn launch(&self, settings: &Settings, watch: &mut Stopwatch) -> Result<Header, Error> {
        match &self.kernels {
            Compiled::Wavefront(kernels) => kernels.launch(self.gpu, &self.state, settings, watch),
            Compiled::Megakernel(kernels) => kernels.launch(self.gpu, &self.state, settings, watch),
        }
    }

    /// Bytes of the scene and of the paths under way.
    pub fn memory_bytes(&self) -> u64 {
        self.memory
    }

    /// Adds a pass of samples to a film.
    ///
    /// # Errors
    /// If the device fails; the film then has none of the samples of the batch that failed.
    pub fn pass(
        &self,
        film: &mut Film,
        pass: Pass,
        options: &TracerOptions,
    ) -> Result<Counters, Error> {
        let per_sample = self.places.count();
        let stride = self.layers.stride();
        let mut watch = Stopwatch::new(self.gpu);
        let mut counters = Counters::default();
        // Whole samples at a time; a large image is put together from several launches.
        let batch = (self.slots / per_sample).clamp(1, pass.count);
        let mut first_sample = pass.first;
        let end = pass.first + pass.count;
        while first_sample < end {
            let samples = batch.min(end - first_sample);
            let all = samples * per_sample;
            let mut values = vec![0.0; all as usize * stride];
            for first in (0..all).step_by(self.slots as usize) {
                let count = self.slots.min(all - first);
                let mut settings = self.places.settings(options, self.slots, self.first_packet);
                settings.first_sample = first_sample;
                settings.first = first;
                settings.count = count;
                let did = self.launch(&settings, &mut watch)?;
                counters.bounce_rays += u64::from(did.bounce_rays);
                counters.shadow_rays += u64::from(did.shadow_rays);
                let part = range(first, count, stride);
                let bytes = bytemuck::cast_slice_mut(&mut values[part]);
                self.gpu.download(&self.state.samples, bytes)?;
            }
            let film_start = std::time::Instant::now();
            self.add_to(film, &values);
            counters.film += film_start.elapsed().as_secs_f64();
            first_sample += samples;
        }
        let [width, height] = options.image.map(u64::from);
        counters.camera_rays = width * height * u64::from(pass.count);
        let seconds = |stage: Stage| watch.seconds[stage as usize];
        counters.emit = seconds(Stage::Emit);
        counters.trace_camera = seconds(Stage::TraceCamera);
        counters.trace_bounce = seconds(Stage::TraceOn);
        counters.sort = seconds(Stage::Sort);
        counters.shade = seconds(Stage::Shade);
        Ok(counters)
    }

    /// Adds whole samples, `values[sample][place][channel]`.
    fn add_to(&self, film: &mut Film, values: &[f32]) {
        let stride = self.layers.stride();
        film.tiles_mut().par_iter_mut().for_each(|tile| {
            let rect = tile.rect();
            let mut of_tile = Vec::with_capacity(rect.area() * stride);
            for sample in values.chunks_exact(self.places.count() as usize * stride) {
                of_tile.clear();
                for y in rect.y..rect.y + rect.height {
                    for x in rect.x..rect.x + rect.width {
                        let row = range(self.places.of(x, y), 1, stride);
                        let first = of_tile.len();
                        of_tile.extend_from_slice(&sample[row]);
                        if let Some(map) = self.cost_map {
                            let color = map.color(of_tile[first] as u32);
                            of_tile[first..first + Layers::RADIANCE].copy_from_slice(&color);
                        }
                    }
                }
                tile.add(&of_tile);
            }
        });
    }
}

/// Where the numbers of some samples stand.
fn range(first: u32, count: u32, stride: usize) -> Range<usize> {
    let first = first as usize * stride;
    first..first + count as usize * stride
}

/// How many paths are under way at once.
fn slots(gpu: &Gpu, places: Places, stride: usize) -> u32 {
    let limits = gpu.device.limits();
    let most_bytes = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let fitting = most_bytes / bytes_per_path(stride);
    let most = u64::from(PATHS)
        .min(fitting)
        .min(64 * u64::from(limits.max_compute_workgroups_per_dimension)) as u32;
    let places = places.count();
    match most / places {
        // A large image: parts of samples.
        0 => most,
        samples => samples.min(MAX_PASS) * places,
    }
}
