//! A tracer chosen at run time.

use super::forward::forward;
use super::{
    Absorption, AbsorptionAndScattering, AmbientOcclusion, AnyMatter, AnyMis, AnyNesting, AnyPaths,
    AnySharing, Bidirectional, Bounce, CostMap, Debug, DebugView, Dispersing, InMedia, Path,
    PathTracer, Settings, Shadow, Tracer, Vertex,
};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::Color;
use crate::sampler::Sampler;
use crate::surface::Surface;

/// Which tracer a renderer has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TracerNode {
    /// [`PathTracer`].
    Path(AnyMis),
    /// [`struct@Bidirectional`].
    Bidirectional(AnySharing),
    /// [`AmbientOcclusion`].
    AmbientOcclusion,
    /// [`struct@Debug`].
    Debug(DebugView),
}

/// What paths of a scene meet beside surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Between {
    /// Bodies that are filled with something, or lie within each other: [`InMedia`].
    pub media: Option<MediaNode>,
    /// Surfaces that bend wavelengths differently: [`Dispersing`].
    pub dispersion: bool,
}

impl Between {
    /// Whether bodies lie within each other.
    pub fn nests(self) -> bool {
        self.media
            .is_some_and(|media| media.nesting == AnyNesting::Nested)
    }
}

/// The kinds of media that paths meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct MediaNode {
    /// How bodies lie to each other.
    pub nesting: AnyNesting,
    /// What media do to light.
    pub matter: MatterNode,
}

/// What media do to light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MatterNode {
    /// [`Absorption`].
    Absorption,
    /// [`AbsorptionAndScattering`].
    AbsorptionAndScattering,
}

impl TracerNode {
    /// Its samples lie in [0, 1], whatever is in the scene.
    pub fn is_bounded(self) -> bool {
        matches!(self, Self::AmbientOcclusion)
    }

    /// Its paths carry light, so that the scene has to have some.
    pub fn needs_light(self) -> bool {
        matches!(self, Self::Path(_) | Self::Bidirectional(_))
    }

    /// Paths begin at lights, too.
    pub fn has_light_paths(self) -> bool {
        matches!(self, Self::Bidirectional(_))
    }
}

impl Default for TracerNode {
    fn default() -> Self {
        Self::Path(AnyMis::default())
    }
}

impl TracerNode {
    /// The tracer. `camera` is what light paths look for.
    #[inline(always)]
    pub fn tracer<D: Domain, S: Copy, C>(
        self,
        between: Between,
        sampler: S,
        settings: Settings<D>,
        camera: C,
    ) -> AnyTracer<D, S, C>
    where
        C: Copy,
    {
        let tracer = match self {
            Self::Path(mis) => AnyPaths::Path(PathTracer {
                sampler,
                settings,
                mis,
            }),
            Self::Bidirectional(sharing) => AnyPaths::Bidirectional(Bidirectional {
                sampler,
                settings,
                camera,
                sharing,
            }),
            Self::AmbientOcclusion => {
                return AnyTracer::AmbientOcclusion(AmbientOcclusion { sampler, settings });
            }
            Self::Debug(view) => {
                return AnyTracer::Debug(Debug {
                    sampler,
                    settings,
                    view,
                });
            }
        };
        let in_media = |media: MediaNode| InMedia {
            tracer,
            nesting: media.nesting,
            matter: media.matter.matter(sampler),
        };
        match (between.media, between.dispersion) {
            (None, false) => AnyTracer::Paths(tracer),
            (Some(media), false) => AnyTracer::InMedia(in_media(media)),
            (None, true) => AnyTracer::Dispersing(Dispersing { tracer, sampler }),
            (Some(media), true) => {
                let tracer = in_media(media);
                AnyTracer::Both(Dispersing { tracer, sampler })
            }
        }
    }
}

impl MatterNode {
    #[inline(always)]
    fn matter<S>(self, sampler: S) -> AnyMatter<S> {
        match self {
            Self::Absorption => AnyMatter::Absorption(Absorption),
            Self::AbsorptionAndScattering => {
                AnyMatter::AbsorptionAndScattering(AbsorptionAndScattering { sampler })
            }
        }
    }
}

/// Paths among media.
type PathsInMedia<D, S, C> = InMedia<AnyPaths<D, S, C>, AnyNesting, AnyMatter<S>>;

/// Any of the tracers: the interpreted renderer's.
#[derive(Clone, Copy)]
#[expect(
    missing_docs,
    reason = "each variant is the type of its name, or both types"
)]
pub enum AnyTracer<D: Domain, S, C> {
    Paths(AnyPaths<D, S, C>),
    InMedia(PathsInMedia<D, S, C>),
    Dispersing(Dispersing<AnyPaths<D, S, C>, S>),
    Both(Dispersing<PathsInMedia<D, S, C>, S>),
    AmbientOcclusion(AmbientOcclusion<D, S>),
    Debug(Debug<D, S>),
}

/// The same call for whichever tracer it is.
macro_rules! each {
    ($any:expr $(, $d:ident)?; $tracer:ident => $call:expr) => {
        match $any {
            AnyTracer::Paths($tracer) => $call,
            AnyTracer::InMedia($tracer) => $call,
            AnyTracer::Dispersing($tracer) => $call,
            AnyTracer::Both($tracer) => $call,
            AnyTracer::AmbientOcclusion($tracer) => $call,
            AnyTracer::Debug($tracer) => $call,
        }
    };
}

impl<D, S, C> Tracer<D> for AnyTracer<D, S, C>
where
    D: Domain,
    S: Sampler<D> + Copy,
    C: Camera<D> + Copy,
{
    forward!(
        through each;
        on_emit, path_origin, wavelength, cone, crossing, passage, on_hit, on_miss, goes_on, on_shadow,
        on_bounce, cost_map
    );
}
