//! Pictures of the same part of the image, after the same time, as data in the page.

use anyhow::Result;
use residual_accuracy::comparison::{Image, Pair, PixelErrors};
use residual_accuracy::luminance;
use residual_frontend::output::encode_png;
use residual_render::texture::srgb_code;

use crate::findings::{Crop, Study};
use crate::reference::Reference;

/// Pixels along a crop's side, at most.
const SIDE: usize = 64;

/// The part of the reference's luminances that is shown below white.
const BELOW_WHITE: f64 = 0.95;

/// The part of the image that is shown, and how bright.
pub(super) struct Window {
    corner: [usize; 2],
    size: [usize; 2],
    width: usize,
    exposure: f32,
}

impl Window {
    /// The part in which the baseline errs the most.
    pub(super) fn of(study: &Study) -> Result<Self> {
        let reference = &study.reference;
        let [width, height] = reference.size;
        let baseline = &study.crops[0];
        let pair = Pair::new(reference.as_image(), Image::new(&baseline.image, width))?;
        let tile = PixelErrors::of(&pair).worst_tile(32).tile;
        let size = [width.min(SIDE), height.min(SIDE)];
        // The worst tile in the middle, as far as the image goes.
        let middle = [tile.x + tile.width / 2, tile.y + tile.height / 2];
        let corner = |k: usize| {
            middle[k]
                .saturating_sub(size[k] / 2)
                .min([width, height][k] - size[k])
        };
        let mut window = Self {
            corner: [corner(0), corner(1)],
            size,
            width,
            exposure: 1.0,
        };
        let mut luminances: Vec<f64> = window.pixels(&reference.image).map(luminance).collect();
        luminances.sort_by(f64::total_cmp);
        let bright = luminances[(BELOW_WHITE * (luminances.len() - 1) as f64) as usize];
        if bright > 0.0 {
            window.exposure = (0.8 / bright) as f32;
        }
        Ok(window)
    }

    fn pixels<'a>(&self, image: &'a [[f32; 3]]) -> impl Iterator<Item = [f32; 3]> + use<'a> {
        let Self {
            corner: [x, y],
            size: [width, height],
            width: stride,
            ..
        } = *self;
        let rows = image.chunks_exact(stride).skip(y).take(height);
        rows.flat_map(move |row| &row[x..x + width]).copied()
    }

    /// The crop as an image of the page.
    fn picture(&self, image: &[[f32; 3]], label: &str) -> Result<String> {
        let code = |value: f32| srgb_code(self.exposure * value);
        let codes = self.pixels(image).flat_map(|rgb| rgb.map(code)).collect();
        let png = encode_png(self.size, codes)?;
        Ok(format!(
            "<img alt=\"{label}\" src=\"data:image/png;base64,{}\" width=\"{}\" height=\"{}\">",
            base64(&png),
            3 * self.size[0],
            3 * self.size[1]
        ))
    }

    pub(super) fn of_reference(&self, reference: &Reference) -> Result<String> {
        self.picture(&reference.image, "reference")
    }

    pub(super) fn of_crop(&self, crop: &Crop) -> Result<String> {
        self.picture(&crop.image, crop.configuration.name)
    }
}

/// Bytes as text (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for k in 0..4 {
            text.push(match k <= three.len() {
                true => DIGITS[(bits >> (18 - 6 * k) & 63) as usize] as char,
                false => '=',
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::base64;

    #[test]
    fn text_is_that_of_the_standard() {
        let cases = [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ];
        for (bytes, text) in cases {
            assert_eq!(base64(bytes.as_bytes()), text);
        }
    }
}
