//! sRGB (IEC 61966-2-1): decoding and encoding (hard case T-03).

use crate::domain::Domain;

/// The linear values of the 256 codes, correctly rounded.
pub fn srgb_table() -> [f32; 256] {
    std::array::from_fn(|code| srgb_decoded(code as f64 / 255.0) as f32)
}

/// The linear value of an encoded one, both from 0 to 1.
pub fn srgb_decoded(encoded: f64) -> f64 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// The 8-bit code of a linear value, for pictures; values outside [0, 1] are clamped, NaN is 0.
pub fn srgb_code(linear: f32) -> u8 {
    let c = f64::from(linear).clamp(0.0, 1.0);
    let encoded = if c <= 0.003_130_8 {
        12.92 * c
    } else {
        1.055 * c.powf(1.0 / 2.4) - 0.055
    };
    (encoded * 255.0).round() as u8
}

/// The linear value of an 8-bit code: relative error below 1e-6, increasing, and 0 and 1 are exact.
///
/// It is arithmetic, since lanes would read a table by one gather for each channel of each texel. With
/// y = (c + 0.055)/1.055, the curve is y^2.4 = y·(√y)^2.8, and the power of the root a polynomial: minimax in the relative
/// error over the codes, with p(1) = 1.
#[inline(always)]
pub(super) fn decode<D: Domain>(d: D, code: D::U) -> D::F {
    let code = d.to_real(code);
    let y = d.fma(code, d.lit(1.0 / (255.0 * 1.055)), d.lit(0.055 / 1.055));
    let t = d.sqrt(y);
    let p = d.fma(d.lit(-0.016_611_128_6), t, d.lit(0.087_311_963_0));
    let p = d.fma(p, t, d.lit(-0.234_118_504_7));
    let p = d.fma(p, t, d.lit(1.063_438_395_2));
    let p = d.fma(p, t, d.lit(0.109_835_822_6));
    let p = d.fma(p, t, d.lit(-0.010_436_928_46));
    let p = d.fma(p, t, d.lit(0.000_580_380_934_6));
    // Code 10 is the last one below 0.04045.
    let is_line = d.lt(code, d.lit(10.5));
    d.select(is_line, code * d.lit(1.0 / (255.0 * 12.92)), y * p)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encoding_undoes_decoding() {
        for (code, linear) in srgb_table().into_iter().enumerate() {
            assert_eq!(usize::from(srgb_code(linear)), code);
        }
        assert_eq!(
            [-1.0, f32::NAN, 2.0, f32::INFINITY].map(srgb_code),
            [0, 0, 255, 255]
        );
    }
}
