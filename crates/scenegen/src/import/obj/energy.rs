//! Surfaces that reflect no more than arrives: MTL adds a diffuse and a specular colour, which together may be anything.

use residual_render::texture::srgb_decoded;

use crate::desc::{ColorInput, ImageDesc, MaterialDesc, SurfaceDesc, Texels, TextureDesc};
use crate::import::warnings::Warnings;
use crate::sixteen_bits;

/// More than this is more than rounding of what adds up to 1.
const LARGEST_SUM: f32 = 1.0 + 1e-5;

/// Divides the colours of surfaces whose sum is above 1 somewhere by the largest sum that there can be. `places` are
/// those of the materials.
pub(super) fn conserve(
    materials: &mut [MaterialDesc],
    places: &[String],
    textures: &[TextureDesc],
    images: &[ImageDesc],
    warnings: &mut Warnings,
) {
    let brightest: Vec<[f32; 3]> = images.iter().map(brightest).collect();
    for (material, place) in materials.iter_mut().zip(places) {
        let (name, colors): (&str, Vec<&mut ColorInput>) = match &mut material.surface {
            SurfaceDesc::Phong(surface) => (
                "Kd and Ks",
                vec![&mut surface.diffuse, &mut surface.specular],
            ),
            SurfaceDesc::Mirror {
                diffuse,
                reflectance,
            } => ("Kd and Ks", vec![diffuse, reflectance]),
            SurfaceDesc::MetallicRoughness(surface) => ("Kd", vec![&mut surface.base_color]),
            SurfaceDesc::Dielectric { .. }
            | SurfaceDesc::Checkerboard { .. }
            | SurfaceDesc::Unlit => continue,
        };
        let bound = |color: &ColorInput, channel: usize| {
            let texture = color.texture.as_ref();
            let texel =
                texture.map_or(1.0, |used| brightest[textures[used.texture].image][channel]);
            color.factor[channel] * texel
        };
        let sum = |channel| {
            colors
                .iter()
                .map(|color| bound(color, channel))
                .sum::<f32>()
        };
        let largest = [0, 1, 2].map(sum).into_iter().fold(0.0, f32::max);
        if largest > LARGEST_SUM {
            let shown = (100.0 * largest).round() / 100.0;
            let message = format!("{name} reflect {shown} times what arrives; divided by that");
            warnings.push(place, message);
            for color in colors {
                color.factor = color.factor.map(|value| value / largest);
            }
        }
    }
}

/// The largest value of each channel of an image of colours, linear.
fn brightest(image: &ImageDesc) -> [f32; 3] {
    match &image.texels {
        Texels::Rgba8(texels) => [0, 1, 2].map(|channel| {
            let code = texels.iter().map(|texel| texel[channel]).max().unwrap_or(0);
            srgb_decoded(f64::from(code) / 255.0) as f32
        }),
        Texels::Rgba16(texels) => [0, 1, 2].map(|channel| {
            let code = texels.iter().map(|texel| texel[channel]).max().unwrap_or(0);
            sixteen_bits::decoded(code)
        }),
        Texels::RgbaF32(texels) => [0, 1, 2].map(|channel| {
            let values = texels.iter().map(|texel| texel[channel]);
            values.fold(0.0, f32::max)
        }),
    }
}
