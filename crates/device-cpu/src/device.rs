//! Scheduling: passes of samples over all tiles, tiles spread over threads.

use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use rayon::prelude::*;
use residual_render::film::Film;
use residual_render::layer::Layers;
use residual_render::tracer::TracerOptions;

use crate::job::{Counters, SceneView, TileJob, TileRenderer};

/// Pixels along the side of a tile. A wave of 4,096 paths with all its columns fits the second-level cache.
const TILE_SIZE: u32 = 64;
/// Passes grow until one takes about this long, so that progress is shown, time limits are kept and a wish to stop is
/// heard.
const PASS_TIME: Duration = Duration::from_millis(250);
/// Most samples in one pass.
const MAX_PASS: u32 = 16;
/// The first vertex at which roulette may end a path.
const ROULETTE_FROM: u32 = 5;

/// What is to be rendered, and when to stop.
#[derive(Clone, Debug)]
pub struct RenderOptions {
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    /// Samples a pixel; `None` leaves the end to `time`.
    pub samples: Option<u32>,
    /// Stop after the pass in which this much time has gone by.
    pub time: Option<Duration>,
    /// Most vertices a path may have; 1 is emission seen directly, 2 adds direct light.
    pub max_depth: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// How far occluders count for ambient occlusion, and where the depth view turns black, in units of the scene.
    pub reach: f32,
}

impl Default for RenderOptions {
    /// 64 samples of 640 × 480 pixels, paths of at most 8 vertices.
    fn default() -> Self {
        Self {
            size: [640, 480],
            samples: Some(64),
            time: None,
            max_depth: 8,
            seed: 0,
            reach: f32::MAX,
        }
    }
}

impl RenderOptions {
    fn tracer(&self) -> TracerOptions {
        TracerOptions {
            image: self.size,
            seed: self.seed,
            max_depth: self.max_depth,
            roulette_from: ROULETTE_FROM,
            reach: self.reach,
        }
    }
}

/// How far a render has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    /// Samples a pixel so far.
    pub samples: u32,
    /// Since the start of rendering.
    pub elapsed: Duration,
    /// The image so far.
    pub film: &'a Film,
}

/// What was done.
#[derive(Clone, Debug)]
pub struct RenderReport {
    /// Rays and stage times, over all threads.
    pub counters: Counters,
    /// Time on the clock.
    pub elapsed: Duration,
    /// Threads used.
    pub threads: usize,
}

/// Threads that render.
pub struct CpuDevice {
    pool: rayon::ThreadPool,
    tile_size: u32,
}

impl CpuDevice {
    /// A device with this many threads; 0 is one for each processor.
    ///
    /// # Errors
    /// If the system gives no threads.
    pub fn new(threads: usize) -> Result<Self, rayon::ThreadPoolBuildError> {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?;
        Ok(Self {
            pool,
            tile_size: TILE_SIZE,
        })
    }

    /// The same device with tiles of this many pixels along their sides. Images do not depend on it.
    #[must_use]
    pub fn with_tile_size(self, tile_size: u32) -> Self {
        Self {
            tile_size: tile_size.max(1),
            ..self
        }
    }

    /// Renders until the options say stop. Between passes `renderer` is asked anew which renderer to use, so that a
    /// compiled one can take over from the interpreter; all give the same bits. `progress`, called after each pass, may
    /// break: the film is then what there is so far.
    pub fn render<'r>(
        &self,
        mut renderer: impl FnMut() -> &'r dyn TileRenderer,
        scene: &SceneView<'_>,
        options: &RenderOptions,
        mut progress: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> (Film, RenderReport) {
        let mut film = None;
        let start = Instant::now();
        let counters = Mutex::new(Counters::default());
        let mut done = 0;
        let mut pass = 1;
        loop {
            let left = options
                .samples
                .map_or(u32::MAX, |samples| samples.saturating_sub(done));
            let late = options.time.is_some_and(|time| start.elapsed() >= time);
            if left == 0 || (late && done > 0) {
                break;
            }
            let count = pass.min(left);
            let renderer = renderer();
            let layers = renderer.layers();
            let film = film.get_or_insert_with(|| self.film(options, layers));
            assert_eq!(film.layers(), layers, "one film, one set of layers");
            let pass_start = Instant::now();
            self.pool.install(|| {
                film.tiles_mut().par_iter_mut().for_each(|tile| {
                    let rect = tile.rect();
                    let job = TileJob {
                        tile: [rect.x, rect.y, rect.width, rect.height],
                        samples: [done, count],
                        tracer: options.tracer(),
                    };
                    let mut samples = vec![0.0; rect.area() * layers.stride() * count as usize];
                    let mut did = renderer.render_tile(scene, &job, &mut samples);
                    let film_start = Instant::now();
                    tile.add(&samples);
                    did.film = film_start.elapsed().as_secs_f64();
                    *counters.lock().expect("no tile panicked") += did;
                });
            });
            done += count;
            let so_far = Progress {
                samples: done,
                elapsed: start.elapsed(),
                film,
            };
            if progress(so_far).is_break() {
                break;
            }
            if pass_start.elapsed() < PASS_TIME {
                pass = (pass * 2).min(MAX_PASS);
            }
        }
        let report = RenderReport {
            counters: counters.into_inner().expect("no tile panicked"),
            elapsed: start.elapsed(),
            threads: self.pool.current_num_threads(),
        };
        let film = film.unwrap_or_else(|| self.film(options, Layers::NONE));
        (film, report)
    }

    fn film(&self, options: &RenderOptions, layers: Layers) -> Film {
        let [width, height] = options.size;
        Film::new(width, height, self.tile_size, layers)
    }
}
