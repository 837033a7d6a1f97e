//! What a render yields.

use std::time::Duration;

use residual_render::film::Film;
use residual_render::passes::RenderReport;

/// The image, and what it took.
pub struct Rendered {
    /// The image.
    pub film: Film,
    /// What was done.
    pub report: RenderReport,
    /// CPU time of this process meanwhile.
    pub cpu: Duration,
    /// From the start of the session to the first image file.
    pub first_image: Duration,
}
