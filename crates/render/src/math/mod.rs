//! Vectors, elementary functions and sampling warps over any domain.

pub mod elementary;
pub mod frame;
pub mod fresnel;
pub mod spectrum;
pub mod spherical_triangle;
pub mod vec3;
pub mod warp;

pub use frame::Frame;
pub use spherical_triangle::SphericalTriangle;
pub use vec3::{Color, Vec3};
