//! A scene on a device, rendered pass by pass into the same film as the processor's.

use std::ops::Range;
use std::time::Instant;

use rayon::prelude::*;
use residual_bvh::Bvh;
use residual_render::domain::Buffers;
use residual_render::film::FilmTile;
use residual_render::layer::Layers;
use residual_render::passes::{Counters, MAX_PASS, Pass};
use residual_render::program::Structure;
use residual_render::scene_data::SceneData;
use residual_render::tracer::{CostMap, PathOrigin, TracerOptions};
use residual_wgsl::{KernelSet, Mapping};

use crate::error::Error;
use crate::gpu::Gpu;
use crate::launch::{Places, Settings};
use crate::megakernel::Megakernel;
use crate::scene::Scene;
use crate::shader::{Dialect, Mode};
use crate::stages::{Stage, StageSeconds};
use crate::state::{Bound, Launched, Shown, State, bytes_per_path};
use crate::wavefront::Wavefront;

/// Paths under way at once: enough to fill a GPU.
const PATHS: u32 = 1 << 21;

/// Renders a scene on a GPU.
pub struct WgpuRenderer<'g> {
    gpu: &'g Gpu,
    kernels: Compiled,
    state: State,
    places: Places,
    layers: Layers,
    cost_map: Option<CostMap>,
    slots: u32,
    first: GpuPose,
    memory: u64,
}

/// A pose of a scene on the device.
pub struct GpuPose {
    scene: Scene,
    bound: Bound,
}

