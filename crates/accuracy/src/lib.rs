//! How wrong an image is, and how certain that is.
//!
//! - Of one image: [`ErrorEstimate`], from running sums of its samples ([`PixelMoments`]), whoever made them.
//! - Of two: [`flip()`], [`relative_mse()`].
//! - Of repeated measurements: [`Estimate`] of a median, [`Jackknifed`] of what is made from several parts.
//!
//! Images are linear red, green and blue, row by row.

mod convergence;
mod error_estimate;
mod estimate;
mod flip;
mod jackknife;
mod moments;
mod plausible;
mod relative_mse;

pub use convergence::{Convergence, Forecast, Measured};
pub use error_estimate::{Distrust, ErrorEstimate, FEWEST_SAMPLES, Interval, Replicate, Sampled};
pub use estimate::Estimate;
pub use flip::flip;
pub use jackknife::Jackknifed;
pub use moments::{CHANNELS, LUMINANCE, MeanVariance, PixelMoments, SampleIndex, Y};
pub use relative_mse::relative_mse;
