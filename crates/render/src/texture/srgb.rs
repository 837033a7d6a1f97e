//! Decoding of sRGB (IEC 61966-2-1): a table of 256 entries, correctly rounded (hard case T-03).

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

/// The linear value of an 8-bit code.
#[inline(always)]
pub(super) fn decode<D: Domain>(d: D, code: D::U) -> D::F {
    d.load_real(Buffer::Tables, code)
}
