//! A render on a GPU: on the processor until the kernels are compiled, then on the device, once its first samples have been
//! compared with the processor's.

use std::collections::BTreeMap;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use anyhow::{Result, bail};
use residual_device_cpu::{CpuDevice, Interpreter};
use residual_device_wgpu::{
    Dialect, FloatControls, Gpu, GpuPose, Mapping, Mode, Probe, WgpuRenderer,
};
use residual_frontend::stats::WgpuReport;
use residual_render::film::{Film, FilmTile, SampleSet, TILE_SIZE, TilePass};
use residual_render::passes::{Counters, Pass, RenderOptions};
use residual_render::tracer::{DebugView, TracerNode};
use residual_scenegen::plan::Plan;

use crate::poses::Poses;

/// Where bits may differ: the part of the pixels that may be off by more than [`FAR`], for paths that take another turn.
const MOST_FAR: f64 = 0.1;
/// Relative difference of a pixel that is more than roundings.
const FAR: f32 = 0.1;

/// A GPU that renders a plan.
pub struct GpuDriver<'a> {
    gpu: &'a Gpu,
    probe: Probe,
    plan: &'a Plan,
    poses: &'a Poses<'a>,
    mapping: Mapping,
    compiled: OnceLock<(
        Result<WgpuRenderer<'a>, residual_device_wgpu::Error>,
        Duration,
    )>,
}

impl<'a> GpuDriver<'a> {
    /// Nothing is compiled yet. The poses' hierarchies are four wide.
    pub fn new(
        gpu: &'a Gpu,
        probe: Probe,
        plan: &'a Plan,
        poses: &'a Poses<'a>,
        mapping: Mapping,
    ) -> Self {
        Self {
            gpu,
            probe,
            plan,
            poses,
            mapping,
            compiled: OnceLock::new(),
        }
    }

    /// Compiles the kernels for images of this size. Runs beside everything else.
    ///
    /// # Panics
    /// If the hierarchy is not four wide.
    pub fn compile(&self, size: [u32; 2]) {
        self.compiled.get_or_init(|| {
            let start = Instant::now();
            let bvh = self.poses.hierarchy(0).four_wide();
            let bvh = bvh.expect(FOUR_WIDE);
            let Plan {
                structure, data, ..
            } = self.plan;
            let dialect = self.probe.dialect;
            let renderer =
                WgpuRenderer::new(self.gpu, dialect, self.mapping, structure, data, bvh, size);
            let renderer = renderer.and_then(|renderer| {
                renderer.warm_up()?;
                Ok(renderer)
            });
            (renderer, start.elapsed())
        });
    }
}

/// The passes of one render.
pub struct GpuPasses<'a> {
    driver: &'a GpuDriver<'a>,
    cpu: &'a CpuDevice,
    interpreter: Interpreter,
    /// The poses behind the first that have been copied to the device.
    copied: BTreeMap<usize, GpuPose>,
    options: &'a RenderOptions,
    /// The processor's first sample, and how the device's agrees with it.
    first: Option<Film>,
    agreement: Option<Agreement>,
    /// Samples a pixel when the device took over.
    from: Option<u32>,
}

/// How the samples of two devices agree.
#[derive(Clone, Copy, Debug)]
struct Agreement {
    /// Pixels of the same bits, those far off, and all.
    same: usize,
    far: usize,
    pixels: usize,
}

impl Agreement {
    fn of(a: &Film, b: &Film) -> Self {
        let (a, b) = (a.image(), b.image());
        let is_far = |(a, b): &(&[f32; 3], &[f32; 3])| {
            a.iter()
                .zip(*b)
                .any(|(x, y)| (x - y).abs() > FAR * x.max(*y))
        };
        Self {
            same: a.iter().zip(&b).filter(|(a, b)| a == b).count(),
            far: a.iter().zip(&b).filter(is_far).count(),
            pixels: a.len(),
        }
    }
}

impl<'a> GpuPasses<'a> {
    /// Passes into a film of these options.
    pub fn new(driver: &'a GpuDriver<'a>, cpu: &'a CpuDevice, options: &'a RenderOptions) -> Self {
        Self {
            driver,
            cpu,
            interpreter: Interpreter::new(driver.plan.structure.clone()),
            copied: BTreeMap::new(),
            options,
            first: None,
            agreement: None,
            from: None,
        }
    }

    /// Adds a pass: on the device as soon as it can, on the processor before.
    ///
    /// # Errors
    /// If the device fails, or its samples are not the processor's.
    pub fn pass(&mut self, film: &mut Film, pass: Pass) -> Result<Counters> {
        // Samples of two kinds would make an image that depends on the time that compilers take.
        let is_mixed = self.driver.probe.is_exact() && !self.shows_traversal();
        if !is_mixed {
            self.driver.compile(self.options.size);
        }
        let Some((compiled, _)) = self.driver.compiled.get() else {
            let counters = self.on_cpu(film, pass);
            if pass == FIRST {
                self.first = Some(film.clone());
            }
            return Ok(counters);
        };
        let renderer = match compiled {
            Ok(renderer) => renderer,
            Err(error) => bail!("{error}"),
        };
        if self.agreement.is_none() {
            self.compare(renderer)?;
        }
        self.from.get_or_insert(pass.first);
        let mut counters = Counters::default();
        let mut left = pass;
        while left.count > 0 {
            let poses = self.driver.poses;
            let pose = poses.pose_of(left.first);
            let (now, later) = left.split_while(|sample| poses.pose_of(sample) == pose);
            counters += self.in_pose(renderer, pose, film, now)?;
            left = later;
        }
        Ok(counters)
    }

