//! Scheduling: passes of samples over all tiles, tiles spread over threads.

use std::convert::Infallible;
use std::ops::ControlFlow;
use std::sync::Mutex;
use std::time::Instant;

use rayon::prelude::*;
use residual_render::film::{Film, SampleSet, Splats, TILE_SIZE, TilePass, TileRect, TileSamples};
use residual_render::passes::{
    Counters, MAX_PASS, Pass, Progress, RenderOptions, RenderReport, render_passes,
};
use residual_render::tracer::{PathOrigin, TracerOptions};

use crate::job::{SceneView, TileJob, TileRenderer};

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

    /// How many threads there are.
    pub fn threads(&self) -> usize {
        self.pool.current_num_threads()
    }

    /// Adds a pass of samples to a film that has the renderer's layers, and to its second set.
    ///
    /// # Panics
    /// If the film has other layers, or if its samples are spread by noise and the renderer has light paths, which light all pixels.
    pub fn pass(
        &self,
        renderer: &dyn TileRenderer,
        scene: &SceneView<'_>,
        options: &RenderOptions,
        film: &mut Film,
        pass: Pass,
    ) -> Counters {
        if !renderer.has_light_paths() {
            return self.tiles(renderer, scene, options, film.tile_passes(pass));
        }
        // It would need light paths of its own for all pixels, of which it has few.
        film.drop_second_set();
        let mut counters = Counters::default();
        for part in Splats::parts(pass, options.size) {
            let (splats, did) = self.splats(renderer, scene, options, part);
            counters += did;
            let tiles = film.tile_passes(part);
            counters += self.add_tiles(renderer, scene, options, tiles, Some(&splats));
        }
        counters
    }

    /// What light paths bring to the image in a pass.
    fn splats(
        &self,
        renderer: &dyn TileRenderer,
        scene: &SceneView<'_>,
        options: &RenderOptions,
        pass: Pass,
    ) -> (Splats, Counters) {
        // Tiles of a size of their own: in their order splats are added, and how a film is cut must not show.
        let tiles: Vec<_> = TileRect::tiles(options.size, TILE_SIZE)
            .map(|rect| TileSamples { rect, pass })
            .collect();
        let lists: Vec<_> = self.pool.install(|| {
            let jobs = tiles.par_iter().map(|tile| {
                let set = SampleSet::First;
                let job = TileJob {
                    tiles: std::slice::from_ref(tile),
                    set,
                    tracer: TracerOptions {
                        origin: PathOrigin::Lights,
                        ..options.tracer(set)
                    },
                };
                let mut list = vec![0.0; 4 * job.most_splats()];
                let did = renderer.render_tiles(scene, &job, &mut list);
                (list[..4 * did.splats as usize].to_vec(), did)
            });
            jobs.collect()
        });
        let mut splats = Splats::new(options.size, pass.count);
        let mut counters = Counters::default();
        let start = Instant::now();
        for (list, did) in lists {
            splats.add(&list);
            counters += did;
        }
        counters.film += start.elapsed().as_secs_f64();
        (splats, counters)
    }

    /// Adds a pass of samples of which each sees another pose of the scene: `pose_of` says which one, and `views` has them. What
    /// sees the same pose is rendered together; samples of a pixel are added in their order.
    ///
    /// # Panics
    /// If the film has other layers.
    pub fn pass_in_poses<'v>(
        &self,
        renderer: &dyn TileRenderer,
        pose_of: impl Fn(u32) -> usize,
        views: impl Fn(usize) -> SceneView<'v>,
        options: &RenderOptions,
        film: &mut Film,
        pass: Pass,
    ) -> Counters {
        let mut counters = Counters::default();
        if renderer.has_light_paths() {
            // All pixels get their samples together.
            let mut left = pass;
            while left.count > 0 {
                let pose = pose_of(left.first);
                let (now, later) = left.split_while(|sample| pose_of(sample) == pose);
                counters += self.pass(renderer, &views(pose), options, film, now);
                left = later;
            }
            return counters;
        }
        let mut left = film.tile_passes(pass);
        loop {
            left.retain(|tile| tile.pass.count > 0);
            let Some(first) = left.first() else {
                return counters;
            };
            let pose = pose_of(first.pass.first);
            let now = left
                .iter_mut()
                .filter(|tile| pose_of(tile.pass.first) == pose)
                .map(|tile| {
                    let (now, later) = tile.pass.split_while(|sample| pose_of(sample) == pose);
                    tile.pass = later;
                    TilePass {
                        set: tile.set,
                        pass: now,
                        tile: &mut *tile.tile,
                    }
                });
            counters += self.tiles(renderer, &views(pose), options, now.collect());
        }
    }

    /// Adds passes to a film until it has so many samples a pixel.
    pub fn render_until(
        &self,
        renderer: &dyn TileRenderer,
        scene: &SceneView<'_>,
        options: &RenderOptions,
        film: &mut Film,
        samples: u32,
    ) {
        while film.samples() < u64::from(samples) {
            let first = film.samples() as u32;
            let count = MAX_PASS.min(samples - first);
            self.pass(renderer, scene, options, film, Pass { first, count });
        }
    }

    /// Adds samples to tiles of a film that has the renderer's layers.
    ///
    /// # Panics
    /// If the film has others.
    pub fn tiles(
        &self,
        renderer: &dyn TileRenderer,
        scene: &SceneView<'_>,
        options: &RenderOptions,
        tiles: Vec<TilePass<'_>>,
    ) -> Counters {
        self.add_tiles(renderer, scene, options, tiles, None)
    }

    fn add_tiles(
        &self,
        renderer: &dyn TileRenderer,
        scene: &SceneView<'_>,
        options: &RenderOptions,
        tiles: Vec<TilePass<'_>>,
        splats: Option<&Splats>,
    ) -> Counters {
        let layers = renderer.layers();
        let counters = Mutex::new(Counters::default());
        let jobs = jobs(tiles, self.threads());
        self.pool.install(|| {
            jobs.into_par_iter().for_each(|tiles| {
                let set = tiles[0].set;
                let parts: Vec<_> = tiles.iter().map(TilePass::samples).collect();
                let job = TileJob {
                    tiles: &parts,
                    set,
                    tracer: options.tracer(set),
                };
                let mut samples = vec![0.0; job.samples() * layers.stride()];
                let mut did = renderer.render_tiles(scene, &job, &mut samples);
                let film_start = Instant::now();
                let mut rest = samples.as_mut_slice();
                for (TilePass { tile, .. }, part) in tiles.into_iter().zip(&parts) {
                    assert_eq!(tile.layers(), layers, "one film, one set of layers");
                    let (of_tile, others) = rest.split_at_mut(part.count() * layers.stride());
                    if let Some(splats) = splats {
                        splats.add_to(part.rect, 0, layers.stride(), of_tile);
                    }
                    tile.add(of_tile);
                    rest = others;
                }
                did.film = film_start.elapsed().as_secs_f64();
                *counters.lock().expect("no tile panicked") += did;
            });
        });
        counters.into_inner().expect("no tile panicked")
    }

    /// Renders until the options say stop. Between passes `renderer` is asked anew which renderer to use, so that a
    /// compiled one can take over from the interpreter; all give the same bits. `progress`, called after each pass, may
    /// break: the film is then what there is so far.
    pub fn render<'r>(
        &self,
        mut renderer: impl FnMut() -> &'r dyn TileRenderer,
        scene: &SceneView<'_>,
        options: &RenderOptions,
        progress: impl FnMut(Progress<'_>) -> ControlFlow<()>,
    ) -> (Film, RenderReport) {
        let layers = renderer().layers();
        let film = Film::sampled_by(options.sampling, options.size, self.tile_size, layers);
        let mut film = film.with_second_set(options.seed);
        let pass = |film: &mut Film, pass| {
            Ok::<_, Infallible>(self.pass(renderer(), scene, options, film, pass))
        };
        let (report, Ok(())) = render_passes(options, &mut film, pass, progress);
        (film, report)
    }
}

/// Fewest and most samples that make it worth to share streams: the last paths of a job leave them half empty.
const SAMPLES_OF_JOB: [usize; 2] = [1 << 12, 1 << 16];

/// Small tiles together, in jobs enough for all threads.
fn jobs(tiles: Vec<TilePass<'_>>, threads: usize) -> Vec<Vec<TilePass<'_>>> {
    let all: usize = tiles.iter().map(|tile| tile.samples().count()).sum();
    let [fewest, most] = SAMPLES_OF_JOB;
    let enough = (all / (4 * threads)).clamp(fewest, most);
    let mut jobs: Vec<Vec<TilePass<'_>>> = Vec::new();
    let mut of_last = usize::MAX;
    for tile in tiles {
        let count = tile.samples().count();
        match jobs.last_mut() {
            Some(job) if job[0].set == tile.set && of_last.saturating_add(count) <= enough => {
                of_last += count;
                job.push(tile);
            }
            _ => {
                of_last = count;
                jobs.push(vec![tile]);
            }
        }
    }
    jobs
}
