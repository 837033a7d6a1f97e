//! From a scene file to a renderer: import, effects, plan, emission.

pub mod desc;
mod desc_validate;
pub mod effects;
pub mod emit;
pub mod import;
pub mod plan;

pub use desc_validate::Violation;
