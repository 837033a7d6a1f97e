//! The path tracer: unidirectional, with next-event estimation, multiple importance sampling and Russian roulette.

use super::next_event::NextEvent;
use super::vertex_pairs::pair_of_levels;
use super::way_on::WayOn;
use super::{Bounce, Mis, Path, PowerHeuristic, Settings, Shadow, Tracer, Vertex, consistent};
use crate::bsdf::Bsdf;
use crate::camera::{Camera, pixel_cone};
use crate::domain::Domain;
use crate::light::{self, LightKinds};
use crate::math::Color;
use crate::sampler::Sampler;
use crate::surface::{Cone, PathRay};

/// The cone of a direction that a BSDF proposed has this part of the solid angle that its density stands for: what is seen by way of
/// a matte wall is seen through cones of 10°.
const BOUNCE_CONE: f64 = 0.1;
/// No cone is wider than this, in radians.
const WIDEST_CONE: f64 = 0.25;

/// The path tracer.
#[derive(Clone, Copy)]
pub struct PathTracer<D: Domain, S, M = PowerHeuristic> {
    /// Where random numbers come from.
    pub sampler: S,
    /// Length of paths, and when roulette begins.
    pub settings: Settings<D>,
    /// How light is weighed that is found in two ways.
    pub mis: M,
}

impl<D: Domain, S: Sampler<D>, M: Mis<D>> PathTracer<D, S, M> {
    /// The weight of a light sample: 1 where a BSDF sample could not have found it.
    #[inline(always)]
    pub(super) fn light_weight(&self, d: D, event: &NextEvent<D>) -> D::F {
        let sample = &event.sample;
        let weight = self.mis.of_light(d, sample.pdf, event.value.pdf);
        d.select(sample.delta, d.lit(1.0), weight)
    }

    /// The weight of light found by a BSDF sample: 1 where light sampling could not have found it.
    #[inline(always)]
    pub(super) fn bsdf_weight(&self, d: D, bsdf_pdf: D::F, light_pdf: D::F) -> D::F {
        let alone = d.eq(bsdf_pdf, d.lit(0.0));
        let safe = d.select(alone, d.lit(1.0), bsdf_pdf);
        d.select(alone, d.lit(1.0), self.mis.of_bsdf(d, safe, light_pdf))
    }
}

impl<D: Domain, S: Sampler<D>, M: Mis<D>> Tracer<D> for PathTracer<D, S, M> {
    #[inline(always)]
    fn on_emit<C: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        camera: &C,
        _: &L,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        self.settings
            .camera_path(d, camera, &self.sampler, pixel, sample)
    }

    /// A pixel's, for camera rays and what mirrors reflect of them (which is somewhat farther away than it seems here, since paths do not
    /// remember their length); beyond other surfaces as narrow as the lobe.
    #[inline(always)]
    fn cone(&self, d: D, path: &Path<D>) -> Option<Cone<D>> {
        let [rows, zero] = [self.settings.image[1], d.lit(0.0)];
        let [width, angle] = pixel_cone(d, rows);
        let lobe = d.lit(BOUNCE_CONE) / d.sqrt(d.max(path.pdf, d.lit(1e-30)));
        let is_straight = d.eq(path.pdf, zero);
        let [random, _] = pair_of_levels(d, &self.sampler, path);
        Some(Cone {
            width: d.select(path.state.is_first(d), width, zero),
            angle: d.select(is_straight, angle, d.min(lobe, d.lit(WIDEST_CONE))),
            random,
        })
    }

    /// Emission, weighed against what light sampling makes of it.
    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        let emission = vertex.emission?;
        let light_pdf = light::density(d, lights, &path.ray, vertex.surface);
        Some(path.throughput * emission.scale(self.bsdf_weight(d, path.pdf, light_pdf)))
    }

    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        let seen = light::background(d, lights, &path.ray)?;
        Some(path.throughput * seen.radiance.scale(self.bsdf_weight(d, path.pdf, seen.pdf)))
    }

    #[inline(always)]
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
        d.lt_u(path.state.depth(d), self.settings.max_depth)
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Shadow<D>> {
        let event = NextEvent::new(d, &self.sampler, path, vertex, lights)?;
        let weight = self.light_weight(d, &event);
        Some(event.shadow(d, path, vertex, weight))
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        let way = WayOn::new(d, &self.sampler, path, vertex)?;
        let Vertex { surface, bsdf, .. } = *vertex;
        let WayOn { sample, dir, .. } = way;
        let throughput = path.throughput * sample.weight;
        // What paths lose on their way into glass they gain on their way out: it is no reason to end there (PBRT 4, 14.5.4).
        let outside = match bsdf.radiance_scale(d, surface, sample.wi) {
            Some(scale) => throughput.scale(scale),
            None => throughput,
        };
        let worth = outside.max_component(d);
        let (alive, scale) = way.survives(d, &self.settings, path, vertex, worth);
        Some(Bounce {
            path: Path {
                ray: PathRay::unbounded(d, surface.spawn(d, dir), dir),
                throughput: throughput.scale(scale),
                pdf: sample.pdf,
                rivals: path.rivals,
                key: path.key,
                state: path.state.next(d),
            },
            active: alive & consistent(d, surface, dir, sample.wi),
        })
    }
}
