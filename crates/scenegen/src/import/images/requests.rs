//! The images of a scene, decoded in parallel and within one budget.

use std::borrow::Cow;

use rayon::prelude::*;

use super::decode::{decode, inspect};
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::import) enum ImageRole {
    /// Factors on a material's inputs.
    Factors,
    /// Normals in tangent space.
    Normals,
}

impl ImageRole {
    /// The texel that changes nothing.
    fn neutral_texel(self) -> [u8; 4] {
        match self {
            Self::Factors => [255; 4],
            Self::Normals => [128, 128, 255, 255],
        }
    }

    /// How messages call that texel.
    fn neutral_name(self) -> &'static str {
        match self {
            Self::Factors => "white",
            Self::Normals => "no normal map",
        }
    }
}

/// Decodes all; one that fails becomes a texel that changes nothing, and a warning.
pub(in crate::import) fn decode_all(
    requests: Vec<ImageRequest<'_>>,
    warnings: &mut Warnings,
) -> Vec<ImageDesc> {
    let mut budget = Budget::images();
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
                decoded.into_desc(name)
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
