//! From words to words that look random, and to numbers in [0, 1).

use crate::domain::Domain;

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
