//! Numbers about images and about noisy measurements: how far an image is from a reference ([`flip()`], [`relative_mse()`]),
//! and how certain a number is ([`Estimate`] of repeated measurements, [`Jackknifed`] of what is made from several parts).
//!
//! Images are linear red, green and blue, row by row.

mod estimate;
mod flip;
mod jackknife;
mod relative_mse;

pub use estimate::Estimate;
pub use flip::flip;
pub use jackknife::Jackknifed;
pub use relative_mse::relative_mse;
