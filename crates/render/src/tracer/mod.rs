//! Tracers: what is computed along rays, apart from how a device schedules it (thesis, section 3.3).
//!
//! A tracer owns every policy: how long paths are, which lobes go on, what is added to the image where a ray hits,
//! misses or arrives at a light. A device calls [`Tracer::on_emit`] for each sample, [`shade`] for each hit,
//! [`Tracer::on_miss`] for the rest, and traces what comes back.
//!
//! What a scene decides is static: a method that has nothing to give returns `None`, and its code disappears. What a
//! path decides is a mask, so that lanes stay together.

mod ambient_occlusion;
mod any;
mod any_paths;
mod bidirectional;
mod camera_pairs;
mod camera_paths;
mod cost_map;
mod crossing;
mod debug;
mod dispersing;
mod features;
mod forward;
mod in_media;
mod layered;
mod light_paths;
mod matter;
mod medium;
mod mis;
mod nesting;
mod next_event;
mod passage;
mod path;
mod path_origin;
mod path_state;
mod rivals;
mod settings;
mod sharing;
mod step;
mod vertex_pairs;
mod way_on;

pub use ambient_occlusion::AmbientOcclusion;
pub use any::{AnyTracer, Between, MatterNode, MediaNode, TracerNode};
pub use any_paths::AnyPaths;
pub use bidirectional::Bidirectional;
pub use cost_map::CostMap;
pub use crossing::Crossing;
pub use debug::{Debug, DebugView};
pub use dispersing::Dispersing;
pub use features::Features;
pub use in_media::InMedia;
pub use layered::{ConstLayers, LayerSet, Layered};
pub use matter::{Absorption, AbsorptionAndScattering, AnyMatter, Matter};
pub use medium::MediumRecord;
pub use mis::{AnyMis, BalanceHeuristic, BsdfOnly, LightsOnly, Mis, PowerHeuristic};
pub use nesting::{AnyNesting, Beside, Nested, Nesting};
pub use passage::{Passage, Scattering};
pub use path::PathTracer;
pub use path_origin::PathOrigin;
pub use path_state::{MAX_DEPTH, MAX_MEDIA, PathState};
pub use settings::{Settings, TracerOptions};
pub use sharing::{AnySharing, Combined, LightPathsOnly, Sharing};
pub use step::{Step, shade};

use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::{Bundle, Domain};
use crate::layer::Layers;
use crate::light::LightKinds;
use crate::math::{Color, Vec3};
use crate::sampler::SampleKey;
use crate::surface::{Cone, PathRay, Surface};

/// A path between two hits.
#[derive(Clone, Copy)]
pub struct Path<D: Domain> {
    /// The ray about to be traced, or just traced. Its direction is a unit vector.
    pub ray: PathRay<D>,
    /// What the ray's radiance counts for in the pixel.
    pub throughput: Color<D::F>,
    /// Density, per steradian, with which the BSDF proposed the ray's direction; 0 for camera rays and delta
    /// lobes, which light sampling cannot find.
    pub pdf: D::F,
    /// What rival strategies are worth that find the same light (`tracer/rivals.rs`); 0 in tracers that have none. Of the first ray of a light
    /// path, [`Emission::found`](crate::light::Emission::found), with [`Emission::spread`](crate::light::Emission::spread) for `pdf`,
    /// negative if it comes from infinitely far away.
    pub rivals: D::F,
    /// Its random numbers.
    pub key: SampleKey<D::U>,
    /// What it remembers of its way.
    pub state: PathState<D::U>,
}

/// A shadow ray with what it is worth if nothing is in its way.
#[derive(Clone, Copy)]
pub struct Shadow<D: Domain> {
    /// The ray.
    pub ray: PathRay<D>,
    /// Contribution to the pixel.
    pub contribution: Color<D::F>,
    /// The pixel, counted row by row from the top, if it is not that of the path.
    pub pixel: Option<D::U>,
    /// It is worth tracing.
    pub active: D::M,
}

/// The way on.
#[derive(Clone, Copy)]
pub struct Bounce<D: Domain> {
    /// The continued path.
    pub path: Path<D>,
    /// It goes on.
    pub active: D::M,
}

impl<D: Domain> Bundle<D> for Shadow<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            ray: PathRay::choose(d, mask, a.ray, b.ray),
            contribution: Vec3::choose(d, mask, a.contribution, b.contribution),
            pixel: a.pixel.zip(b.pixel).map(|(a, b)| d.select_u(mask, a, b)),
            active: d.select_mask(mask, a.active, b.active),
        }
    }
}

/// Of two ways on from one vertex.
impl<D: Domain> Bundle<D> for Bounce<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            path: Path {
                ray: PathRay::choose(d, mask, a.path.ray, b.path.ray),
                throughput: Vec3::choose(d, mask, a.path.throughput, b.path.throughput),
                pdf: d.select(mask, a.path.pdf, b.path.pdf),
                rivals: d.select(mask, a.path.rivals, b.path.rivals),
                key: a.path.key,
                state: PathState(d.select_u(mask, a.path.state.0, b.path.state.0)),
            },
            active: d.select_mask(mask, a.active, b.active),
        }
    }
}

