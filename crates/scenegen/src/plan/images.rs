//! Texels: every image that a program or an environment reads, once.

use std::collections::BTreeMap;

use residual_render::domain::Buffer;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;
use residual_render::texture::{
    AnyFilter, AnyFormat, ImageParam, TexelFormat, srgb_code, srgb_table,
};

use super::error::PlanError;
use super::image_levels::{self, Texel};
use crate::desc::{ImageDesc, SceneDesc, Texels};
use crate::{half, sixteen_bits};

/// The images in use, with where they lie among the texels.
#[derive(Debug, Default)]
pub(super) struct Images {
    /// What lies among the texels, with its first word.
    firsts: Vec<(Stored, u32)>,
    words: u64,
    /// By the image's index, once asked for.
    extremes: BTreeMap<usize, Extremes>,
    /// The same of whether all of its numbers are halves.
    are_halves: BTreeMap<usize, bool>,
}

/// Something among the texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stored {
    /// An image.
    Image(StoredImage),
    /// Its levels: a record for each of them, and the texels of those that are not the image itself.
    Levels(StoredImage),
}

/// An image among the texels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct StoredImage {
    /// Its index in the scene.
    image: usize,
    /// How its texels are stored.
    storage: Storage,
}

/// How texels are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Storage {
    /// As they are.
    Bytes,
    /// Codes of 16 bits as what they stand for.
    LinearFloats,
    /// Codes of 16 bits as what they stand for, decoded from sRGB.
    DecodedFloats,
    /// Numbers of which 16 bits are enough.
    Halves,
    /// As they are.
    Floats,
}

impl Storage {
    /// Words of a texel.
    fn words(self) -> u64 {
        let format = match self {
            Self::Bytes => AnyFormat::SrgbRgba8,
            Self::Halves => AnyFormat::LinearHalf,
            Self::LinearFloats | Self::DecodedFloats | Self::Floats => AnyFormat::LinearFloat,
        };
        u64::from(format.words())
    }

    /// Writes a texel; bytes are those of sRGB.
    fn write(self, texel: Texel, words: &mut Vec<u32>) {
        match self {
            Self::Bytes => {
                let [r, g, b, a] = texel;
                let alpha = (a * 255.0).round() as u8;
                let [r, g, b] = [r, g, b].map(srgb_code);
                words.push(u32::from_le_bytes([r, g, b, alpha]));
            }
            Self::Halves => {
                let [r, g, b, a] = texel.map(|number| u32::from(half::rounded(number)));
                words.extend([r | g << 16, b | a << 16]);
            }
            Self::LinearFloats | Self::DecodedFloats | Self::Floats => {
                words.extend(texel.map(f32::to_bits));
            }
        }
    }
}

impl StoredImage {
    fn new(scene: &SceneDesc, image: usize, [bytes, format]: [AnyFormat; 2]) -> Self {
        let storage = match (&scene.images[image].texels, format) {
            (Texels::Rgba8(_), _) => Storage::Bytes,
            (Texels::Rgba16(_), _) if bytes == AnyFormat::SrgbRgba8 => Storage::DecodedFloats,
            (Texels::Rgba16(_), _) => Storage::LinearFloats,
            (Texels::RgbaF32(_), AnyFormat::LinearHalf) => Storage::Halves,
            (Texels::RgbaF32(_), _) => Storage::Floats,
        };
        Self { image, storage }
    }

