//! Texels: every image that a program or an environment reads, once.

use std::collections::BTreeMap;

use residual_render::domain::Buffer;
use residual_render::scene_data::SceneData;
use residual_render::texture::{AnyFormat, ImageParam, srgb_table};

use super::error::PlanError;
use crate::desc::{ImageDesc, SceneDesc, Texels};
use crate::sixteen_bits;

/// The images in use, with where they lie among the texels.
#[derive(Debug, Default)]
pub(super) struct Images {
    /// What lies among the texels, with its first word.
    firsts: Vec<(Stored, u32)>,
    words: u64,
    /// By the image's index, once asked for.
    extremes: BTreeMap<usize, Extremes>,
}

/// An image among the texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Stored {
    /// Its index in the scene.
    image: usize,
    /// Whether its codes of 16 bits are decoded from sRGB: they are stored as floats, of either kind.
    is_decoded: bool,
}

impl Stored {
    fn new(scene: &SceneDesc, image: usize, bytes: AnyFormat) -> Self {
        let is_decoded = match scene.images[image].texels {
            Texels::Rgba16(_) => bytes == AnyFormat::SrgbRgba8,
            Texels::Rgba8(_) | Texels::RgbaF32(_) => false,
        };
        Self { image, is_decoded }
    }
}

/// Least and greatest value of each channel of an image, as stored.
#[derive(Debug, Clone, Copy)]
enum Extremes {
    Bytes([[u8; 2]; 4]),
    Codes([[u16; 2]; 4]),
    Floats([[f32; 2]; 4]),
}

impl Extremes {
    fn of(texels: &Texels) -> Self {
        /// Least and greatest of each channel. There is at least one texel.
        fn fold<T: Copy + PartialOrd>(texels: &[[T; 4]]) -> [[T; 2]; 4] {
            let mut extremes = texels[0].map(|c| [c, c]);
            for texel in texels {
                for ([least, greatest], &c) in extremes.iter_mut().zip(texel) {
                    *least = if c < *least { c } else { *least };
                    *greatest = if c > *greatest { c } else { *greatest };
                }
            }
            extremes
        }
        match texels {
            Texels::Rgba8(texels) => Self::Bytes(fold(texels)),
            Texels::Rgba16(texels) => Self::Codes(fold(texels)),
            Texels::RgbaF32(texels) => Self::Floats(fold(texels)),
        }
    }
}

fn words(image: &ImageDesc) -> u64 {
    let texel = match image.texels {
        Texels::Rgba8(_) => 1,
        Texels::Rgba16(_) | Texels::RgbaF32(_) => 4,
    };
    u64::from(image.width) * u64::from(image.height) * texel
}

impl Images {
    /// The image among the texels, to which it is added if it is not there yet. `bytes` is how bytes would be read.
    pub(super) fn param(
        &mut self,
        scene: &SceneDesc,
        image: usize,
        bytes: AnyFormat,
    ) -> ImageParam {
        let desc = &scene.images[image];
        let wanted = Stored::new(scene, image, bytes);
        let found = self.firsts.iter().find(|(stored, _)| *stored == wanted);
        let first = found.map(|(_, first)| *first).unwrap_or_else(|| {
            let first = self.words as u32;
            self.firsts.push((wanted, first));
            self.words += words(desc);
            first
        });
        ImageParam {
            first,
            width: desc.width,
            height: desc.height,
        }
    }

    /// Least and greatest value that a channel has when it is read, bytes and codes of 16 bits as `format` says.
    pub(super) fn extremes(
        &mut self,
        scene: &SceneDesc,
        image: usize,
        channel: usize,
        format: AnyFormat,
    ) -> [f32; 2] {
        let texels = &scene.images[image].texels;
        let extremes = self.extremes.entry(image);
        let is_encoded = format == AnyFormat::SrgbRgba8 && channel < 3;
        match *extremes.or_insert_with(|| Extremes::of(texels)) {
            Extremes::Bytes(extremes) if is_encoded => {
                extremes[channel].map(|code| srgb_table()[usize::from(code)])
            }
            Extremes::Codes(extremes) if is_encoded => extremes[channel].map(sixteen_bits::decoded),
            Extremes::Codes(extremes) => extremes[channel].map(sixteen_bits::linear),
            Extremes::Bytes(extremes) => extremes[channel].map(|byte| f32::from(byte) / 255.0),
            Extremes::Floats(extremes) => extremes[channel],
        }
    }

    /// Writes the texels.
    pub(super) fn pack(&self, scene: &SceneDesc, data: &mut SceneData) -> Result<(), PlanError> {
        if self.words > u64::from(u32::MAX) {
            return Err(PlanError::TooLarge { what: "textures" });
        }
        let buffer = data.buffer_mut(Buffer::Texels);
        buffer.reserve_exact(self.words as usize);
        for &(Stored { image, is_decoded }, _) in &self.firsts {
            match &scene.images[image].texels {
                Texels::Rgba8(texels) => {
                    buffer.extend(texels.iter().map(|&texel| u32::from_le_bytes(texel)));
                }
                Texels::Rgba16(texels) => {
                    let texel = if is_decoded {
                        sixteen_bits::decoded_texel
                    } else {
                        sixteen_bits::linear_texel
                    };
                    let texels = texels.iter().flat_map(|&codes| texel(codes));
                    buffer.extend(texels.map(f32::to_bits));
                }
                Texels::RgbaF32(texels) => {
                    buffer.extend(texels.iter().flatten().map(|c| c.to_bits()));
                }
            }
        }
        Ok(())
    }
}
