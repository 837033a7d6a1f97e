//! What is said of images that no decoder reads.

/// Says that a decoder gave up.
pub(super) fn unreadable(error: impl std::fmt::Display) -> String {
    format!("cannot be read ({error})")
}