    /// Adds samples that see one pose, on the device.
    fn in_pose(
        &mut self,
        renderer: &WgpuRenderer<'_>,
        pose: usize,
        film: &mut Film,
        pass: Pass,
    ) -> Result<Counters> {
        self.copy(renderer, pose)?;
        let copied = self.copied.get(&pose);
        if self.driver.plan.structure.tracer.has_light_paths() {
            // It would need light paths of its own for all pixels, of which it has few.
            film.drop_second_set();
        }
        // The second set of samples, of few pixels, is the processor's: it would leave most of a GPU idle.
        let (first, second) = film.sets_mut();
        let (of_second, of_first) = std::thread::scope(|scope| {
            let of_second = scope.spawn(|| self.second(second, pose, pass));
            let tracer = self.options.tracer(SampleSet::First);
            let of_first = renderer.pass_in(copied, first, pass, &tracer);
            (of_second.join().expect("no tile panicked"), of_first)
        });
        let mut counters = of_first?;
        counters.count_rays_of(&of_second);
        Ok(counters)
    }

    /// Copies a pose to the device, unless it is there, as the first always is.
    fn copy(&mut self, renderer: &WgpuRenderer<'_>, pose: usize) -> Result<()> {
        if pose > 0 && !self.copied.contains_key(&pose) {
            let poses = self.driver.poses;
            let bvh = poses.hierarchy(pose).four_wide().expect(FOUR_WIDE);
            let copied = renderer.copy_pose(&poses.view(pose).buffers, bvh)?;
            self.copied.insert(pose, copied);
        }
        Ok(())
    }

    /// The image is of what traversal visits, which is another matter on each device.
    fn shows_traversal(&self) -> bool {
        self.driver.plan.structure.tracer == TracerNode::Debug(DebugView::TraversalCost)
    }

    /// The second set of samples.
    fn second(&self, tiles: Vec<(SampleSet, &mut FilmTile)>, pose: usize, pass: Pass) -> Counters {
        let (renderer, scene) = (&self.interpreter, &self.driver.poses.view(pose));
        let tiles = tiles.into_iter();
        let work = tiles.map(|(set, tile)| TilePass { set, pass, tile });
        self.cpu
            .tiles(renderer, scene, self.options, work.collect())
    }

    fn on_cpu(&self, film: &mut Film, pass: Pass) -> Counters {
        let Self {
            cpu,
            interpreter,
            options,
            driver,
            ..
        } = self;
        driver.poses.pass(cpu, interpreter, options, film, pass)
    }

    /// The first sample of each pixel, by both devices.
    fn compare(&mut self, renderer: &WgpuRenderer<'_>) -> Result<()> {
        let layers = self.driver.plan.structure.layers;
        let [width, height] = self.options.size;
        let film = || Film::new(width, height, TILE_SIZE, layers);
        let ours = self.first.take().unwrap_or_else(|| {
            let mut film = film();
            self.on_cpu(&mut film, FIRST);
            film
        });
        let mut theirs = film();
        let pose = self.driver.poses.pose_of(FIRST.first);
        self.copy(renderer, pose)?;
        renderer.pass_in(
            self.copied.get(&pose),
            theirs.tiles_mut(),
            FIRST,
            &self.options.tracer(SampleSet::First),
        )?;
        let agreement = Agreement::of(&ours, &theirs);
        let Agreement { same, far, pixels } = agreement;
        let adapter = &self.driver.gpu.adapter.name;
        let is_comparable = !self.shows_traversal();
        if is_comparable && far as f64 > MOST_FAR * pixels as f64 {
            bail!(
                "{adapter}: {far} of {pixels} pixels are far from the processor's in the first samples; \
                 its driver may be at fault; render with --device cpu"
            );
        }
        if is_comparable && self.driver.probe.is_exact() && same < pixels {
            eprintln!(
                "warning: {adapter}: {} of {pixels} pixels are not the processor's bit for bit",
                pixels - same
            );
        }
        self.agreement = Some(agreement);
        Ok(())
    }

    /// What statistics say of the device.
    pub fn report(&self) -> WgpuReport {
        let compiled = self.driver.compiled.get();
        let renderer = compiled.and_then(|(renderer, _)| renderer.as_ref().ok());
        let Probe {
            dialect, answers, ..
        } = &self.driver.probe;
        WgpuReport {
            adapter: self.driver.gpu.adapter.to_string(),
            arithmetic: arithmetic(dialect),
            answers: answers.to_string(),
            is_exact: self.driver.probe.is_exact(),
            mapping: self.driver.mapping.to_string(),
            compile: compiled.map_or(Duration::ZERO, |(_, time)| *time),
            from: self.from,
            agreement: self.agreement.map(|a| (a.same, a.pixels)),
            bytes: renderer.map_or(0, WgpuRenderer::memory_bytes)
                + self.copied.values().map(GpuPose::memory_bytes).sum::<u64>(),
        }
    }
}

/// Hierarchies for GPUs are.
const FOUR_WIDE: &str = "a hierarchy of four children";

/// The first sample of each pixel, which is also the first pass.
const FIRST: Pass = Pass { first: 0, count: 1 };

/// How kernels compute, in words.
pub fn arithmetic(dialect: &Dialect) -> String {
    let Dialect { mode, arithmetic } = dialect;
    let mode = match mode {
        Mode::Exact(FloatControls::Unstated) => "exact",
        Mode::Exact(FloatControls::Preserve) => "exact, float controls",
        Mode::Plain => "plain",
    };
    let operations = format!(
        "fma {:?}, division {:?}, square root {:?}",
        arithmetic.fma, arithmetic.division, arithmetic.square_root
    );
    format!("{mode}; {}", operations.to_lowercase())
}
