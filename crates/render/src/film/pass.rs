//! A pass of samples.

/// The samples of one pass, for every pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pass {
    /// Index of the first.
    pub first: u32,
    /// How many.
    pub count: u32,
}
