//! A tracer of light chosen at run time, before what its paths meet between surfaces.

use super::forward::forward;
use super::{
    AnyMis, AnySharing, Bidirectional, Bounce, Path, PathOrigin, PathTracer, Shadow, Tracer, Vertex,
};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::Color;
use crate::sampler::Sampler;

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
    ($any:expr, $d:ident; $paths:ident => $call:expr) => {
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
    forward!(
        through either;
        on_emit, cone, on_hit, on_miss, goes_on, on_shadow, on_bounce
    );

    #[inline(always)]
    fn path_origin(&self) -> Option<PathOrigin> {
        match self {
            Self::Path(_) => None,
            Self::Bidirectional(paths) => paths.path_origin(),
        }
    }
}
