//! Luminance.

/// Luminance of a linear Rec. 709 colour.
pub(super) fn luminance([r, g, b]: [f32; 3]) -> f64 {
    0.2126 * f64::from(r) + 0.7152 * f64::from(g) + 0.0722 * f64::from(b)
}
