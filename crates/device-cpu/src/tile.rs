//! One tile: from camera rays to radiance. The whole life of its paths is in [`render_tile`].

use std::time::Instant;

use residual_bvh::{BvhView, Lanes as BvhLanes, Ray, Watertight, any_hit, closest_hit};
use residual_render::domain::{Buffer, Buffers, Lanes};
use residual_render::film::TileRect;
use residual_render::sampler::SampleKey;
use residual_render::scene::Scene;
use residual_render::tracer::{PathTracer, Tracer};

use crate::lanes::AnyBvh;
use crate::shade::{Shade, shade_misses};
use crate::stream::{PathStream, ShadowStream, SortedHits};

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
    /// Thread seconds: occlusion.
    pub trace_shadow: f64,
    /// Thread seconds: sorting by program.
    pub sort: f64,
    /// Thread seconds: shading.
    pub shade: f64,
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
    }
}

/// A scene's data, ready to be rendered.
#[derive(Clone, Copy, Debug)]
pub struct SceneView<'a> {
    /// Its buffers.
    pub buffers: Buffers<'a>,
    /// Its triangles.
    pub bvh: AnyBvh<'a>,
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

/// Renders a tile: every sample of the job is one wave of paths, one for each pixel.
#[inline(always)]
pub fn render_tile<D, S, Sc, const N: usize>(
    simd: S,
    d: D,
    scene: &Sc,
    (buffers, bvh): (&Buffers<'_>, BvhView<'_, N>),
    job: &TileJob,
    radiance: &mut [f32],
) -> Counters
where
    D: Lanes,
    S: BvhLanes<N>,
    Sc: Scene<D>,
{
    let area = job.rect().area();
    let tracer = PathTracer {
        sampler: scene.sampler(),
        size: job.image,
        roulette_from: job.roulette_from,
    };
    let mut paths = PathStream::with_capacity(area, D::LANES);
    let mut next = PathStream::with_capacity(area, D::LANES);
    let mut shadows = ShadowStream::with_capacity(area, D::LANES);
    let mut hits = SortedHits::with_capacity(area, D::LANES, scene.programs());
    let mut counters = Counters::default();
    let mut clock = Stopwatch(Instant::now());
    radiance.fill(0.0);

    for (wave, radiance) in radiance.chunks_exact_mut(area * 3).enumerate() {
        emit(
            d,
            scene,
            &tracer,
            job,
            job.samples[0] + wave as u32,
            &mut paths,
        );
        clock.lap(&mut counters.emit);
        for depth in 1..=job.max_depth {
            if paths.len() == 0 {
                break;
            }
            // Closest hits.
            for i in 0..paths.len() {
                let hit = closest_hit(simd, Watertight, bvh, &paths.ray(i), scene);
                let program = hit
                    .is_hit()
                    .then(|| buffers.word(Buffer::TrianglePrograms, hit.prim));
                hits.set(i, &hit, program);
            }
            if depth == 1 {
                counters.camera_rays += paths.len() as u64;
                clock.lap(&mut counters.trace_camera);
            } else {
                counters.bounce_rays += paths.len() as u64;
                clock.lap(&mut counters.trace_bounce);
            }
            hits.sort(&mut paths);
            clock.lap(&mut counters.sort);

            // Shading, program by program.
            next.clear();
            shadows.clear();
            shade_misses(d, &tracer, scene.lights(), &hits.misses(), &paths, radiance);
            for program in 0..scene.programs() {
                let range = hits.range(program);
                if !range.is_empty() {
                    scene.visit_material(
                        program,
                        Shade {
                            d,
                            tracer: &tracer,
                            lights: scene.lights(),
                            range,
                            paths: &paths,
                            hits: &hits,
                            depth,
                            last: depth == job.max_depth,
                            next: &mut next,
                            shadows: &mut shadows,
                            radiance,
                        },
                    );
                }
            }
            clock.lap(&mut counters.shade);

            // Occlusion.
            for i in 0..shadows.len() {
                if !any_hit(simd, Watertight, bvh, &shadows.ray(i), scene) {
                    shadows.add_to(i, radiance);
                }
            }
            counters.shadow_rays += shadows.len() as u64;
            clock.lap(&mut counters.trace_shadow);
            std::mem::swap(&mut paths, &mut next);
        }
        paths.clear();
    }
    counters
}

/// Camera rays of one sample of every pixel of the tile.
#[inline(always)]
fn emit<D: Lanes, Sc: Scene<D>>(
    d: D,
    scene: &Sc,
    tracer: &PathTracer<Sc::Sampler>,
    job: &TileJob,
    sample: u32,
    paths: &mut PathStream,
) {
    paths.clear();
    let rect = job.rect();
    let area = rect.area();
    let mut columns = [0; 16];
    let mut rows = [0; 16];
    let mut ids = [0; 16];
    for first in (0..area).step_by(D::LANES) {
        for lane in 0..D::LANES {
            let place = (first + lane).min(area - 1) as u32;
            ids[lane] = place;
            columns[lane] = rect.x + place % rect.width;
            rows[lane] = rect.y + place / rect.width;
        }
        let (x, y) = (d.word(&columns[..D::LANES]), d.word(&rows[..D::LANES]));
        let key = SampleKey::new(d, x, y, d.uint(sample), d.uint(job.seed));
        let path = tracer.on_emit(d, scene.camera(), [x, y], key);
        let count = (area - first).min(D::LANES);
        let all = ((1_u64 << count) - 1) as u32;
        paths.push(d, all, &path, d.word(&ids[..D::LANES]));
    }
}

/// A ray of the traversal library; `tmin` is 0: rays start beyond the error of their origin.
#[inline(always)]
pub(crate) fn ray(org: [f32; 3], dir: [f32; 3], tmax: f32) -> Ray {
    Ray {
        org,
        tmin: 0.0,
        dir,
        tmax,
    }
}
