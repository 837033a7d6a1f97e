//! A tracer of light chosen at run time, before what its paths meet between surfaces.

use super::{
    AnyMis, AnySharing, Bidirectional, Bounce, Path, PathOrigin, PathTracer, Shadow, Tracer, Vertex,
};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::Color;
use crate::sampler::Sampler;
use crate::surface::Cone;

/// Either of the tracers whose paths carry light.
#[derive(Clone, Copy)]
#[expect(missing_docs, reason = "each variant is the type of its name")]
pub enum AnyPaths<D: Domain, S, C> {
    Path(PathTracer<D, S, AnyMis>),
    Bidirectional(Bidirectional<D, S, C, AnySharing>),
}

/// Calls that all wrappers of the tracer share a copy of: it is what few renders ask for, and much to compile.
#[inline(never)]
fn apart<D: Domain, R>(d: D, call: impl FnOnce() -> R) -> R {
    d.vectorize(call)
}

/// The same call for whichever tracer it is.
macro_rules! either {
    ($any:expr, $d:expr, $paths:ident => $call:expr) => {
        match $any {
            AnyPaths::Path($paths) => $call,
            AnyPaths::Bidirectional($paths) => apart(
                $d,
                #[inline(always)]
                || $call,
            ),
        }
    };
}

impl<D, S, C> Tracer<D> for AnyPaths<D, S, C>
where
    D: Domain,
    S: Sampler<D> + Copy,
    C: Camera<D> + Copy,
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
        either!(self, d, paths => paths.on_emit(d, camera, lights, pixel, sample))
    }

    #[inline(always)]
    fn path_origin(&self) -> Option<PathOrigin> {
        match self {
            Self::Path(_) => None,
            Self::Bidirectional(paths) => paths.path_origin(),
        }
    }

    #[inline(always)]
    fn cone(&self, d: D, path: &Path<D>) -> Option<Cone<D>> {
        either!(self, d, paths => paths.cone(d, path))
    }

    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        either!(self, d, paths => paths.on_hit(d, path, vertex, lights))
    }

    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        either!(self, d, paths => paths.on_miss(d, path, lights))
    }

    #[inline(always)]
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
        either!(self, d, paths => paths.goes_on(d, path))
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Shadow<D>> {
        either!(self, d, paths => paths.on_shadow(d, path, vertex, lights))
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        either!(self, d, paths => paths.on_bounce(d, path, vertex))
    }
}
