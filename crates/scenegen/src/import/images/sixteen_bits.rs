//! Texels of 16 bits a channel, which may hold no more than bytes.

use crate::desc::Texels;

/// Bytes, if that loses nothing.
pub(super) fn of_16_bits(texels: &[[u16; 4]]) -> Texels {
    let is_byte = |&code: &u16| code % 257 == 0;
    if texels.as_flattened().iter().all(is_byte) {
        let byte = |code: u16| (code / 257) as u8;
        return Texels::Rgba8(texels.iter().map(|texel| texel.map(byte)).collect());
    }
    Texels::Rgba16(texels.to_vec())
}
