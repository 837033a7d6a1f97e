//! Paths from the camera in a tracer that also has paths from lights.

use super::next_event::NextEvent;
use super::rivals::{Turn, carried_on, cosine, reversed, shared};
use super::{Bounce, Path, PathTracer, PowerHeuristic, Shadow, Sharing, Tracer, Vertex};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::{self, LightKinds, SceneSphereRecord};
use crate::math::{Color, Vec3};
use crate::sampler::Sampler;
use crate::surface::Cone;

/// The path tracer, whose light is shared with [`LightPaths`](super::light_paths::LightPaths). Alone among strategies it finds
/// lights that the camera sees, directly or in mirrors.
#[derive(Clone, Copy)]
pub(super) struct CameraPaths<D: Domain, S, C, W> {
    pub(super) paths: PathTracer<D, S, PowerHeuristic>,
    pub(super) camera: C,
    pub(super) sharing: W,
}

impl<D: Domain, S: Sampler<D>, C: Camera<D>, W: Sharing> CameraPaths<D, S, C, W> {
    /// What light paths are worth that would have come the way from `out` through the vertex. `back` is their density of that turn.
    #[inline(always)]
    fn onward<B>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        out: Vec3<D::F>,
        back: D::F,
    ) -> D::F {
        let distance = (vertex.surface.point - path.ray.org).length(d);
        let turn = Turn {
            first: d.lit(1.0) / self.camera.density(d, path.ray.dir, distance),
            is_first: path.state.is_first(d),
            carried: path.rivals,
            back,
            cosines: [vertex.wo, out].map(|dir| cosine(d, vertex, dir)),
        };
        turn.onward(d)
    }
}

impl<D: Domain, S: Sampler<D>, C: Camera<D>, W: Sharing> Tracer<D> for CameraPaths<D, S, C, W> {
    #[inline(always)]
    fn on_emit<K: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        camera: &K,
        lights: &L,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        self.paths.on_emit(d, camera, lights, pixel, sample)
    }

    #[inline(always)]
    fn cone(&self, d: D, path: &Path<D>) -> Option<Cone<D>> {
        self.paths.cone(d, path)
    }

    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        let emission = vertex.emission?;
        let surface = vertex.surface;
        let light_pdf = light::density(d, lights, &path.ray, surface);
        let own = self.paths.bsdf_weight(d, path.pdf, light_pdf);
        let way = surface.point - path.ray.org;
        let spread = light::spread(d, lights, surface) / d.max(way.dot(d, way), d.lit(1e-36));
        let weight = shared(d, own, path.rivals * spread * light_pdf);
        Some(path.throughput * emission.scale(weight))
    }

    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        let seen = light::background(d, lights, &path.ray)?;
        let own = self.paths.bsdf_weight(d, path.pdf, seen.pdf);
        let ratio = path.rivals * seen.pdf / SceneSphereRecord::of_scene(d).disc_area(d);
        Some(path.throughput * seen.radiance.scale(shared(d, own, ratio)))
    }

    /// Where light paths have the image to themselves, paths end where they first arrive.
    #[inline(always)]
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
        match self.sharing.is_shared() {
            true => self.paths.goes_on(d, path),
            false => d.truth(false),
        }
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Shadow<D>> {
        if !self.sharing.is_shared() {
            return None;
        }
        let event = NextEvent::new(d, &self.paths.sampler, path, vertex, lights)?;
        let own = self.paths.light_weight(d, &event);
        let sample = &event.sample;
        let back = reversed(d, vertex, sample.wi).value.pdf;
        let onward = self.onward(d, path, vertex, sample.wi, back);
        let way = sample.position - vertex.surface.point;
        let of_near = sample.spread / d.max(way.dot(d, way), d.lit(1e-36));
        let of_far = d.lit(1.0) / SceneSphereRecord::of_scene(d).disc_area(d);
        let spread = d.select(sample.infinite, of_far, of_near);
        let weight = shared(d, own, onward * spread);
        Some(event.shadow(d, path, vertex, weight))
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        if !self.sharing.is_shared() {
            return None;
        }
        let mut bounce = self.paths.on_bounce(d, path, vertex)?;
        let (dir, density) = (bounce.path.ray.dir, bounce.path.pdf);
        let is_delta = d.eq(density, d.lit(0.0));
        let back = reversed(d, vertex, dir).value.pdf;
        let onward = self.onward(d, path, vertex, dir, d.select(is_delta, d.lit(1.0), back));
        // The camera is met by no sample of a BSDF: what it sees in a mirror is found from its side alone.
        let hopeless = is_delta & path.state.is_first(d);
        let onward = d.select(hopeless, d.lit(0.0), onward);
        bounce.path.rivals = carried_on(d, onward, density);
        Some(bounce)
    }
}
