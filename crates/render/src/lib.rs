//! The renderer, generic over an arithmetic domain: every formula once.
#![forbid(unsafe_code)]

pub mod bsdf;
pub mod camera;
pub mod domain;
pub mod light;
pub mod material;
pub mod math;
pub mod sampler;
pub mod surface;
pub mod texture;
pub mod tracer;
