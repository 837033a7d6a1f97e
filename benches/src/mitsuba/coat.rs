//! Coats over matte bases as a BSDF of `peers/mitsuba_coat.py`, since Mitsuba's own scatter differently.

use residual_render::bsdf::Bsdf;
use residual_render::domain::Scalar;
use residual_render::material::Material;
use residual_render::math::Vec3;
use residual_render::program::{BoxedMaterial, BsdfNode, Program};
use residual_render::surface::Surface;

/// Cosines at which the file says what a coat reflects: at as many in between it is linear within 1e-4.
const COSINES: usize = 257;

/// What a coat of a program reflects in all at evenly spaced cosines from 0 to 1, with spaces between.
pub(super) fn albedos<'a>(
    program: &Program,
    coat: &BsdfNode,
    (d, point): (Scalar<'a>, Surface<Scalar<'a>>),
) -> String {
    let coat = Program {
        bsdf: coat.clone(),
        ..program.clone()
    };
    let coat = BoxedMaterial::new(&coat);
    let albedo = |index: usize| {
        let cos = index as f32 / (COSINES - 1) as f32;
        let wo = Vec3::from([(1.0 - cos * cos).sqrt(), 0.0, cos]);
        let mut surface = point;
        let shading = coat.shade(d, &mut surface, wo);
        let [albedo, ..] = shading.bsdf.albedo(d, &surface, wo).to_array();
        albedo.to_string()
    };
    (0..COSINES).map(albedo).collect::<Vec<_>>().join(" ")
}
