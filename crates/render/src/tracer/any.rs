//! A tracer chosen at run time.

use super::{
    AmbientOcclusion, AnyMis, Bounce, CostMap, Debug, DebugView, Path, PathTracer, Settings,
    Shadow, Tracer, Vertex,
};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::Color;
use crate::sampler::Sampler;

/// Which tracer a renderer has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TracerNode {
    /// [`PathTracer`].
    Path(AnyMis),
    /// [`AmbientOcclusion`].
    AmbientOcclusion,
    /// [`struct@Debug`].
    Debug(DebugView),
}

impl TracerNode {
    /// Its samples lie in [0, 1], whatever is in the scene.
    pub fn is_bounded(self) -> bool {
        matches!(self, Self::AmbientOcclusion)
    }
}

impl Default for TracerNode {
    fn default() -> Self {
        Self::Path(AnyMis::default())
    }
}

impl TracerNode {
    /// The tracer.
    #[inline(always)]
    pub fn tracer<D: Domain, S>(self, sampler: S, settings: Settings<D>) -> AnyTracer<D, S> {
        match self {
            Self::Path(mis) => AnyTracer::Path(PathTracer {
                sampler,
                settings,
                mis,
            }),
            Self::AmbientOcclusion => {
                AnyTracer::AmbientOcclusion(AmbientOcclusion { sampler, settings })
            }
            Self::Debug(view) => AnyTracer::Debug(Debug {
                sampler,
                settings,
                view,
            }),
        }
    }
}

/// Any of the tracers: the interpreted renderer's.
#[derive(Clone, Copy)]
#[expect(missing_docs, reason = "each variant is the type of its name")]
pub enum AnyTracer<D: Domain, S> {
    Path(PathTracer<D, S, AnyMis>),
    AmbientOcclusion(AmbientOcclusion<D, S>),
    Debug(Debug<D, S>),
}

/// The same call for whichever tracer it is.
macro_rules! each {
    ($any:expr, $tracer:ident => $call:expr) => {
        match $any {
            AnyTracer::Path($tracer) => $call,
            AnyTracer::AmbientOcclusion($tracer) => $call,
            AnyTracer::Debug($tracer) => $call,
        }
    };
}

impl<D: Domain, S: Sampler<D>> Tracer<D> for AnyTracer<D, S> {
    #[inline(always)]
    fn on_emit<C: Camera<D>>(&self, d: D, camera: &C, pixel: [D::U; 2], sample: D::U) -> Path<D> {
        each!(self, tracer => tracer.on_emit(d, camera, pixel, sample))
    }

    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        each!(self, tracer => tracer.on_hit(d, path, vertex, lights))
    }

    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        each!(self, tracer => tracer.on_miss(d, path, lights))
    }

    #[inline(always)]
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
        each!(self, tracer => tracer.goes_on(d, path))
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Shadow<D>> {
        each!(self, tracer => tracer.on_shadow(d, path, vertex, lights))
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        each!(self, tracer => tracer.on_bounce(d, path, vertex))
    }

    #[inline(always)]
    fn cost_map(&self) -> Option<CostMap> {
        each!(self, tracer => tracer.cost_map())
    }
}
