//! The path tracer: unidirectional, with next-event estimation, multiple importance sampling and Russian roulette.

use super::{Bounce, Path, Shadow, Tracer, Vertex};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::{self, LightKinds, NO_LIGHT, pick_probability, power_heuristic};
use crate::math::{Color, Vec3};
use crate::sampler::{SampleKey, Sampler};
use crate::surface::{Ray, Surface};

/// Pairs of random numbers that a vertex uses.
const PAIRS: u32 = 4;
/// Which pair is for what. Pairs of vertex 0, the camera, come first.
const LIGHT_PICK: u32 = 0;
const LIGHT_PLACE: u32 = 1;
const BSDF_DIRECTION: u32 = 2;
const LOBE_AND_ROULETTE: u32 = 3;

/// The path tracer.
#[derive(Clone, Copy, Debug)]
pub struct PathTracer<S> {
    /// Where random numbers come from.
    pub sampler: S,
    /// Width and height of the image in pixels.
    pub size: [u32; 2],
    /// The first vertex at which Russian roulette may end a path.
    pub roulette_from: u32,
}

impl<S> PathTracer<S> {
    #[inline(always)]
    fn pair<D: Domain>(&self, d: D, key: SampleKey<D::U>, depth: D::U, pair: u32) -> [D::F; 2]
    where
        S: Sampler<D>,
    {
        self.sampler
            .pair(d, key, depth * d.uint(PAIRS) + d.uint(pair))
    }
}

/// A direction is on the same side of the geometric and of the shading surface.
#[inline(always)]
fn consistent<D: Domain>(d: D, surface: &Surface<D>, world: Vec3<D::F>, local: Vec3<D::F>) -> D::M {
    d.lt(d.lit(0.0), surface.geometric_normal.dot(d, world) * local.z)
}

impl<D: Domain, S: Sampler<D>> Tracer<D> for PathTracer<S> {
    #[inline(always)]
    fn on_emit<C: Camera<D>>(
        &self,
        d: D,
        camera: &C,
        pixel: [D::U; 2],
        key: SampleKey<D::U>,
    ) -> Path<D> {
        let jitter = self.pair(d, key, d.uint(0), 0);
        let [width, height] = self.size.map(|n| d.lit(f64::from(n)));
        let (two, one) = (d.lit(2.0), d.lit(1.0));
        let x = (d.to_real(pixel[0]) + jitter[0]) / width * two - one;
        let y = one - (d.to_real(pixel[1]) + jitter[1]) / height * two;
        Path {
            ray: camera.ray(d, [x, y]),
            throughput: Vec3::splat(one),
            pdf: d.lit(0.0),
            key,
        }
    }

    #[inline(always)]
    fn on_hit(
        &self,
        d: D,
        path: &Path<D>,
        surface: &Surface<D>,
        emission: Color<D::F>,
        light: D::U,
    ) -> Color<D::F> {
        let distance = (surface.point - path.ray.org).length(d);
        let no_light = d.eq_u(light, d.uint(NO_LIGHT));
        let light = d.select_u(no_light, d.uint(0), light);
        let light_pdf = light::area_pdf(d, surface, distance) * pick_probability(d, light);
        let light_pdf = d.select(no_light, d.lit(0.0), light_pdf);
        path.throughput * emission.scale(bsdf_weight(d, path.pdf, light_pdf))
    }

    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(&self, d: D, path: &Path<D>, lights: &L) -> Color<D::F> {
        match lights.background(d, path.ray.dir) {
            Some(seen) => path.throughput * seen.radiance.scale(bsdf_weight(d, path.pdf, seen.pdf)),
            None => Vec3::splat(d.lit(0.0)),
        }
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Shadow<D> {
        let Vertex { surface, bsdf, .. } = *vertex;
        let [pick, extra] = self.pair(d, path.key, vertex.depth, LIGHT_PICK);
        let place = self.pair(d, path.key, vertex.depth, LIGHT_PLACE);
        let sample = light::sample(d, lights, surface.point, [pick, place[0], place[1], extra]);

        let wo = surface.frame.to_local(d, vertex.wo);
        let wi = surface.frame.to_local(d, sample.wi);
        let value = bsdf.eval(d, surface, wo, wi);
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let weight = d.select(sample.delta, one, power_heuristic(d, sample.pdf, value.pdf));
        let contribution =
            path.throughput * value.value * sample.radiance.scale(weight / sample.pdf);

        let org = surface.spawn(d, sample.wi);
        let dir = sample.position - org;
        let pick = |a: D::F, b: D::F| d.select(sample.infinite, a, b);
        Shadow {
            ray: Ray {
                org,
                dir: Vec3 {
                    x: pick(sample.wi.x, dir.x),
                    y: pick(sample.wi.y, dir.y),
                    z: pick(sample.wi.z, dir.z),
                },
                tmax: pick(d.lit(f64::from(f32::MAX)), one),
            },
            contribution,
            active: consistent(d, surface, sample.wi, wi)
                & d.lt(zero, contribution.max_component(d)),
        }
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(&self, d: D, path: &Path<D>, vertex: &Vertex<'_, D, B>) -> Bounce<D> {
        let Vertex { surface, bsdf, .. } = *vertex;
        let direction = self.pair(d, path.key, vertex.depth, BSDF_DIRECTION);
        let [lobe, roulette] = self.pair(d, path.key, vertex.depth, LOBE_AND_ROULETTE);
        let wo = surface.frame.to_local(d, vertex.wo);
        let sample = bsdf.sample(d, surface, wo, [direction[0], direction[1], lobe]);
        let dir = surface.frame.to_world(sample.wi).normalize(d);

        let throughput = path.throughput * sample.weight;
        let largest = throughput.max_component(d);
        let early = d.lt_u(vertex.depth, d.uint(self.roulette_from));
        let one = d.lit(1.0);
        let survival = d.select(early, one, d.min(largest, d.lit(0.95)));
        let alive = d.lt(d.lit(0.0), largest) & (early | d.lt(roulette, survival));
        let scale = one / d.select(alive, survival, one);
        Bounce {
            path: Path {
                ray: Ray {
                    org: surface.spawn(d, dir),
                    dir,
                    tmax: d.lit(f64::from(f32::MAX)),
                },
                throughput: throughput.scale(scale),
                pdf: sample.pdf,
                key: path.key,
            },
            active: alive & consistent(d, surface, dir, sample.wi),
        }
    }
}

/// The weight of light found by a BSDF sample: 1 where light sampling could not have found it.
#[inline(always)]
fn bsdf_weight<D: Domain>(d: D, bsdf_pdf: D::F, light_pdf: D::F) -> D::F {
    let alone = d.eq(bsdf_pdf, d.lit(0.0));
    let safe = d.select(alone, d.lit(1.0), bsdf_pdf);
    d.select(alone, d.lit(1.0), power_heuristic(d, safe, light_pdf))
}