    /// A texel of the image, linear; bytes are those of sRGB.
    fn texel(self, texels: &Texels, index: usize) -> Texel {
        match texels {
            Texels::Rgba8(texels) => {
                let [r, g, b, a] = texels[index];
                let [r, g, b] = [r, g, b].map(|code| sixteen_bits::decoded(u16::from(code) * 257));
                [r, g, b, f32::from(a) / 255.0]
            }
            Texels::Rgba16(texels) if self.storage == Storage::DecodedFloats => {
                sixteen_bits::decoded_texel(texels[index])
            }
            Texels::Rgba16(texels) => sixteen_bits::linear_texel(texels[index]),
            Texels::RgbaF32(texels) => texels[index],
        }
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

fn size(image: &ImageDesc) -> [u32; 2] {
    [image.width, image.height]
}

fn count([width, height]: [u32; 2]) -> u64 {
    u64::from(width) * u64::from(height)
}

impl Stored {
    /// Words among the texels.
    fn words(self, scene: &SceneDesc) -> u64 {
        let record = u64::from(<ImageParam as BufferRecord>::WORDS);
        match self {
            Self::Image(StoredImage { image, storage }) => {
                count(size(&scene.images[image])) * storage.words()
            }
            Self::Levels(StoredImage { image, storage }) => {
                let sizes = image_levels::sizes(size(&scene.images[image]));
                let smaller: u64 = sizes[1..].iter().copied().map(count).sum();
                sizes.len() as u64 * record + smaller * storage.words()
            }
        }
    }
}

impl Images {
    /// How an image's texels are read; `bytes` is how bytes would be.
    pub(super) fn format(
        &mut self,
        scene: &SceneDesc,
        image: usize,
        bytes: AnyFormat,
    ) -> AnyFormat {
        match &scene.images[image].texels {
            Texels::Rgba8(_) => bytes,
            Texels::Rgba16(_) => AnyFormat::LinearFloat,
            Texels::RgbaF32(texels) => {
                let are_halves = self.are_halves.entry(image);
                let are_exact = || {
                    texels
                        .iter()
                        .flatten()
                        .all(|&number| half::is_exact(number))
                };
                match are_halves.or_insert_with(are_exact) {
                    true => AnyFormat::LinearHalf,
                    false => AnyFormat::LinearFloat,
                }
            }
        }
    }

    /// An image among the texels, to which it is added if it is not there yet, and so are its levels where the filter reads them.
    /// `formats` are how bytes would be read, and how the image's texels are.
    pub(super) fn param(
        &mut self,
        scene: &SceneDesc,
        image: usize,
        formats: [AnyFormat; 2],
        filter: AnyFilter,
    ) -> ImageParam {
        let stored = StoredImage::new(scene, image, formats);
        let first = self.place(scene, Stored::Image(stored));
        let levels = match filter {
            AnyFilter::Nearest | AnyFilter::Bilinear => 0,
            AnyFilter::Trilinear => self.place(scene, Stored::Levels(stored)),
        };
        let [width, height] = size(&scene.images[image]);
        ImageParam {
            first,
            width,
            height,
            levels,
        }
    }

    /// An environment's image among the texels.
    pub(super) fn environment(&mut self, scene: &SceneDesc, image: usize) -> ImageParam {
        let formats = [AnyFormat::LinearFloat; 2];
        self.param(scene, image, formats, AnyFilter::Bilinear)
    }

    /// The first word of something among the texels.
    fn place(&mut self, scene: &SceneDesc, wanted: Stored) -> u32 {
        let found = self.firsts.iter().find(|(stored, _)| *stored == wanted);
        found.map(|(_, first)| *first).unwrap_or_else(|| {
            let first = self.words as u32;
            self.firsts.push((wanted, first));
            self.words += wanted.words(scene);
            first
        })
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
        for &(stored, first) in &self.firsts {
            match stored {
                Stored::Image(stored) => pack_image(scene, stored, buffer),
                Stored::Levels(stored) => {
                    let found = self.firsts.iter();
                    let mut found = found.filter(|(other, _)| *other == Stored::Image(stored));
                    let (_, image) = found.next().expect("levels are of an image");
                    pack_levels(scene, stored, [*image, first], buffer);
                }
            }
        }
        Ok(())
    }
}

fn pack_image(scene: &SceneDesc, stored: StoredImage, buffer: &mut Vec<u32>) {
    let texels = &scene.images[stored.image].texels;
    match texels {
        Texels::Rgba8(texels) => {
            buffer.extend(texels.iter().map(|&texel| u32::from_le_bytes(texel)));
        }
        Texels::Rgba16(all) => {
            let all = (0..all.len()).flat_map(|index| stored.texel(texels, index));
            buffer.extend(all.map(f32::to_bits));
        }
        Texels::RgbaF32(texels) => {
            for &texel in texels {
                stored.storage.write(texel, buffer);
            }
        }
    }
}

/// The records of an image's levels, then the texels of those but the first; the first words are that of the image and that of
/// the records.
fn pack_levels(
    scene: &SceneDesc,
    stored: StoredImage,
    [image, levels]: [u32; 2],
    buffer: &mut Vec<u32>,
) {
    let desc = &scene.images[stored.image];
    let sizes = image_levels::sizes(size(desc));
    let mut next = levels + sizes.len() as u32 * <ImageParam as BufferRecord>::WORDS;
    for (level, &size) in sizes.iter().enumerate() {
        let [width, height] = size;
        let record = ImageParam {
            first: if level == 0 { image } else { next },
            width,
            height,
            levels,
        };
        record.append_to(buffer);
        if level > 0 {
            next += (count(size) * stored.storage.words()) as u32;
        }
    }
    let texel = |index| stored.texel(&desc.texels, index);
    for texel in image_levels::texels(size(desc), texel)
        .into_iter()
        .flatten()
    {
        stored.storage.write(texel, buffer);
    }
}
