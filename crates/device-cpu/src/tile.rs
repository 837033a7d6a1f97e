//! One tile: from camera rays to radiance. The whole life of its paths is in [`render_tile`].

use std::time::Instant;

use residual_bvh::{Hit, Ray};
use residual_render::domain::{Buffer, Buffers, Lanes};
use residual_render::film::TileRect;
use residual_render::scene::Scene;
use residual_render::tracer::PathTracer;

use crate::camera_rays::CameraRays;
use crate::shade::{Shade, shade_misses};
use crate::stream::{PathStream, ShadowStream, SortedHits};
use crate::traversal::{Alpha, Traversal};

/// What is to be rendered.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct TileJob {
    /// x, y, width and height of the tile.
    pub tile: [u32; 4],
    /// Width and height of the image.
    pub image: [u32; 2],
    /// Number of the first sample, and how many.
    pub samples: [u32; 2],
    /// Most vertices a path may have; 1 is emission seen directly.
    pub max_depth: u32,
    /// First vertex at which Russian roulette may end a path.
    pub roulette_from: u32,
    /// Seed of the random numbers.
    pub seed: u32,
}

impl TileJob {
    /// The tile as a rectangle.
    pub fn rect(&self) -> TileRect {
        let [x, y, width, height] = self.tile;
        TileRect {
            x,
            y,
            width,
            height,
        }
    }
}

/// What was done, and how long each stage took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Counters {
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Rays that continue paths.
    pub bounce_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Thread seconds: making camera rays.
    pub emit: f64,
    /// Thread seconds: closest hits of camera rays.
    pub trace_camera: f64,
    /// Thread seconds: closest hits of continued paths.
    pub trace_bounce: f64,
    /// Thread seconds: occlusion, and adding what is not occluded.
    pub trace_shadow: f64,
    /// Thread seconds: sorting by program.
    pub sort: f64,
    /// Thread seconds: shading, and writing down the paths and shadow rays that go on, which compacts them.
    pub shade: f64,
    /// Thread seconds: adding samples to the film.
    pub film: f64,
}

impl Counters {
    /// The stages with their thread seconds (thesis, Figure 3.3).
    pub fn stages(&self) -> [(&'static str, f64); 7] {
        [
            ("emit", self.emit),
            ("trace_camera", self.trace_camera),
            ("trace_bounce", self.trace_bounce),
            ("trace_shadow", self.trace_shadow),
            ("sort", self.sort),
            ("shade", self.shade),
            ("film", self.film),
        ]
    }
}

impl std::ops::AddAssign for Counters {
    fn add_assign(&mut self, o: Self) {
        self.camera_rays += o.camera_rays;
        self.bounce_rays += o.bounce_rays;
        self.shadow_rays += o.shadow_rays;
        self.emit += o.emit;
        self.trace_camera += o.trace_camera;
        self.trace_bounce += o.trace_bounce;
        self.trace_shadow += o.trace_shadow;
        self.sort += o.sort;
        self.shade += o.shade;
        self.film += o.film;
    }
}

/// A scene's data, ready to be rendered.
#[derive(Clone, Copy)]
pub struct SceneView<'a> {
    /// Its buffers.
    pub buffers: Buffers<'a>,
    /// What traces rays against its triangles.
    pub traversal: &'a (dyn Traversal + Sync),
}

/// Renders tiles of one scene structure: interpreted, compiled in, or loaded.
pub trait TileRenderer: Sync {
    /// Renders the job into `radiance[sample][row][column][channel]`, which is overwritten.
    fn render_tile(&self, scene: &SceneView<'_>, job: &TileJob, radiance: &mut [f32]) -> Counters;
}

/// Adds the time since the last lap to a counter.
struct Stopwatch(Instant);

impl Stopwatch {
    fn lap(&mut self, into: &mut f64) {
        let now = Instant::now();
        *into += (now - self.0).as_secs_f64();
        self.0 = now;
    }
}

/// Paths under way at once. With their rays and hits they fit the second-level cache.
const STREAM: usize = 4096;

/// Renders a tile. Streams of paths are traced, sorted by program, shaded and thinned out; then camera rays fill the
/// stream up again, so that lanes and packets stay full until the last samples of the job.
#[inline(always)]
pub fn render_tile<D, Sc>(
    d: D,
    scene: &Sc,
    view: &SceneView<'_>,
    job: &TileJob,
    radiance: &mut [f32],
) -> Counters
where
    D: Lanes,
    Sc: Scene<D>,
{
    let tracer = PathTracer {
        sampler: scene.sampler(),
        size: job.image,
        roulette_from: job.roulette_from,
    };
    let covers = |ray: &Ray, hit: &Hit| scene.covers(ray, hit);
    let alpha: Option<&Alpha<'_>> = if scene.has_alpha() {
        Some(&covers)
    } else {
        None
    };
    let program_of = |prim: u32| view.buffers.word(Buffer::TrianglePrograms, prim);
    let mut cameras = CameraRays::new(job);
    let mut paths = PathStream::with_capacity(STREAM);
    let mut next = PathStream::with_capacity(STREAM);
    let mut shadows = ShadowStream::with_capacity(STREAM);
    let mut hits = SortedHits::with_capacity(STREAM, scene.programs());
    let mut counters = Counters::default();
    let mut clock = Stopwatch(Instant::now());
    radiance.fill(0.0);

    loop {
        let carried = paths.len();
        cameras.fill(d, scene, &tracer, &mut paths);
        clock.lap(&mut counters.emit);
        let all = paths.len();
        if all == 0 {
            return counters;
        }

        // Closest hits.
        let (bounced, fresh) = paths.rays().split_at(carried);
        view.traversal
            .closest_hits(bounced, hits.answers(0..carried), alpha);
        counters.bounce_rays += bounced.len() as u64;
        clock.lap(&mut counters.trace_bounce);
        view.traversal
            .closest_hits(fresh, hits.answers(carried..all), alpha);
        counters.camera_rays += fresh.len() as u64;
        clock.lap(&mut counters.trace_camera);
        hits.sort(all, program_of);
        clock.lap(&mut counters.sort);

        // Shading, program by program.
        next.clear();
        shadows.clear();
        let misses = hits.range(scene.programs());
        let lights = scene.lights();
        shade_misses(d, &tracer, lights, (&paths, &hits), misses, radiance);
        for program in 0..scene.programs() {
            let range = hits.range(program);
            if !range.is_empty() {
                scene.visit_material(
                    program,
                    Shade {
                        d,
                        tracer: &tracer,
                        lights,
                        range,
                        paths: &paths,
                        hits: &hits,
                        max_depth: job.max_depth,
                        next: &mut next,
                        shadows: &mut shadows,
                        radiance,
                    },
                );
            }
        }
        clock.lap(&mut counters.shade);

        // Occlusion.
        let (rays, occluded) = shadows.rays_and_answers();
        view.traversal.any_hits(rays, occluded, alpha);
        shadows.add_to(radiance);
        counters.shadow_rays += shadows.len() as u64;
        clock.lap(&mut counters.trace_shadow);
        std::mem::swap(&mut paths, &mut next);
    }
}
