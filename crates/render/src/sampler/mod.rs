//! Random numbers, two at a time.
//!
//! A sampler has no state: numbers are a pure function of pixel, sample, dimension and seed, so that the
//! order of evaluation, the number of lanes and the number of threads cannot change an image.

mod independent;
mod sobol;

pub use independent::Independent;
pub use sobol::Sobol;

use crate::domain::Domain;

/// Which sample of which pixel.
#[derive(Clone, Copy, Debug)]
pub struct SampleKey<U> {
    /// A hash of pixel and seed.
    pub pixel: U,
    /// Number of the sample in its pixel.
    pub index: U,
}

impl<U: crate::domain::Unsigned> SampleKey<U> {
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

/// A well-mixed hash of 32 bits (Wellons' `lowbias32`); a bijection.
#[inline(always)]
pub fn hash<D: Domain>(d: D, x: D::U) -> D::U {
    let x = (x ^ (x >> 16)) * d.uint(0x7feb_352d);
    let x = (x ^ (x >> 15)) * d.uint(0x846c_a68b);
    x ^ (x >> 16)
}

/// The upper 24 bits as a number in [0, 1). All 24 bits are kept: the result is never 1 (hard case S-04).
#[inline(always)]
pub fn unit<D: Domain>(d: D, x: D::U) -> D::F {
    d.to_real(x >> 8) * d.lit(1.0 / 16_777_216.0)
}

/// A sampler chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnySampler {
    /// [`Independent`].
    Independent,
    /// [`Sobol`].
    Sobol,
}

impl<D: Domain> Sampler<D> for AnySampler {
    #[inline(always)]
    fn pair(&self, d: D, key: SampleKey<D::U>, dimension: D::U) -> [D::F; 2] {
        match self {
            Self::Independent => Independent.pair(d, key, dimension),
            Self::Sobol => Sobol.pair(d, key, dimension),
        }
    }
}
