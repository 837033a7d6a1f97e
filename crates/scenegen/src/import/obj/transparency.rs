//! How light gets through a material: what `illum`, `d`, `Tr`, `Tf` and `Ni` mean together, as exporters write them.

use super::illumination::Illumination;
use super::inputs::Inputs;
use super::mtl::TrMeaning;

/// How light gets through.
pub(super) enum Transparency {
    /// It does where the surface is not, as `d` and `map_d` say: a dissolve, which bends nothing.
    Dissolve {
        /// `d`.
        opacity: f32,
    },
    /// All that is not reflected is refracted.
    Glass {
        /// `Tf`.
        tint: [f32; 3],
    },
    /// A part of it is refracted; the rest of the surface is as if opaque.
    PartlyGlass {
        /// 1 − `d`.
        transmission: f32,
    },
}

/// `illum` 4, 6, 7 and 9 ask for glass, and so does a `Tf` that is a colour. What exporters write for every material
/// does not: `illum` 4 or `Ni` alone, a `Tf` of black or white, and `d` below 1.
pub(super) fn read(inputs: &mut Inputs<'_, '_>, illumination: Illumination) -> Transparency {
    let opacity = opacity(inputs);
    let tint = inputs
        .statements
        .color("tf")
        .map(|tint| inputs.at_most_1("Tf", tint));
    let is_tinted = tint.is_some_and(|tint| tint != [0.0; 3] && tint != [1.0; 3]);
    let is_said_opaque = opacity == Some(1.0);
    let opacity = opacity.unwrap_or(1.0);
    let has_color_map = inputs.statements.has("map_kd");
    let refracts = inputs.statements.number("ni").is_some_and(|ior| ior > 1.0);
    let is_glass = match illumination {
        Illumination::Glass => {
            opacity < 1.0 || is_tinted || (refracts && !is_said_opaque && !has_color_map)
        }
        Illumination::Refraction => opacity < 1.0 || is_tinted || !has_color_map,
        _ => is_tinted && !is_said_opaque,
    };
    // A map of opacity cuts leaves out of sheets, whatever else is written.
    if !is_glass || inputs.statements.has("map_d") {
        if is_tinted {
            inputs
                .statements
                .warn("Tf is ignored, as the material is opaque or dissolved by a map");
        }
        return Transparency::Dissolve { opacity };
    }
    let diffuse = inputs.statements.color("kd");
    let is_colored =
        has_color_map || diffuse.is_some_and(|color| color.iter().any(|&value| value > 0.0));
    if !is_tinted && opacity > 0.0 && opacity < 1.0 && is_colored {
        return Transparency::PartlyGlass {
            transmission: 1.0 - opacity,
        };
    }
    let tint = tint.filter(|_| is_tinted).unwrap_or([1.0; 3]);
    Transparency::Glass { tint }
}

/// How much of the surface is there, by `d` and `Tr`, which programs confuse; `None` where neither says.
fn opacity(inputs: &mut Inputs<'_, '_>) -> Option<f32> {
    let (d, tr) = (inputs.fraction("d"), inputs.fraction("tr"));
    let opacity = match (d, tr) {
        (None, None) => return None,
        (Some(d), None) => d,
        (None, Some(tr)) if inputs.statements.tr_meaning() == TrMeaning::Opacity => {
            inputs
                .statements
                .warn("Tr is read as opacity, as 1 stands for what is opaque in this library");
            tr
        }
        (None, Some(tr)) => 1.0 - tr,
        (Some(d), Some(tr)) if (d + tr - 1.0).abs() < 1e-3 => d,
        (Some(0.0), Some(0.0)) => {
            inputs
                .statements
                .warn("d 0 and Tr 0 contradict each other; the material is opaque");
            1.0
        }
        // Then Tr is another word for d.
        (Some(d), Some(tr)) if d == tr => d,
        (Some(1.0), Some(tr)) => {
            inputs
                .statements
                .warn(format!("d 1 and Tr {tr} contradict each other; Tr counts"));
            1.0 - tr
        }
        (Some(d), Some(tr)) => {
            inputs
                .statements
                .warn(format!("d {d} and Tr {tr} contradict each other; d counts"));
            d
        }
    };
    if opacity == 0.0 && inputs.statements.has("map_kd") {
        let message =
            "a material with a texture that nobody could see can only mean that it is opaque";
        inputs.statements.warn(message);
        return Some(1.0);
    }
    Some(opacity)
}
