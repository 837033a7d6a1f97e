//! The images of a scene, decoded in parallel and within one budget.

use std::borrow::Cow;

use rayon::prelude::*;

use super::decode::{decode, inspect};
use super::scalar_map::{ScalarMap, ScalarSource};
use crate::desc::{ImageDesc, Texels};
use crate::import::budget::Budget;
use crate::import::warnings::Warnings;

/// An image to decode.
pub(in crate::import) struct ImageRequest<'a> {
    /// For messages and the scene.
    pub(in crate::import) name: String,
    /// JSON path or line of the reference.
    pub(in crate::import) place: String,
    /// The encoded bytes, or why there are none.
    pub(in crate::import) bytes: Result<Cow<'a, [u8]>, String>,
    /// File extension, for formats that cannot be told from their content (TGA).
    pub(in crate::import) extension: Option<String>,
    /// What its texels stand for.
    pub(in crate::import) role: ImageRole,
}

/// What the texels of an image stand for, and so what takes their place where they cannot be read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::import) enum ImageRole {
    /// Factors on a material's inputs.
    Factors,
    /// Normals in tangent space.
    Normals,
    /// Glossiness in the alpha channel, of which roughness is made: 1 − factor · alpha, in all colours.
    Glossiness {
        /// In [0, 1].
        factor: f32,
    },
    /// Numbers that no channel holds as they are, in all colours.
    Scalars(ScalarMap),
}

/// An image of its own that is made of a file's, which may be read in several ways.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::import) enum Derived {
    /// The file's.
    No,
    /// Roughness made with a factor of these bits.
    Roughness(u32),
    /// Numbers of a source, with a base and a gain of these bits.
    Scalars(ScalarSource, [u32; 2]),
}

impl ImageRole {
    /// Which image of the scene it is.
    pub(in crate::import) fn derived(self) -> Derived {
        match self {
            Self::Factors | Self::Normals => Derived::No,
            Self::Glossiness { factor } => Derived::Roughness(factor.to_bits()),
            Self::Scalars(map) => {
                Derived::Scalars(map.source, [map.base, map.gain].map(f32::to_bits))
            }
        }
    }

    /// Makes of decoded texels what the scene reads.
    fn derive(self, texels: Texels) -> Texels {
        let factor = match self {
            Self::Factors | Self::Normals => return texels,
            Self::Scalars(map) => return map.derive(texels),
            Self::Glossiness { factor } => factor,
        };
        let roughness = |glossiness: f32| (1.0 - factor * glossiness).clamp(0.0, 1.0);
        match texels {
            Texels::Rgba8(texels) => {
                let code = |alpha: u8| (255.0 * roughness(f32::from(alpha) / 255.0)).round() as u8;
                let codes: [u8; 256] = std::array::from_fn(|alpha| code(alpha as u8));
                let texel = |[.., alpha]: [u8; 4]| {
                    let code = codes[usize::from(alpha)];
                    [code, code, code, 255]
                };
                Texels::Rgba8(texels.into_iter().map(texel).collect())
            }
            Texels::Rgba16(texels) => {
                let texel = |[.., alpha]: [u16; 4]| {
                    let value = roughness(f32::from(alpha) / 65535.0);
                    let code = (65535.0 * value).round() as u16;
                    [code, code, code, u16::MAX]
                };
                Texels::Rgba16(texels.into_iter().map(texel).collect())
            }
            Texels::RgbaF32(texels) => {
                let texel = |[.., alpha]: [f32; 4]| {
                    let value = roughness(alpha);
                    [value, value, value, 1.0]
                };
                Texels::RgbaF32(texels.into_iter().map(texel).collect())
            }
        }
    }

    /// The texel that changes nothing.
    fn neutral_texel(self) -> [u8; 4] {
        match self {
            Self::Glossiness { factor } => {
                let code = (255.0 * (1.0 - factor)).round() as u8;
                [code, code, code, 255]
            }
            Self::Factors | Self::Scalars(_) => [255; 4],
            Self::Normals => [128, 128, 255, 255],
        }
    }

    /// How messages call that texel.
    fn neutral_name(self) -> &'static str {
        match self {
            Self::Factors | Self::Glossiness { .. } | Self::Scalars(_) => "white",
            Self::Normals => "no normal map",
        }
    }
}

/// Decodes all; one that fails becomes a texel that changes nothing, and a warning.
pub(in crate::import) fn decode_all(
    requests: Vec<ImageRequest<'_>>,
    warnings: &mut Warnings,
) -> Vec<ImageDesc> {
    let encoded = requests
        .iter()
        .filter_map(|request| request.bytes.as_ref().ok());
    let mut budget = Budget::images(encoded.map(|bytes| bytes.len() as u64).sum());
    let checked: Vec<_> = requests
        .into_iter()
        .map(|request| {
            let encoding = match &request.bytes {
                Ok(bytes) => inspect(bytes, request.extension.as_deref(), &mut budget),
                Err(problem) => Err(problem.clone()),
            };
            (request, encoding)
        })
        .collect();
    let decoded: Vec<_> = checked
        .into_par_iter()
        .map(|(request, encoding)| {
            let result = match (&request.bytes, encoding) {
                (Ok(bytes), Ok(encoding)) => decode(bytes, encoding),
                (_, Err(problem)) => Err(problem),
                (Err(problem), _) => Err(problem.clone()),
            };
            (request.name, request.place, request.role, result)
        })
        .collect();

    decoded
        .into_iter()
        .map(|(name, place, role, result)| match result {
            Ok(decoded) => {
                decoded.warn(&place, warnings);
                let image = decoded.into_desc(name);
                ImageDesc {
                    texels: role.derive(image.texels),
                    ..image
                }
            }
            Err(problem) => {
                let neutral = role.neutral_name();
                warnings.push(place, format!("image {problem}; {neutral} is used"));
                ImageDesc {
                    name,
                    width: 1,
                    height: 1,
                    texels: Texels::Rgba8(vec![role.neutral_texel()]),
                }
            }
        })
        .collect()
}
