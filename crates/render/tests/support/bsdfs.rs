//! White BSDFs, and directions to see them from.

use residual_render::bsdf::{
    Coated, Diffuse, Glossy, Isotropic, Phong, RoughDielectric, RoughSheet, Schlick, Solid,
    rough_dielectric_albedos,
};
use residual_render::domain::Buffer;
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::scene_data::SceneData;
use residual_render::texture::Const;

use super::scenes::{FLOOR, scene};

pub(crate) type White = Const<[f32; 3]>;

pub(crate) const WHITE: White = Const([1.0; 3]);

/// Reflection by facets that are turned the same in all directions.
pub(crate) type Facets = Glossy<Schlick<Const<[f32; 3]>, Const<f32>>, Isotropic<Const<f32>>>;

/// A matte surface under a coat.
pub(crate) type Plastic = Coated<Facets, Diffuse<Const<[f32; 3]>>>;

pub(crate) fn facets(normal: [f32; 3], grazing: f32, roughness: f32) -> Facets {
    Glossy {
        fresnel: Schlick {
            normal: Const(normal),
            grazing: Const(grazing),
        },
        roughness: Isotropic {
            roughness: Const(roughness),
        },
    }
}

/// A metal.
pub(crate) fn metal(color: [f32; 3], roughness: f32) -> Facets {
    facets(color, 1.0, roughness)
}

/// A matte surface under a coat.
pub(crate) fn plastic(albedo: [f32; 3], roughness: f32, coat: [f32; 2]) -> Plastic {
    Coated {
        coat: facets([coat[0]; 3], coat[1], roughness),
        base: Diffuse {
            albedo: Const(albedo),
        },
    }
}

pub(crate) fn coated(roughness: f32, reflectance: f32) -> Plastic {
    plastic([1.0; 3], roughness, [reflectance, 1.0])
}

pub(crate) fn conductor(roughness: f32) -> Facets {
    metal([1.0; 3], roughness)
}

pub(crate) fn phong(exponent: f32) -> Phong<White, Const<f32>> {
    Phong {
        color: WHITE,
        exponent: Const(exponent),
    }
}

/// A body of frosted glass.
pub(crate) type Frosted = RoughDielectric<White, Const<f32>, Isotropic<Const<f32>>, Solid>;

/// A pane of frosted glass.
pub(crate) type FrostedSheet = RoughSheet<White, Const<f32>, Isotropic<Const<f32>>>;

pub(crate) fn frosted(tint: [f32; 3], ior: f32, roughness: f32) -> Frosted {
    RoughDielectric {
        transmittance: Const(tint),
        ior: Const(ior),
        roughness: Isotropic {
            roughness: Const(roughness),
        },
        interface: Solid,
        albedos: 0,
    }
}

pub(crate) fn frosted_sheet(tint: [f32; 3], ior: f32, roughness: f32) -> FrostedSheet {
    RoughSheet {
        transmittance: Const(tint),
        ior: Const(ior),
        roughness: Isotropic {
            roughness: Const(roughness),
        },
    }
}

/// A floor, whose parameters are the albedos of [`frosted`] glass of this index of refraction.
pub(crate) fn glass_scene(ior: f32) -> SceneData {
    let mut data = scene(&[FLOOR]);
    let albedos = rough_dielectric_albedos(ior);
    *data.buffer_mut(Buffer::Params) = albedos.into_iter().map(f32::to_bits).collect();
    data
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
