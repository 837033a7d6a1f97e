//! What every program that renders shares, be it the command line or the renderer of a single scene: [`options`], a
//! [`session`] with progress, interruption and images on the way, [statistics](stats), the [precision] reached, and image files
//! ([`output`] with [`cryptomatte`], [`input`], and [`pictures`] of numbers), and lines on the [`console`].

mod clock;
pub mod console;
pub mod cryptomatte;
pub mod display;
pub mod input;
pub mod options;
pub mod output;
pub mod pictures;
pub mod precision;
pub mod progress;
mod rendered;
pub mod session;
pub mod stats;

pub use clock::process_time;
pub use rendered::Rendered;

use residual_bvh::BuildQuality;

/// Quality of the hierarchy that rendering is fastest with: `Best` takes five times as long to build as `High`, and rays in flight
/// gain nothing by it. `High` takes less than 1 s for a million triangles.
pub fn hierarchy_quality(triangles: usize) -> BuildQuality {
    match triangles {
        0..=10_000_000 => BuildQuality::High,
        _ => BuildQuality::Medium,
    }
}