/// A vertex of a path: a surface point with what its material says of it.
#[derive(Clone, Copy)]
pub struct Vertex<'a, D: Domain, B> {
    /// The point.
    pub surface: &'a Surface<D>,
    /// Index of the triangle.
    pub triangle: D::U,
    /// Radiance emitted back along the path, if the material emits at all.
    pub emission: Option<Color<D::F>>,
    /// Its BSDF.
    pub bsdf: &'a B,
    /// The surface as that of a body, if it is one and the scene has media.
    pub crossing: Option<Crossing<D>>,
    /// The vertex is a place within a medium, which stands for the surface.
    pub is_in_medium: bool,
    /// Where the path is scattered before it gets to the surface, if the scene has media that scatter.
    pub scattering: Option<Scattering<D>>,
    /// The surface bends wavelengths differently.
    pub disperses: bool,
    /// Unit direction back along the path, world space.
    pub wo: Vec3<D::F>,
}

impl<D: Domain, B> Vertex<'_, D, B> {
    /// The vertex at a place within a medium that stands instead of the surface.
    #[inline(always)]
    fn scattered<'b, P>(&self, place: &'b Surface<D>, phase: &'b P) -> Vertex<'b, D, P> {
        Vertex {
            surface: place,
            triangle: self.triangle,
            emission: None,
            bsdf: phase,
            crossing: None,
            is_in_medium: true,
            scattering: None,
            disperses: false,
            wo: self.wo,
        }
    }
}

/// What is computed along rays.
pub trait Tracer<D: Domain> {
    /// The path that begins sample `sample` of the pixel at (x, y): with a camera ray, or, of tracers that [have light
    /// paths](Tracer::path_origin), with what leaves a light.
    fn on_emit<C: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        camera: &C,
        lights: &L,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D>;

    /// Where the paths of this tracer begin, if a sample of the image is a path from the camera and one from a light for each
    /// pixel, which adds to any pixel ([`Shadow::pixel`]).
    #[inline(always)]
    fn path_origin(&self) -> Option<PathOrigin> {
        None
    }

    /// The wavelength that materials are evaluated for, in nanometres, if the path has one.
    #[inline(always)]
    fn wavelength(&self, _d: D, _path: &Path<D>) -> Option<D::F> {
        None
    }

    /// The cone that the path's ray stands for, where it is known: what textures are filtered over.
    #[inline(always)]
    fn cone(&self, _d: D, _path: &Path<D>) -> Option<Cone<D>> {
        None
    }

    /// What a path meets at the surface of a body that is filled with medium `interior`, if the tracer knows media.
    #[inline(always)]
    fn crossing(
        &self,
        _d: D,
        _path: &Path<D>,
        _surface: &Surface<D>,
        _interior: D::U,
    ) -> Option<Crossing<D>> {
        None
    }

    /// What happens to a path on its way to a surface, if anything may.
    #[inline(always)]
    fn passage(&self, _d: D, _path: &Path<D>, _surface: &Surface<D>) -> Option<Passage<D>> {
        None
    }

    /// The contribution of the vertex itself.
    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        _d: D,
        _path: &Path<D>,
        _vertex: &Vertex<'_, D, B>,
        _lights: &L,
    ) -> Option<Color<D::F>> {
        None
    }

    /// The contribution of what a ray that hit nothing sees.
    #[inline(always)]
    fn on_miss<L: LightKinds<D> + ?Sized>(
        &self,
        _d: D,
        _path: &Path<D>,
        _lights: &L,
    ) -> Option<Color<D::F>> {
        None
    }

    /// Whether the path is short enough for a shadow ray and a bounce from its vertex.
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M;

    /// A ray from the vertex that counts if it is not occluded.
    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        _d: D,
        _path: &Path<D>,
        _vertex: &Vertex<'_, D, B>,
        _lights: &L,
    ) -> Option<Shadow<D>> {
        None
    }

    /// The way on from the vertex.
    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        _d: D,
        _path: &Path<D>,
        _vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        None
    }

    /// The layers that are filled beside radiance.
    #[inline(always)]
    fn layers(&self) -> Layers {
        Layers::NONE
    }

    /// How the cost of tracing a camera ray is shown, if that is what the image is of.
    #[inline(always)]
    fn cost_map(&self) -> Option<CostMap> {
        None
    }
}

/// A direction is on the same side of the geometric and of the shading surface.
#[inline(always)]
fn consistent<D: Domain>(d: D, surface: &Surface<D>, world: Vec3<D::F>, local: Vec3<D::F>) -> D::M {
    d.lt(d.lit(0.0), surface.geometric_normal.dot(d, world) * local.z)
}
