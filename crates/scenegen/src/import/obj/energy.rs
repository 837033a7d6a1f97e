//! Surfaces that reflect no more than arrives: MTL adds a diffuse and a specular colour, which together may be anything.
//!
//! Where they are too much, highlights give way, and the diffuse colour stays what other programs show. Exporters write the
//! "specular" of their principled surfaces as `Ks`: Blender's old default is `Kd` 0.8 and `Ks` 0.5, which stands for the
//! reflectance of plastic, 4 %. Blender and three.js show 0.8 of such a file. Dividing both by their sum
//! would show 0.62, and taking what the highlight reflects off the colour underneath, as layers do, would show
//! 0.4. That plastic is not made matte where its colour is white, or a texture's brightest texel is, 4 % stay in any case.

use residual_render::texture::srgb_decoded;

use crate::desc::{
    ColorInput, ImageDesc, MaterialDesc, PhongSurface, SurfaceDesc, Texels, TextureDesc,
};
use crate::import::warnings::Warnings;
use crate::sixteen_bits;

/// More than this is more than rounding of what adds up to 1.
const LARGEST_SUM: f32 = 1.0 + 1e-5;

/// What stays of highlights: the reflectance of plastic and varnish, of index 1.5, seen from above.
const PLASTIC: f32 = 0.04;

/// Makes colours of surfaces whose sum may be above 1 somewhere smaller, until it is 1. `places` are those of the
/// materials.
pub(super) fn conserve(
    materials: &mut [MaterialDesc],
    places: &[String],
    textures: &[TextureDesc],
    images: &[ImageDesc],
    warnings: &mut Warnings,
) {
    let brightest: Vec<[f32; 3]> = images.iter().map(brightest).collect();
    let bound = |color: &ColorInput| -> [f32; 3] {
        let texture = color.texture.as_ref();
        let texels = texture.map_or([1.0; 3], |used| brightest[textures[used.texture].image]);
        [0, 1, 2].map(|channel| color.factor[channel] * texels[channel])
    };
    for (material, place) in materials.iter_mut().zip(places) {
        let (what, sum, remedy) = match &mut material.surface {
            SurfaceDesc::Phong(surface) => {
                let (diffuse, specular) = (bound(&surface.diffuse), bound(&surface.specular));
                let sum = largest_sum(&[diffuse, specular]);
                let remedy = give_way(surface, diffuse, specular);
                ("Kd and Ks reflect", sum, remedy)
            }
            SurfaceDesc::Mirror {
                diffuse,
                reflectance,
            } => {
                let sum = largest_sum(&[bound(diffuse), bound(reflectance)]);
                divide([diffuse, reflectance], sum);
                ("Kd and Ks reflect", sum, "divided by that".to_owned())
            }
            SurfaceDesc::MetallicRoughness(surface) => {
                let sum = largest_sum(&[bound(&surface.base_color)]);
                divide([&mut surface.base_color], sum);
                ("Kd reflects", sum, "divided by that".to_owned())
            }
            SurfaceDesc::Dielectric { .. }
            | SurfaceDesc::Checkerboard { .. }
            | SurfaceDesc::Unlit => continue,
        };
        if sum > LARGEST_SUM {
            let times = rounded(sum);
            warnings.push(
                place,
                format!("{what} {times} times what arrives; {remedy}"),
            );
        }
    }
}

/// Makes a highlight smaller, and both colours where that is not enough, given their largest values. Says what was done.
fn give_way(surface: &mut PhongSurface, diffuse: [f32; 3], specular: [f32; 3]) -> String {
    let share = highlight_share(diffuse, specular);
    surface.specular.factor = surface.specular.factor.map(|value| share * value);
    let rest = largest_sum(&[diffuse, specular.map(|value| share * value)]);
    divide([&mut surface.diffuse, &mut surface.specular], rest);
    let highlight = (share < 1.0).then(|| format!("Ks is multiplied by {}", rounded(share)));
    let both = (rest > LARGEST_SUM).then(|| format!("both are divided by {}", rounded(rest)));
    let done: Vec<String> = highlight.into_iter().chain(both).collect();
    done.join(", ")
}

/// The share of a highlight that the diffuse colour leaves room for in all channels, or that of plastic, if that is more.
fn highlight_share(diffuse: [f32; 3], specular: [f32; 3]) -> f32 {
    let room = |channel: usize| match specular[channel] {
        0.0 => 1.0,
        reflected => (1.0 - diffuse[channel]) / reflected,
    };
    if largest_sum(&[diffuse, specular]) <= LARGEST_SUM {
        return 1.0;
    }
    let room = [0, 1, 2].map(room).into_iter().fold(1.0, f32::min);
    let brightest = specular.into_iter().fold(PLASTIC, f32::max);
    room.max(PLASTIC / brightest)
}

/// The largest sum of colours in any channel.
fn largest_sum(colors: &[[f32; 3]]) -> f32 {
    let sum = |channel: usize| colors.iter().map(|color| color[channel]).sum::<f32>();
    [0, 1, 2].map(sum).into_iter().fold(0.0, f32::max)
}

fn divide<const N: usize>(colors: [&mut ColorInput; N], sum: f32) {
    if sum > LARGEST_SUM {
        for color in colors {
            color.factor = color.factor.map(|value| value / sum);
        }
    }
}

fn rounded(value: f32) -> f32 {
    (100.0 * value).round() / 100.0
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
