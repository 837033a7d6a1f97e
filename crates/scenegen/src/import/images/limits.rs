//! What images may be.

/// The largest width and height.
pub(super) const MAX_EXTENT: u32 = 16384;

/// What infinities become, and what is beyond: renderers multiply and add radiance, and its squares are summed up in `f64`.
pub(super) const LARGEST_RADIANCE: f32 = 1e30;
