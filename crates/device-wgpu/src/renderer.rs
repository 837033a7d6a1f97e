//! A scene on a device, rendered pass by pass into the same film as the processor's.

use std::time::Instant;

use residual_bvh::Bvh;
use residual_render::domain::Buffers;
use residual_render::film::{FilmTile, Splats};
use residual_render::layer::Layers;
use residual_render::passes::{Counters, MAX_PASS, Pass};
use residual_render::program::Structure;
use residual_render::scene_data::SceneData;
use residual_render::tracer::{CostMap, PathOrigin, TracerOptions};
use residual_wgsl::{KernelSet, Mapping};

use crate::adding::{Adding, Samples};
use crate::compiled::Compiled;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::launch::{Places, Settings};
use crate::light_pass::LightPass;
use crate::scene::Scene;
use crate::shader::{Dialect, Mode};
use crate::stages::{Stage, StageSeconds};
use crate::state::{Bound, Launched, Shape, Shown, State};

/// Paths under way at once: enough to fill a GPU.
const PATHS: u32 = 1 << 21;

/// Renders a scene on a GPU.
pub struct WgpuRenderer<'g> {
    gpu: &'g Gpu,
    kernels: Compiled,
    /// Of paths from lights, where a sample also has one of them for each pixel.
    light_kernels: Option<Compiled>,
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
        let layers = kernels.layers;
        let lights = kernels.of(PathOrigin::Lights);
        let shape = Shape {
            queues: kernels.queues,
            stride: layers.stride(),
            has_light_paths: lights.is_some(),
        };
        let places = Places::new(size);
        let slots = slots(gpu, places, shape);
        let queued = match kernels.mapping {
            Mapping::Wavefront => slots,
            Mapping::Megakernel => 1,
        };
        let scene = Scene::new(gpu, &data.buffers(), bvh, None)?;
        let state = State::new(gpu, shape, slots, queued);
        let compile = |texts| Compiled::new(gpu, mode, kernels.mapping, texts, &state);
        let camera = kernels
            .of(PathOrigin::Camera)
            .ok_or(Error::NoKernel { name: "emit" })?;
        let compiled = compile(camera)?;
        let light_kernels = lights.map(compile).transpose()?;
        gpu.check()?;
        let memory = scene.bytes + state.bytes;
        let bound = state.bound(gpu, &scene);
        Ok(Self {
            gpu,
            kernels: compiled,
            light_kernels,
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
            .collect(self.gpu, &launched, &mut seconds, |_, _| ())?;
        if let Some(kernels) = &self.light_kernels {
            let pass = self.light_pass(kernels, &self.first, &options);
            pass.warm_up(&mut seconds)?;
        }
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
        let returns = (staging, bytes);
        self.kernels
            .launch(gpu, shown, settings, returns, seconds, |_, _| ())
    }

    /// What a pass of light paths needs that are traced by these kernels.
    fn light_pass<'a>(
        &'a self,
        kernels: &'a Compiled,
        pose: &'a GpuPose,
        options: &TracerOptions,
    ) -> LightPass<'a> {
        let first_packet = pose.scene.first_packet;
        let places = self.places;
        LightPass {
            gpu: self.gpu,
            kernels,
            state: Shown {
                state: &self.state,
                pose: &pose.bound,
            },
            settings: places.settings_of_lights(options, self.slots, first_packet),
            slots: self.slots,
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
        let kernels = self.light_kernels.as_ref();
        let lights = kernels.map(|kernels| self.light_pass(kernels, pose, options));
        let parts = match lights {
            None => vec![pass],
            Some(_) => Splats::parts(pass, options.image).collect(),
        };
        for part in parts {
            let splats = lights
                .as_ref()
                .map(|lights| lights.splats(part, options.image, &mut counters, &mut seconds))
                .transpose()?;
            self.add_pass(
                pose,
                film,
                part,
                options,
                splats.as_ref(),
                &mut counters,
                &mut seconds,
            )?;
        }
        counters.emit = seconds[Stage::Emit as usize];
        counters.trace_camera = seconds[Stage::TraceCamera as usize];
        counters.trace_bounce = seconds[Stage::TraceOn as usize];
        counters.sort = seconds[Stage::Sort as usize];
        counters.shade = seconds[Stage::Shade as usize];
        Ok(counters)
    }

    /// Adds samples of paths from the camera, and what light paths bring to them.
    fn add_pass(
        &self,
        pose: &GpuPose,
        film: &mut [FilmTile],
        pass: Pass,
        options: &TracerOptions,
        splats: Option<&Splats>,
        counters: &mut Counters,
        seconds: &mut StageSeconds,
    ) -> Result<(), Error> {
        let samples = Samples {
            places: self.places,
            layers: self.layers,
            cost_map: self.cost_map,
        };
        let mut adding = Adding::new(samples, film, splats);
        let mut before: Option<Launched> = None;
        // The processor adds the samples of one launch while the device is at the next.
        for (index, settings) in self.launches(pose, pass, options).enumerate() {
            let launched = self.launch(pose, &settings, index % 2, seconds)?;
            if let Some(before) = before.replace(launched) {
                self.finish(&before, &mut adding, counters, seconds)?;
            }
        }
        if let Some(last) = before {
            self.finish(&last, &mut adding, counters, seconds)?;
        }
        let [width, height] = options.image.map(u64::from);
        counters.camera_rays += width * height * u64::from(pass.count);
        Ok(())
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

    /// Waits for a launch, and adds its samples to the film as soon as they are whole.
    fn finish(
        &self,
        launched: &Launched,
        adding: &mut Adding<'_>,
        counters: &mut Counters,
        seconds: &mut StageSeconds,
    ) -> Result<(), Error> {
        let mut film_seconds = 0.0;
        let take = |_: &_, values: &[f32]| {
            let start = Instant::now();
            adding.take(values);
            film_seconds = start.elapsed().as_secs_f64();
        };
        let did = self.state.collect(self.gpu, launched, seconds, take)?;
        counters.film += film_seconds;
        counters.bounce_rays += u64::from(did.bounce_rays);
        counters.shadow_rays += u64::from(did.shadow_rays);
        Ok(())
    }
}

/// How many paths are under way at once.
fn slots(gpu: &Gpu, places: Places, shape: Shape) -> u32 {
    let limits = gpu.device.limits();
    let most_bytes = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size);
    let fitting = most_bytes / shape.bytes_per_path();
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
