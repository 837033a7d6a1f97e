//! Paths from both ends.

use super::camera_paths::CameraPaths;
use super::light_paths::LightPaths;
use super::{
    Bounce, Path, PathOrigin, PathTracer, PowerHeuristic, Settings, Shadow, Sharing, Tracer, Vertex,
};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::Color;
use crate::sampler::Sampler;
use crate::surface::Cone;

/// A sample is a path from the camera for each pixel, and a path from a light for each, which adds to any pixel. Of bidirectional
/// path tracing (Veach 1997, chapter 10) these are the strategies that connect no two vertices within a path: light paths find
/// what is lit by way of glass and mirrors, which paths from the camera meet by chance or never; these find what is seen by way
/// of them.
///
/// Surfaces have to block light from both sides: what lets rays through from behind only is not the same the other way round.
#[derive(Clone, Copy)]
pub struct Bidirectional<D: Domain, S, C, W> {
    /// Where random numbers come from.
    pub sampler: S,
    /// Length of paths, and when roulette begins.
    pub settings: Settings<D>,
    /// The camera, which light paths look for.
    pub camera: C,
    /// Who finds what.
    pub sharing: W,
}

/// The same call for whichever end paths begin at.
macro_rules! from_either_end {
    ($both:expr, $paths:ident => $call:expr) => {{
        let Bidirectional {
            sampler,
            settings,
            camera,
            sharing,
        } = *$both;
        match settings.origin {
            PathOrigin::Camera => {
                let $paths = CameraPaths {
                    paths: PathTracer {
                        sampler,
                        settings,
                        mis: PowerHeuristic,
                    },
                    camera,
                    sharing,
                };
                $call
            }
            PathOrigin::Lights => {
                let $paths = LightPaths {
                    sampler,
                    settings,
                    camera,
                    sharing,
                };
                $call
            }
        }
    }};
}

impl<D, S, C, W> Tracer<D> for Bidirectional<D, S, C, W>
where
    D: Domain,
    S: Sampler<D> + Copy,
    C: Camera<D> + Copy,
    W: Sharing,
{
    #[inline(always)]
    fn on_emit<K: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        camera: &K,
        lights: &L,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        from_either_end!(self, paths => paths.on_emit(d, camera, lights, pixel, sample))
    }

    #[inline(always)]
    fn path_origin(&self) -> Option<PathOrigin> {
        Some(self.settings.origin)
    }

    #[inline(always)]
    fn cone(&self, d: D, path: &Path<D>) -> Option<Cone<D>> {
        from_either_end!(self, paths => paths.cone(d, path))
    }

    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        from_either_end!(self, paths => paths.on_hit(d, path, vertex, lights))
    }

    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        from_either_end!(self, paths => paths.on_miss(d, path, lights))
    }

    #[inline(always)]
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
        from_either_end!(self, paths => paths.goes_on(d, path))
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Shadow<D>> {
        from_either_end!(self, paths => paths.on_shadow(d, path, vertex, lights))
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        from_either_end!(self, paths => paths.on_bounce(d, path, vertex))
    }
}
