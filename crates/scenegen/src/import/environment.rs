//! The environment image that the user gave.

use residual_render::texture::srgb_table;

use super::error::{Fault, ImportError};
use super::options::EnvironmentOptions;
use super::warnings::Warnings;
use super::{files, images};
use crate::desc::{EnvironmentDesc, SceneDesc, Texels};
use crate::sixteen_bits;

const ADVICE: &str = "give a latitude-longitude image as .hdr, .exr or .png";

/// Reads the image and appends it to the scene.
pub(super) fn append(
    scene: &mut SceneDesc,
    options: &EnvironmentOptions,
    warnings: &mut Warnings,
) -> Result<(), ImportError> {
    let file = &options.path;
    let fault = |problem: String| {
        Fault::new("environment", problem)
            .advise(ADVICE)
            .in_file(file)
    };
    if !(options.strength.is_finite() && options.strength >= 0.0) {
        return Err(fault(format!(
            "the strength {} is not a number of at least 0",
            options.strength
        )));
    }
    if !options.rotation_degrees.is_finite() {
        return Err(fault("the rotation is not a finite number".into()));
    }
    let bytes = files::read(file).map_err(|message| ImportError::Io {
        file: file.clone(),
        message,
    })?;
    let extension = file.extension().and_then(|extension| extension.to_str());
    let mut decoded = images::decode_one(&bytes, extension)
        .map_err(|problem| fault(format!("the image {problem}")))?;
    let place = format!("environment \"{}\"", file.display());
    decoded.warn(&place, warnings);
    decoded.texels = Texels::RgbaF32(match decoded.texels {
        Texels::Rgba8(texels) => from_srgb(texels),
        Texels::Rgba16(texels) => {
            let texels = texels.into_iter();
            texels.map(sixteen_bits::decoded_texel).collect()
        }
        Texels::RgbaF32(texels) => texels,
    });
    let name = file
        .file_name()
        .unwrap_or(file.as_os_str())
        .to_string_lossy()
        .into_owned();
    scene.images.push(decoded.into_desc(name));
    scene.environment = Some(EnvironmentDesc {
        image: scene.images.len() - 1,
        strength: options.strength,
        rotation: options.rotation_degrees.to_radians(),
    });
    Ok(())
}

fn from_srgb(texels: Vec<[u8; 4]>) -> Vec<[f32; 4]> {
    let table = srgb_table();
    let linear = |code: u8| table[usize::from(code)];
    let texel = |[r, g, b, a]: [u8; 4]| [linear(r), linear(g), linear(b), f32::from(a) / 255.0];
    texels.into_iter().map(texel).collect()
}
