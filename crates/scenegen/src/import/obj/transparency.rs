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
        /// What it is multiplied by on its way.
        tint: [f32; 3],
    },
}

/// `illum` 4, 6, 7 and 9 ask for glass, and so does a `Tf` that is a colour. What exporters write for every material
/// does not: `illum` 4 or `Ni` alone, a `Tf` of black or white, and `d` below 1. Maps of colour and opacity belong to
/// surfaces, whatever else is written.
pub(super) fn read(inputs: &mut Inputs<'_, '_>, illumination: Illumination) -> Transparency {
    let opacity = opacity(inputs);
    let is_said_opaque = opacity == Some(1.0);
    let opacity = opacity.unwrap_or(1.0);
    let tint = inputs.statements.color("tf");
    let tint = tint.map(|tint| inputs.at_most_1("Tf", tint));
    let tint = tint.filter(|&tint| tint != [0.0; 3] && tint != [1.0; 3]);
    let refracts = inputs.statements.number("ni").is_some_and(|ior| ior > 1.0);
    let asks_for_glass = match illumination {
        Illumination::Glass => opacity < 1.0 || tint.is_some() || (refracts && !is_said_opaque),
        Illumination::Refraction => true,
        _ => tint.is_some() && !is_said_opaque,
    };
    let has_map = ["map_kd", "map_d"]
        .into_iter()
        .find(|key| inputs.statements.has(key));
    match has_map {
        Some(map) if asks_for_glass => {
            let message =
                format!("{map} is for surfaces: the material dissolves by d and is no glass");
            inputs.statements.warn(message);
        }
        None if asks_for_glass => {
            let tint = glass_tint(inputs, tint.unwrap_or([1.0; 3]), opacity);
            return Transparency::Glass { tint };
        }
        _ if tint.is_some() => inputs
            .statements
            .warn("Tf is ignored, as d says that the material is opaque"),
        _ => {}
    }
    Transparency::Dissolve { opacity }
}

/// The colour of glass: `Tf`, and `Kd` as far as `d` makes it opaque.
fn glass_tint(inputs: &mut Inputs<'_, '_>, tint: [f32; 3], opacity: f32) -> [f32; 3] {
    let Some(diffuse) = inputs
        .statements
        .color("kd")
        .filter(|&diffuse| diffuse != [0.0; 3])
    else {
        return tint;
    };
    if opacity <= 0.0 || opacity >= 1.0 {
        inputs
            .statements
            .warn("kd is ignored: the material is clear glass");
        return tint;
    }
    let diffuse = inputs.at_most_1("kd", diffuse);
    std::array::from_fn(|channel| tint[channel] * (1.0 - opacity + opacity * diffuse[channel]))
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
    // Nobody writes maps for what cannot be seen: 3ds Max and others write 0 where a map says how opaque a surface is, and
    // scanning programs where a texture does.
    let maps = &mut inputs.statements;
    let meaning = match opacity {
        0.0 if maps.has("map_d") => {
            "map_d would have no effect, as d is 0: the map alone says what is opaque"
        }
        0.0 if maps.has("map_kd") => {
            "a material with a texture that nobody could see can only mean that it is opaque"
        }
        _ => return Some(opacity),
    };
    maps.warn(meaning);
    Some(1.0)
}
