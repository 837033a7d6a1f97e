//! Absorption in bodies: what is lost between two surfaces.

use super::forward::forward;
use super::{Bounce, CostMap, Path, Shadow, Tracer, Vertex};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::layer::Layers;
use crate::light::LightKinds;
use crate::math::elementary::exp2;
use crate::math::{Color, Vec3};
use crate::record::record;
use crate::surface::Surface;

record! {
    /// A homogeneous medium. The first of a scene is the outside, which absorbs nothing.
    pub struct MediumRecord in Media {
        row {
            /// How often a unit of length halves the light.
            halvings: vector,
        }
    }
}

/// A tracer whose rays pass through bodies that absorb (KHR_materials_volume): Beer's law.
///
/// A path knows the one medium that it is in. It enters that of a body where it passes a surface of it from the front, and is
/// outside where it leaves it; bodies within bodies are not told apart from those beside one another.
#[derive(Clone, Copy)]
pub struct Absorbing<T> {
    /// What is done otherwise.
    pub tracer: T,
}

/// The share of light that passes through a length of a medium.
#[inline(always)]
fn transmittance<D: Domain>(d: D, medium: D::U, length: D::F) -> Color<D::F> {
    let MediumRecord { halvings } = MediumRecord::load(d, medium);
    halvings.map(|h| exp2(d, -(h * length)))
}

/// The medium on the side of a surface that a direction leads to.
#[inline(always)]
fn beyond<D: Domain, B>(d: D, path: &Path<D>, vertex: &Vertex<'_, D, B>, dir: Vec3<D::F>) -> D::U {
    let here = path.state.medium(d);
    let Some(interior) = vertex.interior else {
        return here;
    };
    let surface = vertex.surface;
    let passes = d.lt(surface.geometric_normal.dot(d, dir), d.lit(0.0));
    let there = d.select_u(surface.front, interior, d.uint(0));
    d.select_u(passes, there, here)
}

impl<D: Domain, T: Tracer<D>> Tracer<D> for Absorbing<T> {
    forward!(
        on_emit, wavelength, cone, on_hit, on_miss, goes_on, layers, cost_map
    );

    #[inline(always)]
    fn arrive(&self, d: D, path: &Path<D>, surface: &Surface<D>) -> Path<D> {
        let path = self.tracer.arrive(d, path, surface);
        let length = (surface.point - path.ray.org).length(d);
        let share = transmittance(d, path.state.medium(d), length);
        Path {
            throughput: path.throughput * share,
            ..path
        }
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Shadow<D>> {
        let shadow = self.tracer.on_shadow(d, path, vertex, lights)?;
        // A ray without an end leaves the scene; bodies have a surface, which is in its way.
        let is_finite = d.le(shadow.ray.tmax, d.lit(1.0));
        let length = d.select(is_finite, shadow.ray.dir.length(d), d.lit(0.0));
        let share = transmittance(d, beyond(d, path, vertex, shadow.ray.dir), length);
        Some(Shadow {
            contribution: shadow.contribution * share,
            ..shadow
        })
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        let mut bounce = self.tracer.on_bounce(d, path, vertex)?;
        let medium = beyond(d, path, vertex, bounce.path.ray.dir);
        bounce.path.state = bounce.path.state.in_medium(d, medium);
        Some(bounce)
    }
}