impl GpuPose {
    /// Bytes of its buffers, without those that it shares.
    pub fn memory_bytes(&self) -> u64 {
        self.scene.bytes
    }
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
        let sided = data.single_sided.contains(&true);
        let f64 = gpu.has(wgpu::Features::SHADER_F64);
        let kernels = KernelSet::new(structure, mapping, sided, f64, dialect.arithmetic);
        Self::with_kernels(gpu, dialect.mode, &kernels, data, bvh, size)
    }

    /// As [`new`](Self::new), with kernels that were made before.
    ///
    /// # Errors
    /// As there.
    pub fn with_kernels(
        gpu: &'g Gpu,
        mode: Mode,
        kernels: &KernelSet,
        data: &SceneData,
        bvh: &Bvh<4>,
        size: [u32; 2],
    ) -> Result<Self, Error> {
        let (layers, stride) = (kernels.layers, kernels.layers.stride());
        let places = Places::new(size);
        let slots = slots(gpu, places, stride);
        let queued = match kernels.mapping {
            Mapping::Wavefront => slots,
            Mapping::Megakernel => 1,
        };
        let scene = Scene::new(gpu, &data.buffers(), bvh, None)?;
        let state = State::new(gpu, kernels.queues, slots, queued, stride);
        let compiled = match kernels.mapping {
            Mapping::Wavefront => Compiled::Wavefront(Wavefront::new(gpu, mode, kernels, &state)?),
            Mapping::Megakernel => {
                Compiled::Megakernel(Megakernel::new(gpu, mode, kernels, &state)?)
            }
        };
        gpu.check()?;
        let memory = scene.bytes + state.bytes;
        let bound = state.bound(gpu, &scene);
        Ok(Self {
            gpu,
            kernels: compiled,
            state,
            places,
            layers,
            cost_map: kernels.shows_traversal.then_some(CostMap),
            slots,
            first: GpuPose { scene, bound },
            memory,
        })
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
            origin: PathOrigin::Camera,
        };
        let settings = self
            .places
            .settings(&options, self.slots, self.first.scene.first_packet)
            .of(0, 0, self.slots.min(64));
        let mut seconds = StageSeconds::default();
        let launched = self.launch(&self.first, &settings, 0, &mut seconds)?;
        self.state
            .collect(self.gpu, &launched, &mut seconds, |_| ())?;
        Ok(())
    }

    fn launch(
        &self,
        pose: &GpuPose,
        settings: &Settings,
        staging: usize,
        seconds: &mut StageSeconds,
    ) -> Result<Launched, Error> {
        let Self { gpu, state, .. } = self;
        let shown = Shown {
            state,
            pose: &pose.bound,
        };
        let bytes = 4 * u64::from(settings.count) * self.layers.stride() as u64;
        match &self.kernels {
            Compiled::Wavefront(kernels) => {
                kernels.launch(gpu, shown, settings, (staging, bytes), seconds)
            }
            Compiled::Megakernel(kernels) => {
                Ok(kernels.launch(gpu, shown, settings, (staging, bytes)))
            }
        }
    }

    /// Bytes of the scene and of the paths under way.
    pub fn memory_bytes(&self) -> u64 {
        self.memory
    }

    /// Adds a pass of samples to a film's tiles, which cover the image.
    ///
    /// # Errors
    /// If the device fails; the film then has none of the samples of the batch that failed.
    pub fn pass(
        &self,
        film: &mut [FilmTile],
        pass: Pass,
        options: &TracerOptions,
    ) -> Result<Counters, Error> {
        self.pass_in(None, film, pass, options)
    }

    /// Copies another pose of the scene to the device: data of the same structure, with the same textures, and its hierarchy.
    ///
    /// # Errors
    /// If it does not fit.
    pub fn copy_pose(&self, data: &Buffers<'_>, bvh: &Bvh<4>) -> Result<GpuPose, Error> {
        let scene = Scene::new(self.gpu, data, bvh, Some(&self.first.scene))?;
        let bound = self.state.bound(self.gpu, &scene);
        self.gpu.check()?;
        Ok(GpuPose { scene, bound })
    }

    /// As [`pass`](Self::pass), of a pose of the scene; of the first where none is given.
    ///
    /// # Errors
    /// As there.
    pub fn pass_in(
        &self,
        pose: Option<&GpuPose>,
        film: &mut [FilmTile],
        pass: Pass,
        options: &TracerOptions,
    ) -> Result<Counters, Error> {
        let pose = pose.unwrap_or(&self.first);
        let mut counters = Counters::default();
        let mut seconds = StageSeconds::default();
        let mut whole = Vec::new();
        let mut before: Option<Launched> = None;
        // The processor adds the samples of one launch while the device is at the next.
        for (index, settings) in self.launches(pose, pass, options).enumerate() {
            let launched = self.launch(pose, &settings, index % 2, &mut seconds)?;
            if let Some(before) = before.replace(launched) {
                self.finish(&before, film, &mut whole, &mut counters, &mut seconds)?;
            }
        }
        if let Some(last) = before {
            self.finish(&last, film, &mut whole, &mut counters, &mut seconds)?;
        }
        let [width, height] = options.image.map(u64::from);
        counters.camera_rays = width * height * u64::from(pass.count);
        counters.emit = seconds[Stage::Emit as usize];
        counters.trace_camera = seconds[Stage::TraceCamera as usize];
        counters.trace_bounce = seconds[Stage::TraceOn as usize];
        counters.sort = seconds[Stage::Sort as usize];
        counters.shade = seconds[Stage::Shade as usize];
        Ok(counters)
    }

    /// The launches of a pass: of whole samples, or of parts of one sample of a large image.
    fn launches(
        &self,
        pose: &GpuPose,
        pass: Pass,
        options: &TracerOptions,
    ) -> impl Iterator<Item = Settings> {
        let per_sample = self.places.count();
        let batch = (self.slots / per_sample).max(1);
        let first_packet = pose.scene.first_packet;
        let settings = self.places.settings(options, self.slots, first_packet);
        let slots = self.slots;
        (0..pass.count)
            .step_by(batch as usize)
            .flat_map(move |first_sample| {
                let places = batch.min(pass.count - first_sample) * per_sample;
                (0..places).step_by(slots as usize).map(move |first| {
                    settings.of(pass.first + first_sample, first, slots.min(places - first))
                })
            })
    }

    /// Waits for a launch, and adds its samples to the film as soon as they are whole; `parts` has what is not yet.
    fn finish(
        &self,
        launched: &Launched,
        film: &mut [FilmTile],
        parts: &mut Vec<f32>,
        counters: &mut Counters,
        seconds: &mut StageSeconds,
    ) -> Result<(), Error> {
        let sample = self.places.count() as usize * self.layers.stride();
        let mut film_seconds = 0.0;
        let did = self.state.collect(self.gpu, launched, seconds, |values| {
            let start = Instant::now();
            if values.len() >= sample {
                self.add_to(film, values);
            } else {
                parts.extend_from_slice(values);
                if parts.len() == sample {
                    self.add_to(film, parts);
                    parts.clear();
                }
            }
            film_seconds = start.elapsed().as_secs_f64();
        })?;
        counters.film += film_seconds;
        counters.bounce_rays += u64::from(did.bounce_rays);
        counters.shadow_rays += u64::from(did.shadow_rays);
        Ok(())
    }

    /// Adds whole samples, `values[sample][place][channel]`.
    fn add_to(&self, film: &mut [FilmTile], values: &[f32]) {
        let stride = self.layers.stride();
        film.par_iter_mut().for_each(|tile| {
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
