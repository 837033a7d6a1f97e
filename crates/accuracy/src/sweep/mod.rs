//! What accuracy costs: statistics of renders (or any other estimates) that were measured at several numbers of samples, with
//! several seeds and in several configurations. Nothing here renders; what is measured comes in as numbers and images.
//!
//! - [`Series`]: runs of one configuration, with medians, slope and the time to an error. Its [`ErrorCurve`] is
//!   error = b² + v·x^−β.
//! - [`squared_bias()`]: b², from images of independent seeds.
//! - [`pareto_front()`] and its [`knee()`] over all configurations; [`FailureRate`] of what fails only rarely.
//!
//! ```
//! use residual_accuracy::sweep::{Measurement, Series};
//!
//! // Three seeds, four numbers of samples; 10 ms a sample, and an error of 0.5 / N, one seed a little better than another.
//! let run = |luck: f64| {
//!     [1_u64, 4, 16, 64].map(|samples| Measurement {
//!         samples,
//!         seconds: 0.01 * samples as f64,
//!         error: luck * 0.5 / samples as f64,
//!     })
//! };
//! let series = Series::new([0.9, 1.0, 1.1].map(|luck| run(luck).to_vec()).to_vec())?;
//! assert!((series.slope(0.0).unwrap().value + 1.0).abs() < 1e-9);
//! // An error of 10⁻⁴ takes 5000 samples.
//! let time = series.time_to(1e-4, 0.0).unwrap();
//! assert!((time.value / 50.0 - 1.0).abs() < 1e-9 && time.low < 50.0 && 50.0 < time.high);
//! # Ok::<(), residual_accuracy::sweep::UnequalRuns>(())
//! ```

mod error_curve;
mod failure_rate;
mod pareto;
mod series;
mod squared_bias;

pub use error_curve::ErrorCurve;
pub use failure_rate::FailureRate;
pub use pareto::{knee, pareto_front};
pub use series::{Level, Measurement, Series, UnequalRuns};
pub use squared_bias::squared_bias;
