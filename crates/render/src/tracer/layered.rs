//! A tracer that fills layers beside radiance.

use super::forward::forward;
use super::{Bounce, CostMap, Path, PathOrigin, Shadow, Tracer, Vertex};
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

impl<D: Domain, T: Tracer<D>, S: LayerSet> Tracer<D> for Layered<T, S> {
    forward!(
        on_emit,
        path_origin,
        wavelength,
        cone,
        crossing,
        passage,
        on_hit,
        on_miss,
        goes_on,
        on_shadow,
        on_bounce,
        cost_map
    );

    /// Those of paths from the camera: what a light path meets is in no pixel yet.
    #[inline(always)]
    fn layers(&self) -> Layers {
        match self.tracer.path_origin() {
            Some(PathOrigin::Lights) => Layers::NONE,
            None | Some(PathOrigin::Camera) => self.layers.layers(),
        }
    }
}
