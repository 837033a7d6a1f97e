//! From a scene file to a renderer: import, effects, plan, emission.

pub mod desc;
mod desc_validate;
pub mod emit;
pub mod import;

pub use desc_validate::Violation;
