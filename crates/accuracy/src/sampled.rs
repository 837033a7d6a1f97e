//! What an estimate is made from: the samples of each pixel, and second samples of some.

use crate::moments::PixelMoments;

/// A pixel's samples.
#[derive(Clone, Copy, Debug)]
pub struct Sampled<'a> {
    /// Their sums.
    pub moments: &'a PixelMoments,
    /// How many there are.
    pub samples: u64,
}

/// A second, independent set of as many samples of a pixel, with points of the same kind.
#[derive(Clone, Copy, Debug)]
pub struct Replicate<'a> {
    /// Index of the pixel.
    pub pixel: usize,
    /// Its second set of samples.
    pub sampled: Sampled<'a>,
}
