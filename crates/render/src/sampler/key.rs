//! What a sampler is asked for, and what it answers.

use super::hash::hash;
use crate::domain::{Domain, Unsigned};

/// Which sample of which pixel.
#[derive(Clone, Copy, Debug)]
pub struct SampleKey<U> {
    /// A hash of pixel and seed.
    pub pixel: U,
    /// Index of the sample in its pixel.
    pub index: U,
}

impl<U: Unsigned> SampleKey<U> {
    /// Sample `index` of the pixel at (x, y), both below 2¹⁶, of a render with this seed. No two pixels of a render
    /// have the same hash: it is a bijection of the pixel's place.
    #[inline(always)]
    pub fn new<D: Domain<U = U>>(d: D, x: U, y: U, index: U, seed: U) -> Self {
        let place = (y << 16) | x;
        let pixel = hash(d, hash(d, place) ^ hash(d, seed + d.uint(0x5bd1_e995)));
        Self { pixel, index }
    }
}

/// A source of random numbers.
pub trait Sampler<D: Domain> {
    /// Two numbers in [0, 1): the largest is 1 − 2⁻²⁴. Dimensions are independent of one another.
    fn pair(&self, d: D, key: SampleKey<D::U>, dimension: D::U) -> [D::F; 2];
}
