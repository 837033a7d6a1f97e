//! Configurations made ready to render.

use std::rc::Rc;
use std::time::Duration;

use anyhow::{Context, Result};
use residual_accuracy::luminance;
use residual_device_cpu::plugin::LoadedRenderer;
use residual_device_cpu::{AnyBvh, CpuDevice, SceneView, TileJob, TileRenderer, Width};
use residual_driver::compile;
use residual_frontend::{hierarchy_quality, process_time};
use residual_render::film::{Film, SampleSet, TILE_SIZE, TileRect, TileSamples};
use residual_render::layer::Layers;
use residual_render::passes::{Counters, Pass, RenderOptions};
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::plan::{Plan, plan};
use residual_variants::AnyLanes;

use crate::configuration::{Setup, Tier};
use residual_variants::TraversalPrecision;

/// A scene in one configuration, ready to be rendered.
pub struct Prepared {
    plan: Plan,
    bvh: Rc<AnyBvh>,
    precision: TraversalPrecision,
    renderer: Box<dyn TileRenderer>,
    options: RenderOptions,
}

/// Samples that are cut off where they are brighter than so much.
struct Clamped {
    renderer: Box<dyn TileRenderer>,
    /// Luminance.
    most: f64,
}

impl TileRenderer for Clamped {
    fn layers(&self) -> Layers {
        self.renderer.layers()
    }

    fn has_light_paths(&self) -> bool {
        self.renderer.has_light_paths()
    }

    fn render_tiles(
        &self,
        scene: &SceneView<'_>,
        job: &TileJob<'_>,
        samples: &mut [f32],
    ) -> Counters {
        let counters = self.renderer.render_tiles(scene, job, samples);
        for sample in samples.chunks_exact_mut(self.layers().stride()) {
            let brightness = luminance([sample[0], sample[1], sample[2]]);
            if brightness > self.most {
                let factor = (self.most / brightness) as f32;
                sample[..3].iter_mut().for_each(|value| *value *= factor);
            }
        }
        counters
    }
}

/// Makes configurations ready, and shares hierarchies among those with the same triangles.
pub struct Preparation<'a> {
    scene: &'a SceneDesc,
    built: Option<(Vec<[f32; 3]>, Rc<AnyBvh>)>,
}

impl<'a> Preparation<'a> {
    /// For configurations of this scene.
    pub fn new(scene: &'a SceneDesc) -> Self {
        Self { scene, built: None }
    }

    /// Plans, builds, and compiles if the configuration is compiled. `mean` is the mean luminance of the image, to which clamping is
    /// relative.
    ///
    /// # Errors
    /// If the scene cannot be planned, or its renderer not be compiled.
    pub fn prepare(&mut self, setup: &Setup, mean: f64) -> Result<Prepared> {
        let plan = plan(self.scene, &setup.plan)?;
        let renderer: Box<dyn TileRenderer> = match setup.tier {
            Tier::Interpreted => Box::new(AnyLanes::new(plan.structure.clone(), setup.lanes)),
            Tier::Specialized => {
                let compiled: LoadedRenderer = compile(&plan, setup.lanes)
                    .context("--tier interpreted renders without a compiler")?;
                Box::new(compiled)
            }
        };
        let renderer = match setup.clamp {
            Some(times) => Box::new(Clamped {
                renderer,
                most: times * mean,
            }),
            None => renderer,
        };
        Ok(Prepared {
            bvh: self.hierarchy(&plan),
            plan,
            precision: setup.precision,
            renderer,
            options: setup.render.clone(),
        })
    }

    fn hierarchy(&mut self, plan: &Plan) -> Rc<AnyBvh> {
        let positions = plan.data.positions();
        if let Some((of, bvh)) = &self.built
            && *of == positions
        {
            return Rc::clone(bvh);
        }
        let quality = hierarchy_quality(plan.data.triangle_count());
        let bvh = Rc::new(AnyBvh::build(&plan.data, Width::Native, quality));
        self.built = Some((positions, Rc::clone(&bvh)));
        bvh
    }
}

impl Prepared {
    /// What was planned.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Renders with this seed, and shows what there is after each of these ascending numbers of samples.
    pub fn render(
        &self,
        device: &CpuDevice,
        seed: u32,
        counts: &[u32],
        mut look: impl FnMut(SoFar<'_>),
    ) {
        let options = RenderOptions {
            seed,
            ..self.options.clone()
        };
        let mut film = Film::sampled_by(options.sampling, options.size, TILE_SIZE, Layers::NONE);
        let traversal = self.precision.of(&self.bvh);
        let view = SceneView {
            buffers: self.plan.data.buffers(),
            traversal: &*traversal,
        };
        let mut cpu = Duration::ZERO;
        for &samples in counts {
            let before = process_time();
            device.render_until(&*self.renderer, &view, &options, &mut film, samples);
            cpu += process_time() - before;
            look(SoFar {
                samples,
                seconds: cpu.as_secs_f64(),
                film: &film,
            });
        }
    }

    /// Samples of one tile in the middle of the image, `count` of each pixel: red, green and blue, sample by sample.
    pub fn samples(&self, count: u32) -> Vec<[f32; 3]> {
        let [width, height] = self.options.size;
        let rect = TileRect {
            x: width / 2,
            y: height / 2,
            width: (width - width / 2).min(16),
            height: (height - height / 2).min(16),
        };
        let view = SceneView {
            buffers: self.plan.data.buffers(),
            traversal: &*self.bvh,
        };
        let pass = Pass { first: 0, count };
        let set = SampleSet::First;
        let job = TileJob {
            tiles: &[TileSamples { rect, pass }],
            set,
            tracer: self.options.tracer(set),
        };
        let mut samples = vec![0.0; rect.area() * Layers::RADIANCE * count as usize];
        self.renderer.render_tiles(&view, &job, &mut samples);
        samples.as_chunks().0.to_vec()
    }
}

/// What a render has reached.
#[derive(Clone, Copy, Debug)]
pub struct SoFar<'a> {
    /// Samples of a pixel.
    pub samples: u32,
    /// CPU seconds of rendering.
    pub seconds: f64,
    /// The image.
    pub film: &'a Film,
}
