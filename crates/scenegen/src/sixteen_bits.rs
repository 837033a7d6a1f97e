//! Texels of 16 bits a channel, as numbers. Programs read them as floats, since renderers have formats for bytes and for
//! floats only; which curve the codes follow is known by the use, as with bytes.

use std::sync::LazyLock;

use residual_render::texture::srgb_decoded;

/// What codes of a colour stand for, encoded as sRGB.
static DECODED: LazyLock<Vec<f32>> = LazyLock::new(|| {
    let decoded = |code: u16| srgb_decoded(f64::from(code) / 65535.0) as f32;
    (0..=u16::MAX).map(decoded).collect()
});

/// A channel as a number in [0, 1].
pub(crate) fn linear(code: u16) -> f32 {
    f32::from(code) / 65535.0
}

/// A channel of a colour, decoded from sRGB.
pub(crate) fn decoded(code: u16) -> f32 {
    DECODED[usize::from(code)]
}

/// A texel whose colour is linear.
pub(crate) fn linear_texel(texel: [u16; 4]) -> [f32; 4] {
    texel.map(linear)
}

/// A texel whose colour is encoded as sRGB.
pub(crate) fn decoded_texel([r, g, b, a]: [u16; 4]) -> [f32; 4] {
    [decoded(r), decoded(g), decoded(b), linear(a)]
}
