//! Ambient occlusion: how much of a white sky a matte surface would see, occluders beyond a distance left out.

use super::camera_pairs::OCCLUSION;
use super::{Path, Settings, Shadow, Tracer, Vertex, consistent};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::warp::cosine_hemisphere;
use crate::math::{Color, Vec3};
use crate::sampler::Sampler;
use crate::surface::PathRay;

/// The tracer of ambient occlusion: from 0, where everything around is near, to 1, also where nothing is seen.
#[derive(Clone, Copy)]
pub struct AmbientOcclusion<D: Domain, S> {
    /// Where random numbers come from.
    pub sampler: S,
    /// How far occluders count.
    pub settings: Settings<D>,
}

impl<D: Domain, S: Sampler<D>> Tracer<D> for AmbientOcclusion<D, S> {
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

    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(
        &self,
        _: D,
        path: &Path<D>,
        _: &L,
    ) -> Option<Color<D::F>> {
        Some(path.throughput)
    }

    #[inline(always)]
    fn goes_on(&self, d: D, _: &Path<D>) -> D::M {
        d.truth(true)
    }

    /// Directions go by the cosine, so that every one of them counts the same.
    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        _: &L,
    ) -> Option<Shadow<D>> {
        let surface = vertex.surface;
        let local = cosine_hemisphere(d, self.sampler.pair(d, path.key, d.uint(OCCLUSION)));
        let dir: Vec3<D::F> = surface.frame.to_world(local).normalize(d);
        Some(Shadow {
            ray: PathRay {
                org: surface.spawn(d, dir),
                dir,
                tmax: self.settings.reach,
            },
            contribution: path.throughput,
            pixel: None,
            active: consistent(d, surface, dir, local),
        })
    }
}
