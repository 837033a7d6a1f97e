//! A tracer that fills layers beside radiance.

use super::{Bounce, CostMap, Path, Shadow, Tracer, Vertex};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::layer::Layers;
use crate::light::LightKinds;
use crate::math::Color;
use crate::surface::Surface;

/// A set of layers: [`ConstLayers`] in emitted programs, the value itself in interpreted ones.
pub trait LayerSet {
    /// The set.
    fn layers(&self) -> Layers;
}

impl LayerSet for Layers {
    #[inline(always)]
    fn layers(&self) -> Layers {
        *self
    }
}

/// The set with these [bits](Layers::bits), known to the compiler.
#[derive(Clone, Copy, Debug)]
pub struct ConstLayers<const BITS: u32>;

impl<const BITS: u32> LayerSet for ConstLayers<BITS> {
    #[inline(always)]
    fn layers(&self) -> Layers {
        const { Layers::from_bits(BITS) }
    }
}

/// A tracer, and the layers that it fills.
#[derive(Clone, Copy)]
pub struct Layered<T, L> {
    /// What it does beside filling layers.
    pub tracer: T,
    /// The layers.
    pub layers: L,
}

impl<D: Domain, T: Tracer<D>, L: LayerSet> Tracer<D> for Layered<T, L> {
    #[inline(always)]
    fn on_emit<C: Camera<D>>(&self, d: D, camera: &C, pixel: [D::U; 2], sample: D::U) -> Path<D> {
        self.tracer.on_emit(d, camera, pixel, sample)
    }

    #[inline(always)]
    fn wavelength(&self, d: D, path: &Path<D>) -> Option<D::F> {
        self.tracer.wavelength(d, path)
    }

    #[inline(always)]
    fn arrive(&self, d: D, path: &Path<D>, surface: &Surface<D>) -> Path<D> {
        self.tracer.arrive(d, path, surface)
    }

    #[inline(always)]
    fn on_hit<B: Bsdf<D>, Li: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &Li,
    ) -> Option<Color<D::F>> {
        self.tracer.on_hit(d, path, vertex, lights)
    }

    #[inline(always)]
    fn on_miss<Li: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        lights: &Li,
    ) -> Option<Color<D::F>> {
        self.tracer.on_miss(d, path, lights)
    }

    #[inline(always)]
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
        self.tracer.goes_on(d, path)
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, Li: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &Li,
    ) -> Option<Shadow<D>> {
        self.tracer.on_shadow(d, path, vertex, lights)
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        self.tracer.on_bounce(d, path, vertex)
    }

    #[inline(always)]
    fn cost_map(&self) -> Option<CostMap> {
        self.tracer.cost_map()
    }

    #[inline(always)]
    fn layers(&self) -> Layers {
        self.layers.layers()
    }
}
