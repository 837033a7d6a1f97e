//! Dispersion: paths that meet a surface which bends wavelengths differently are of one wavelength from there on.

use super::camera_pairs::WAVELENGTH;
use super::forward::forward;
use super::{Bounce, CostMap, Path, Shadow, Tracer, Vertex};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::layer::Layers;
use crate::light::LightKinds;
use crate::math::Color;
use crate::math::spectrum::{color_of, wavelength_at};
use crate::sampler::Sampler;
use crate::surface::Surface;

/// A tracer in a scene with dispersive surfaces (KHR_materials_dispersion). The wavelength of a sample is chosen with its
/// other random numbers; a path becomes of it at the first dispersive surface that it meets, whose colour then weighs it.
#[derive(Clone, Copy)]
pub struct Dispersing<T, S> {
    /// What is done otherwise.
    pub tracer: T,
    /// Where the wavelength comes from.
    pub sampler: S,
}

impl<T, S> Dispersing<T, S> {
    #[inline(always)]
    fn chosen<D: Domain>(&self, d: D, path: &Path<D>) -> D::F
    where
        S: Sampler<D>,
    {
        let [u, _] = self.sampler.pair(d, path.key, d.uint(WAVELENGTH));
        wavelength_at(d, u)
    }

    /// What a path is weighed with where it leaves a surface.
    #[inline(always)]
    fn weight<D: Domain>(&self, d: D, path: &Path<D>) -> Color<D::F>
    where
        S: Sampler<D>,
    {
        let is_spectral = path.state.is_spectral(d);
        color_of(d, self.chosen(d, path)).map(|c| d.select(is_spectral, d.lit(1.0), c))
    }
}

impl<D: Domain, T: Tracer<D>, S: Sampler<D>> Tracer<D> for Dispersing<T, S> {
    forward!(
        on_emit,
        path_origin,
        cone,
        crossing,
        passage,
        on_hit,
        on_miss,
        goes_on,
        layers,
        cost_map
    );

    #[inline(always)]
    fn wavelength(&self, d: D, path: &Path<D>) -> Option<D::F> {
        Some(self.chosen(d, path))
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
        if !vertex.disperses {
            return Some(shadow);
        }
        Some(Shadow {
            contribution: shadow.contribution * self.weight(d, path),
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
        if vertex.disperses {
            bounce.path.throughput = bounce.path.throughput * self.weight(d, path);
            bounce.path.state = bounce.path.state.spectral(d);
        }
        Some(bounce)
    }
}
