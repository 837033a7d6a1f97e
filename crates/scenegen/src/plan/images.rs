//! Texels: every image that a program or an environment reads, once.

use residual_render::domain::Buffer;
use residual_render::scene_data::SceneData;

use super::PlanError;
use crate::desc::{ImageDesc, SceneDesc, Texels};

/// The images in use, with their places among the texels.
#[derive(Debug, Default)]
pub(super) struct Images {
    /// Number of the image, first word.
    places: Vec<(usize, u32)>,
    words: u64,
}

fn words(image: &ImageDesc) -> u64 {
    let texel = match image.texels {
        Texels::Rgba8(_) => 1,
        Texels::RgbaF32(_) => 4,
    };
    u64::from(image.width) * u64::from(image.height) * texel
}

impl Images {
    /// First word of an image among the texels, width, height.
    pub(super) fn place(&mut self, scene: &SceneDesc, image: usize) -> [u32; 3] {
        let desc = &scene.images[image];
        let found = self.places.iter().find(|(number, _)| *number == image);
        let first = found.map(|(_, first)| *first).unwrap_or_else(|| {
            let first = self.words as u32;
            self.places.push((image, first));
            self.words += words(desc);
            first
        });
        [first, desc.width, desc.height]
    }

    /// Writes the texels.
    pub(super) fn pack(&self, scene: &SceneDesc, data: &mut SceneData) -> Result<(), PlanError> {
        if self.words > u64::from(u32::MAX) {
            return Err(PlanError::TooLarge { what: "textures" });
        }
        let buffer = data.buffer_mut(Buffer::Texels);
        buffer.reserve_exact(self.words as usize);
        for &(image, _) in &self.places {
            match &scene.images[image].texels {
                Texels::Rgba8(texels) => {
                    buffer.extend(texels.iter().map(|&texel| u32::from_le_bytes(texel)));
                }
                Texels::RgbaF32(texels) => {
                    buffer.extend(texels.iter().flatten().map(|c| c.to_bits()));
                }
            }
        }
        Ok(())
    }
}
