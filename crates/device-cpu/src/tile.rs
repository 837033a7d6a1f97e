//! Tiles: from camera rays to radiance. The whole life of its paths is in [`render_tiles`].

use std::time::Instant;

use residual_bvh::{Hit, Ray};
use residual_render::alpha::Candidate;
use residual_render::domain::{Lanes, MAX_LANES};
use residual_render::passes::Counters;
use residual_render::renderer::Renderer;
use residual_render::tracer::{PathOrigin, Settings, Tracer};

use crate::first_rays::FirstRays;
use crate::job::{SceneView, TileJob};
use crate::samples::Samples;
use crate::shade::Shading;
use crate::stream::{PathStream, ShadowStream, SortedHits};
use crate::traversal::AlphaFilter;

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

/// Renders tiles. Streams of paths are traced, sorted by program, shaded and thinned out; then new paths fill the
/// stream up again, so that lanes and packets stay full until the last samples of the job.
#[inline(always)]
pub fn render_tiles<D, Sc>(
    d: D,
    scene: &Sc,
    view: &SceneView<'_>,
    job: &TileJob<'_>,
    samples: &mut [f32],
) -> Counters
where
    D: Lanes,
    Sc: Renderer<D>,
{
    let lights = scene.lights();
    let tracer = scene.tracer(Settings::new(d, &job.tracer));
    let accept = |ray: &Ray, hit: &Hit| {
        scene.alpha_test(&Candidate {
            org: ray.org,
            dir: ray.dir,
            uv: [hit.u, hit.v],
            triangle: hit.prim,
        })
    };
    let alpha: Option<&AlphaFilter<'_>> = if scene.has_alpha_tests() {
        Some(&accept)
    } else {
        None
    };
    let mut first_rays = FirstRays::new(job);
    let has_rivals = tracer.path_origin().is_some();
    let capacity = STREAM.min(job.samples() + MAX_LANES);
    let mut paths = PathStream::with_capacity(capacity, has_rivals);
    let mut next = PathStream::with_capacity(capacity, has_rivals);
    let mut shadows = ShadowStream::with_capacity(capacity);
    let mut hits = SortedHits::with_capacity(capacity, scene.programs());
    let mut counters = Counters::default();
    let mut clock = Stopwatch(Instant::now());
    let mut samples = match tracer.path_origin() {
        Some(PathOrigin::Lights) => Samples::splats(samples),
        None | Some(PathOrigin::Camera) => Samples::sums(samples, tracer.layers()),
    };

    loop {
        let carried = paths.len();
        first_rays.fill(d, scene, &tracer, &mut paths);
        clock.lap(&mut counters.emit);
        let all = paths.len();
        if all == 0 {
            counters.splats = samples.splatted() as u64;
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
        if let Some(map) = tracer.cost_map() {
            let mut visits = vec![0; fresh.len()];
            view.traversal.visits(fresh, &mut visits, alpha);
            for (path, visits) in (carried..).zip(visits) {
                let [r, g, b] = map.color(visits).map(f32::to_bits);
                samples.add_row([r, g, b, paths.sample(path)]);
            }
        }
        clock.lap(&mut counters.trace_camera);
        hits.sort(all, &view.buffers);
        clock.lap(&mut counters.sort);

        // Shading, program by program.
        next.clear();
        shadows.clear();
        let mut shading = Shading {
            d,
            buffers: &view.buffers,
            tracer: &tracer,
            lights,
            paths: &paths,
            hits: &hits,
            next: &mut next,
            shadows: &mut shadows,
            samples: &mut samples,
        };
        shading.misses(hits.range(scene.programs()));
        for program in 0..scene.programs() {
            let range = hits.range(program);
            if !range.is_empty() {
                scene.visit_material(program, shading.of(range));
            }
        }
        clock.lap(&mut counters.shade);

        // Occlusion.
        let (rays, occluded) = shadows.rays_and_answers();
        view.traversal.any_hits(rays, occluded, alpha);
        shadows.add_to(&mut samples);
        counters.shadow_rays += shadows.len() as u64;
        clock.lap(&mut counters.trace_shadow);
        std::mem::swap(&mut paths, &mut next);
    }
}
