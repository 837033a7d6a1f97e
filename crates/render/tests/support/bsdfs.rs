//! White BSDFs, and directions to see them from.

use residual_render::bsdf::{CoatedDiffuse, Conductor, Phong};
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::texture::Const;

pub(crate) type White = Const<[f32; 3]>;

pub(crate) const WHITE: White = Const([1.0; 3]);

pub(crate) fn coated(
    roughness: f32,
    reflectance: f32,
) -> CoatedDiffuse<White, Const<f32>, White, Const<f32>> {
    CoatedDiffuse {
        albedo: WHITE,
        roughness: Const(roughness),
        reflectance: Const([reflectance; 3]),
        grazing: Const(1.0),
    }
}

pub(crate) fn conductor(roughness: f32) -> Conductor<White, Const<f32>> {
    Conductor {
        color: WHITE,
        roughness: Const(roughness),
    }
}

pub(crate) fn phong(exponent: f32) -> Phong<White, Const<f32>> {
    Phong {
        color: WHITE,
        exponent: Const(exponent),
    }
}

/// A unit vector above the surface.
pub(crate) fn view(cos: f64, angle: f64) -> Vec3<f32> {
    let sin = (1.0 - cos * cos).sqrt();
    vec3(
        (sin * angle.cos()) as f32,
        (sin * angle.sin()) as f32,
        cos as f32,
    )
}
