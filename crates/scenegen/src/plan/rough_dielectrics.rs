//! The albedos of rough dielectrics: a table for each index of refraction, made once.

use std::collections::BTreeMap;

use residual_render::bsdf::rough_dielectric_albedos;

/// The tables of the indices of refraction that were asked for.
#[derive(Default)]
pub(super) struct RoughDielectrics {
    by_ior: BTreeMap<u32, Vec<f32>>,
}

impl RoughDielectrics {
    /// The table for an index of refraction.
    pub(super) fn albedos(&mut self, ior: f32) -> &[f32] {
        let table = self.by_ior.entry(ior.to_bits());
        table.or_insert_with(|| rough_dielectric_albedos(ior))
    }
}
