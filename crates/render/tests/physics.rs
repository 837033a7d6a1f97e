//! Physics and numerics of the renderer's formulas, one topic a file. Seeds are fixed; families of statistical
//! tests are judged together (Šidák), and the judges themselves are shown to reject what is wrong.

mod adaptive_sampling;
mod bsdf_albedo;
mod bsdf_furnace;
mod bsdf_physics;
mod bsdf_reciprocity;
mod bsdf_sampling;
mod bsdf_transmission;
mod camera_sight;
mod domain;
mod domain_formulas;
mod elementary;
mod environment_light;
mod lights;
mod media;
mod microfacet;
mod sampler;
mod sized_lights;
mod solid_angle_lights;
mod spawn;
mod spectrum;
mod support;
mod texture_borders;
mod texture_levels;
mod textures;
mod vectors;
