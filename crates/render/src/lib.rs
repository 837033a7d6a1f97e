//! The renderer, generic over an arithmetic domain: every formula once.
#![forbid(unsafe_code)]

pub mod alias_table;
pub mod alpha;
pub mod bsdf;
pub mod camera;
pub mod changed_data;
pub mod cryptomatte;
pub mod domain;
pub mod film;
pub mod layer;
pub mod light;
pub mod material;
pub mod math;
pub mod passes;
pub mod program;
pub mod record;
pub mod renderer;
pub mod sampler;
pub mod scene_data;
mod scene_file;
pub mod shutter;
pub mod surface;
pub mod texture;
pub mod tracer;
pub mod triangle;

pub use scene_file::NotSceneData;
