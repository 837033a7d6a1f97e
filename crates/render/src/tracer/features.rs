//! What the layers of an image keep of the first vertex of a path.

use super::{Path, Vertex};
use crate::bsdf::Bsdf;
use crate::domain::Domain;
use crate::layer::{FAR, Layer, Layers};
use crate::triangle::ObjectRecord;

/// Numbers of the layers that a renderer has: the channels of a sample behind its radiance.
#[derive(Clone, Copy, Debug)]
pub struct Features<D: Domain> {
    /// The path is at its first vertex.
    pub first: D::M,
    channels: [D::F; Layers::MAX_STRIDE - Layers::RADIANCE],
}

impl<D: Domain> Features<D> {
    /// Of a vertex.
    #[inline(always)]
    pub(super) fn new<B: Bsdf<D>>(
        d: D,
        layers: Layers,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Self {
        let surface = vertex.surface;
        let mut features = Self::nothing(d, path);
        let object = || ObjectRecord::load(d, surface.object);
        let mut put = |layer, values: &[D::F]| features.put(layers, layer, values);
        if layers.has(Layer::Albedo) {
            let wo = surface.frame.to_local(d, vertex.wo);
            // Denoisers take no more than 1, which files may have.
            let albedo = vertex.bsdf.albedo(d, surface, wo);
            let albedo = albedo.map(|c| d.min(d.max(c, d.lit(0.0)), d.lit(1.0)));
            put(Layer::Albedo, &[albedo.x, albedo.y, albedo.z]);
        }
        if layers.has(Layer::Normal) {
            let normal = surface.frame.normal;
            put(Layer::Normal, &[normal.x, normal.y, normal.z]);
        }
        if layers.has(Layer::Depth) {
            put(Layer::Depth, &[(surface.point - path.ray.org).length(d)]);
        }
        if layers.has(Layer::Position) {
            let point = surface.point;
            put(Layer::Position, &[point.x, point.y, point.z]);
        }
        // Indices stay exact as numbers up to 2²⁴.
        if layers.has(Layer::ObjectIndex) {
            let index = d.to_real(surface.object + d.uint(1));
            put(Layer::ObjectIndex, &[index]);
        }
        if layers.has(Layer::MaterialIndex) {
            let index = d.to_real(object().material + d.uint(1));
            put(Layer::MaterialIndex, &[index]);
        }
        if layers.has(Layer::CryptoObject) {
            put(Layer::CryptoObject, &[object().name_id]);
        }
        if layers.has(Layer::CryptoMaterial) {
            put(Layer::CryptoMaterial, &[object().material_name_id]);
        }
        features
    }

    /// Of a camera ray that hits nothing.
    #[inline(always)]
    pub fn of_miss(d: D, layers: Layers, path: &Path<D>) -> Self {
        let mut features = Self::nothing(d, path);
        if layers.has(Layer::Depth) {
            features.put(layers, Layer::Depth, &[d.lit(f64::from(FAR))]);
        }
        features
    }

    #[inline(always)]
    fn nothing(d: D, path: &Path<D>) -> Self {
        Self {
            first: path.state.is_first(d),
            channels: [d.lit(0.0); Layers::MAX_STRIDE - Layers::RADIANCE],
        }
    }

    #[inline(always)]
    fn put(&mut self, layers: Layers, layer: Layer, values: &[D::F]) {
        let offset = layers.offset(layer) - Layers::RADIANCE;
        self.channels[offset..offset + values.len()].copy_from_slice(values);
    }

    /// The channels of a set of layers, in the order of a sample.
    #[inline(always)]
    pub fn channels(&self, layers: Layers) -> &[D::F] {
        &self.channels[..layers.stride() - Layers::RADIANCE]
    }
}
