//! From a scene file to a renderer: import, plan, effects, emission.

pub mod ablation;
pub mod build_script;
pub mod desc;
pub mod desc_inputs;
mod desc_validate;
mod effect;
pub mod effects;
pub mod emit;
mod fingerprint;
mod ground;
mod half;
pub mod import;
mod light_sizes;
pub mod plan;
mod sixteen_bits;
mod studio;

pub use desc_validate::Violation;
pub use fingerprint::{StructureMismatch, fingerprint};
