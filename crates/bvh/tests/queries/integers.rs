//! Exact arithmetic on coordinates: integers of any size.

use num_bigint::{BigInt, Sign};

/// The number times 2¹⁴⁹, which must be finite.
pub(crate) fn integer(x: f32) -> BigInt {
    let (exponent, mantissa) = (x.to_bits() >> 23 & 255, x.to_bits() & 0x7f_ffff);
    let size = if exponent == 0 {
        BigInt::from(mantissa)
    } else {
        BigInt::from(mantissa | 1 << 23) << (exponent - 1)
    };
    if x < 0.0 { -size } else { size }
}

/// `p / q`, rounded.
pub(crate) fn quotient(p: &BigInt, q: &BigInt) -> f64 {
    if p.sign() == Sign::NoSign {
        return 0.0;
    }
    // So that the integer quotient has 100 bits or so.
    let shift = 100 + q.bits() as i32 - p.bits() as i32;
    let whole = if shift >= 0 {
        (p << shift) / q
    } else {
        p / (q << -shift)
    };
    let whole = i128::try_from(whole).expect("about 100 bits") as f64;
    whole * 2f64.powi(-shift)
}

/// `p · (q × r)`.
pub(crate) fn triple_product(p: &[BigInt; 3], q: &[BigInt; 3], r: &[BigInt; 3]) -> BigInt {
    let minor = |i: usize, j: usize| &q[i] * &r[j] - &q[j] * &r[i];
    &p[0] * minor(1, 2) + &p[1] * minor(2, 0) + &p[2] * minor(0, 1)
}
