//! A tracer chosen at run time.

use super::{
    Absorption, AbsorptionAndScattering, AmbientOcclusion, AnyMatter, AnyMis, AnyNesting, AnyPaths,
    AnySharing, Bidirectional, Bounce, CostMap, Crossing, Debug, DebugView, Dispersing, InMedia,
    Passage, Path, PathOrigin, PathTracer, Settings, Shadow, Tracer, Vertex,
};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::Color;
use crate::sampler::Sampler;
use crate::surface::{Cone, Surface};

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
    ($any:expr, $tracer:ident => $call:expr) => {
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
    #[inline(always)]
    fn on_emit<K: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        camera: &K,
        lights: &L,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        each!(self, tracer => tracer.on_emit(d, camera, lights, pixel, sample))
    }

    #[inline(always)]
    fn path_origin(&self) -> Option<PathOrigin> {
        each!(self, tracer => tracer.path_origin())
    }

    #[inline(always)]
    fn wavelength(&self, d: D, path: &Path<D>) -> Option<D::F> {
        each!(self, tracer => tracer.wavelength(d, path))
    }

    #[inline(always)]
    fn cone(&self, d: D, path: &Path<D>) -> Option<Cone<D>> {
        each!(self, tracer => tracer.cone(d, path))
    }

    #[inline(always)]
    fn crossing(
        &self,
        d: D,
        path: &Path<D>,
        surface: &Surface<D>,
        interior: D::U,
    ) -> Option<Crossing<D>> {
        each!(self, tracer => tracer.crossing(d, path, surface, interior))
    }

    #[inline(always)]
    fn passage(&self, d: D, path: &Path<D>, surface: &Surface<D>) -> Option<Passage<D>> {
        each!(self, tracer => tracer.passage(d, path, surface))
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
