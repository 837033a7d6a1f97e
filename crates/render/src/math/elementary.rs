//! Elementary functions as polynomials, the same in every domain.
//!
//! Platform libraries differ from one another, and GPUs more so; these do not. Coefficients are those of
//! Moshier's Cephes library (single precision). The stated bounds are for `f32` and are tested against `f64`.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, LN_2, PI, TAU};

use crate::domain::Domain;

/// (sin 2πu, cos 2πu); absolute error below 1.5e-7 for |u| ≤ 4.
#[inline(always)]
pub fn sincos_turns<D: Domain>(d: D, u: D::F) -> (D::F, D::F) {
    let quarter = d.floor(d.fma(u, d.lit(4.0), d.lit(0.5)));
    let x = (u - quarter * d.lit(0.25)) * d.lit(TAU);
    let z = x * x;
    let p = d.fma(d.lit(-1.951_529_589_1e-4), z, d.lit(8.332_160_873_6e-3));
    let p = d.fma(p, z, d.lit(-1.666_665_461_1e-1));
    let sin = d.fma(p * z, x, x);
    let q = d.fma(
        d.lit(2.443_315_711_809_948e-5),
        z,
        d.lit(-1.388_731_625_493_765e-3),
    );
    let q = d.fma(q, z, d.lit(4.166_664_568_298_827e-2));
    let cos = d.fma(q * z, z, d.fma(z, d.lit(-0.5), d.lit(1.0)));
    // The quarter, modulo 4, as a number in {0, 1, 2, 3}.
    let quarter = quarter - d.floor(quarter * d.lit(0.25)) * d.lit(4.0);
    let odd = d.eq(
        quarter - d.floor(quarter * d.lit(0.5)) * d.lit(2.0),
        d.lit(1.0),
    );
    let (s, c) = (d.select(odd, cos, sin), d.select(odd, sin, cos));
    let s_negative = d.le(d.lit(2.0), quarter);
    let c_negative = d.eq(quarter, d.lit(1.0)) | d.eq(quarter, d.lit(2.0));
    (d.select(s_negative, -s, s), d.select(c_negative, -c, c))
}

/// The angle of (x, y) in (−π, π]; absolute error below 4e-7; 0 at the origin.
#[inline(always)]
pub fn atan2<D: Domain>(d: D, y: D::F, x: D::F) -> D::F {
    let (ax, ay) = (d.abs(x), d.abs(y));
    let t = d.min(ax, ay) / d.max(d.max(ax, ay), d.lit(1e-37));
    let upper = d.lt(d.lit(0.414_213_562_373_095_f64), t);
    let one = d.lit(1.0);
    let r = d.select(upper, (t - one) / (t + one), t);
    let z = r * r;
    let p = d.fma(d.lit(8.053_744_495_38e-2), z, d.lit(-1.387_768_560_32e-1));
    let p = d.fma(p, z, d.lit(1.997_771_064_78e-1));
    let p = d.fma(p, z, d.lit(-3.333_294_915_39e-1));
    let a = d.fma(p * z, r, r) + d.select(upper, d.lit(FRAC_PI_4), d.lit(0.0));
    let a = d.select(d.lt(ax, ay), d.lit(FRAC_PI_2) - a, a);
    let a = d.select(d.lt(x, d.lit(0.0)), d.lit(PI) - a, a);
    d.copysign(a, y)
}

/// 2^x for −126 ≤ x ≤ 127 (clamped); relative error below 2e-7.
#[inline(always)]
pub fn exp2<D: Domain>(d: D, x: D::F) -> D::F {
    let x = d.min(d.max(x, d.lit(-126.0)), d.lit(127.0));
    let whole = d.floor(x + d.lit(0.5));
    let f = (x - whole) * d.lit(LN_2);
    let p = d.fma(d.lit(1.987_569_150_0e-4), f, d.lit(1.398_199_950_7e-3));
    let p = d.fma(p, f, d.lit(8.333_451_907_3e-3));
    let p = d.fma(p, f, d.lit(4.166_579_589_4e-2));
    let p = d.fma(p, f, d.lit(1.666_666_545_9e-1));
    let p = d.fma(p, f, d.lit(5.000_000_120_1e-1));
    let e = d.fma(p * f, f, f + d.lit(1.0));
    let power = d.from_bits(d.to_uint(whole + d.lit(127.0)) << 23);
    e * power
}

/// log₂ x for normal x > 0; absolute error below 2e-7 near 1, relative below 2e-7 elsewhere.
#[inline(always)]
pub fn log2<D: Domain>(d: D, x: D::F) -> D::F {
    let bits = d.to_bits(x);
    let exponent = d.to_real(bits >> 23) - d.lit(127.0);
    let mantissa = d.from_bits((bits & d.uint(0x007f_ffff)) | d.uint(0x3f80_0000));
    let high = d.lt(d.lit(std::f64::consts::SQRT_2), mantissa);
    let m = d.select(high, mantissa * d.lit(0.5), mantissa);
    let exponent = d.select(high, exponent + d.lit(1.0), exponent);
    // log₂ m = 2/ln 2 · artanh s, s = (m − 1)/(m + 1), |s| ≤ 0.1716.
    let s = (m - d.lit(1.0)) / (m + d.lit(1.0));
    let z = s * s;
    let p = d.fma(d.lit(1.0 / 9.0), z, d.lit(1.0 / 7.0));
    let p = d.fma(p, z, d.lit(1.0 / 5.0));
    let p = d.fma(p, z, d.lit(1.0 / 3.0));
    let artanh = d.fma(p * z, s, s);
    d.fma(artanh, d.lit(2.0 / LN_2), exponent)
}

/// x^y for x ≥ 0; 0 for x below the smallest normal number. Relative error below 3e-7·(1 + |y·log₂ x|).
#[inline(always)]
pub fn pow<D: Domain>(d: D, x: D::F, y: D::F) -> D::F {
    let smallest = d.lit(f64::from(f32::MIN_POSITIVE));
    let power = exp2(d, y * log2(d, d.max(x, smallest)));
    d.select(d.lt(x, smallest), d.lit(0.0), power)
}
