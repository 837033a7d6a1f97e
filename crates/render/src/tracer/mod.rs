//! Tracers: what is computed along rays, apart from how a device schedules it (thesis, section 3.3).
//!
//! A device calls `on_emit` for each sample, `on_hit` and `on_miss` for what rays found, `on_shadow` for light
//! arriving directly, and `on_bounce` for the way on. "Nothing to do" is a mask, not a way out of the function,
//! so that lanes stay together.

mod path;

pub use path::PathTracer;

use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::{Color, Vec3};
use crate::sampler::SampleKey;
use crate::surface::{Ray, Surface};

/// A path between two hits.
#[derive(Clone, Copy)]
pub struct Path<D: Domain> {
    /// The ray about to be traced, or just traced.
    pub ray: Ray<D>,
    /// What the ray's radiance counts for in the pixel.
    pub throughput: Color<D::F>,
    /// Density, per steradian, with which the BSDF proposed the ray's direction; 0 for camera rays and delta
    /// lobes, which light sampling cannot find.
    pub pdf: D::F,
    /// Its random numbers.
    pub key: SampleKey<D::U>,
}

/// A shadow ray with what it is worth if nothing is in its way.
#[derive(Clone, Copy)]
pub struct Shadow<D: Domain> {
    /// The ray.
    pub ray: Ray<D>,
    /// Contribution to the pixel.
    pub contribution: Color<D::F>,
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

/// A surface point with its BSDF, seen along a path.
#[derive(Clone, Copy)]
pub struct Vertex<'a, D: Domain, B> {
    /// The point.
    pub surface: &'a Surface<D>,
    /// Its BSDF.
    pub bsdf: &'a B,
    /// Unit direction back along the path, world space.
    pub wo: Vec3<D::F>,
    /// Number of the vertex on its path; the first is 1.
    pub depth: D::U,
}

/// What is computed along rays.
pub trait Tracer<D: Domain> {
    /// The camera ray of a sample of the pixel at (x, y).
    fn on_emit<C: Camera<D>>(
        &self,
        d: D,
        camera: &C,
        pixel: [D::U; 2],
        key: SampleKey<D::U>,
    ) -> Path<D>;

    /// The contribution of light that the surface emits along the path. `light` is its number.
    fn on_hit(
        &self,
        d: D,
        path: &Path<D>,
        surface: &Surface<D>,
        emission: Color<D::F>,
        light: D::U,
    ) -> Color<D::F>;

    /// The contribution of what a ray that hit nothing sees.
    fn on_miss<L: LightKinds<D> + ?Sized>(&self, d: D, path: &Path<D>, lights: &L) -> Color<D::F>;

    /// Light that arrives at the vertex directly.
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Shadow<D>;

    /// The way on from the vertex.
    fn on_bounce<B: Bsdf<D>>(&self, d: D, path: &Path<D>, vertex: &Vertex<'_, D, B>) -> Bounce<D>;
}
