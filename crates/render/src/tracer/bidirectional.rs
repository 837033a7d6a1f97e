//! Paths from both ends.

use super::camera_paths::CameraPaths;
use super::forward::forward;
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
    ($both:expr, $d:ident; $paths:ident => $call:expr) => {{
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
    forward!(
        through from_either_end;
        on_emit, cone, on_hit, on_miss, goes_on, on_shadow, on_bounce
    );

    #[inline(always)]
    fn path_origin(&self) -> Option<PathOrigin> {
        Some(self.settings.origin)
    }
}
