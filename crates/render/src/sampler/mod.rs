//! Random numbers, two at a time.
//!
//! A sampler has no state: numbers are a pure function of pixel, sample, dimension and seed, so that the
//! order of evaluation, the number of lanes and the number of threads cannot change an image.

mod any;
mod hash;
mod independent;
mod key;
mod sobol;

pub use any::AnySampler;
pub use hash::{hash, unit};
pub use independent::Independent;
pub use key::{SampleKey, Sampler};
pub use sobol::Sobol;
