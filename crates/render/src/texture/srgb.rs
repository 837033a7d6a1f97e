//! sRGB (IEC 61966-2-1): decoding by a table of 256 entries, correctly rounded (hard case T-03), and encoding.

use crate::domain::{Buffer, Domain};

/// The linear values of the 256 codes, as they stand at the start of [`Buffer::Tables`].
pub fn srgb_table() -> [f32; 256] {
    std::array::from_fn(|code| {
        let c = code as f64 / 255.0;
        let linear = if c <= 0.04045 {
            c / 12.92
        } else {
            ((c + 0.055) / 1.055).powf(2.4)
        };
        linear as f32
    })
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

/// The linear value of an 8-bit code.
#[inline(always)]
pub(super) fn decode<D: Domain>(d: D, code: D::U) -> D::F {
    d.load_real(Buffer::Tables, code)
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
