//! How wrong an image is, and how certain that is.
//!
//! - Of one image: [`ErrorEstimate`], from running sums of its samples ([`PixelMoments`]), whoever made them; [`Convergence`] says how
//!   the error falls, and what less of it costs.
//! - Of one whose samples are bounded: [`guaranteed_mse()`], whatever no path has found.
//! - Of two: all metrics together in [`comparison`]; [`flip()`] and [`relative_mse()`] alone.
//! - Of many, by what they cost: [`sweep`] over numbers of samples, seeds and configurations.
//! - Of repeated measurements: [`Estimate`] of a median, [`Jackknifed`] of what is made from several parts.
//!
//! Images are linear red, green and blue, row by row.

pub mod color_map;
pub mod comparison;
mod contributions;
mod convergence;
mod distrust;
mod error_estimate;
mod estimate;
pub mod flip;
mod guarantee;
mod jackknife;
mod luminance;
mod moments;
mod normal;
mod plausible;
mod relative_mse;
mod sampled;
mod smoothed;
pub mod sweep;

pub use convergence::{Convergence, Forecast, Measured};
pub use distrust::Distrust;
pub use error_estimate::{ErrorEstimate, FEWEST_SAMPLES, Interval};
pub use estimate::Estimate;
pub use flip::flip;
pub use guarantee::guaranteed_mse;
pub use jackknife::Jackknifed;
pub use luminance::luminance;
pub use moments::{CHANNELS, MeanVariance, PixelMoments, SampleIndex, Y};
pub use normal::{normal_cdf, two_sided_tail};
pub use relative_mse::relative_mse;
pub use sampled::{Replicate, Sampled};
