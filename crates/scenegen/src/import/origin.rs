//! Scenes far from the origin, as surveys and scans are: their positions are relative to a place among them, as 32 bits
//! do not hold both where a scene is and what it looks like.

use glam::DVec3;

/// Scenes are far if their centre is so many times farther from the origin than from their own corners.
const FAR: f64 = 100.0;

/// The place that positions between these corners are relative to, of whole coordinates; the origin for scenes that are
/// not far, or where there is nothing.
pub(super) fn choose([low, high]: [DVec3; 2]) -> DVec3 {
    let (center, half_extent) = (0.5 * (low + high), 0.5 * (high - low));
    let is_far = center.is_finite() && center.abs().max_element() > FAR * half_extent.max_element();
    if is_far { center.round() } else { DVec3::ZERO }
}
