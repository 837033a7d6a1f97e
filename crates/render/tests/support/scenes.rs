//! Scene data made by hand, after the layouts that `domain::Buffer`, `light` and `light::environment` document.

use residual_render::domain::{Buffer, Domain};
use residual_render::light::{ALIAS_ENTRY, ALIAS_HEADER, RECORD, environment};
use residual_render::math::vec3::vec3;
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, Hit, Surface};
use residual_render::triangle::TriangleRecord;

use super::alias::alias_table;

/// A triangle.
pub(crate) type Triangle = [[f32; 3]; 3];

/// A triangle in the plane z = 0 around the origin, its front up.
pub(crate) const FLOOR: Triangle = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 2.0, 0.0]];

fn reals<'a>(values: impl IntoIterator<Item = &'a f32>) -> Vec<u32> {
    values.into_iter().map(|value| value.to_bits()).collect()
}

/// Triangles with programs and parameters 0.
pub(crate) fn scene(triangles: &[Triangle]) -> SceneData {
    let mut data = SceneData::default();
    for &triangle in triangles {
        data.push_triangle(TriangleRecord::new(triangle), 0);
    }
    data
}

/// Rows of an alias table with the densities of slots and aliases.
fn alias_rows(weights: &[f64], density: impl Fn(f64) -> f64) -> Vec<u32> {
    let density = |k: usize| (density(weights[k]) as f32).to_bits();
    let row = |(k, (threshold, other)): (usize, (f32, u32))| {
        let [of_slot, of_alias] = [density(k), density(other as usize)];
        [threshold.to_bits(), other, of_slot, of_alias]
    };
    let table = alias_table(weights).into_iter().enumerate();
    table.flat_map(row).collect()
}

/// Lights: their records without padding, with the weights by which they are picked.
pub(crate) fn set_lights(data: &mut SceneData, records: &[Vec<u32>], weights: &[f64]) {
    assert_eq!(records.len(), weights.len());
    let lights = data.buffer_mut(Buffer::Lights);
    lights.clear();
    for record in records {
        lights.extend_from_slice(record);
        lights.resize(lights.len().next_multiple_of(RECORD as usize), 0);
    }
    let total: f64 = weights.iter().sum();
    let alias = data.buffer_mut(Buffer::LightAlias);
    *alias = vec![records.len() as u32, 0, 0, 0];
    assert_eq!(alias.len(), ALIAS_HEADER as usize);
    alias.extend(alias_rows(weights, |weight| weight / total));
    assert_eq!(
        alias.len(),
        ALIAS_HEADER as usize + records.len() * ALIAS_ENTRY as usize
    );
}

/// An environment image of `width` columns, rotated about +Y, as light number 0 among the texels from word 0.
pub(crate) fn set_environment(
    data: &mut SceneData,
    width: usize,
    texels: &[[f32; 3]],
    rotation: f64,
) {
    let height = texels.len() / width;
    let words = texels
        .iter()
        .flat_map(|[r, g, b]| reals(&[*r, *g, *b, 1.0]));
    *data.buffer_mut(Buffer::Texels) = words.collect();
    // The integral over each texel of the bilinear luminance: tent weights 1/8, 6/8, 1/8 along each axis.
    let luminance = |x: i64, y: i64| {
        let x = x.rem_euclid(width as i64) as usize;
        let [r, g, b] = texels[y.clamp(0, height as i64 - 1) as usize * width + x].map(f64::from);
        0.2126 * r + 0.7152 * g + 0.0722 * b
    };
    let tent = [0.125, 0.75, 0.125];
    let mut weights = Vec::new();
    for y in 0..height as i64 {
        let sine = (std::f64::consts::PI * (y as f64 + 0.5) / height as f64).sin();
        for x in 0..width as i64 {
            let around = (0..9).map(|k| {
                let (i, j) = (k % 3, k / 3);
                tent[i] * tent[j] * luminance(x + i as i64 - 1, y + j as i64 - 1)
            });
            weights.push(around.sum::<f64>() * sine);
        }
    }
    let total: f64 = weights.iter().sum();
    let mut words = vec![width as u32, height as u32, 0, 1.0_f32.to_bits()];
    words.extend(reals(&[rotation.cos() as f32, rotation.sin() as f32]));
    words.extend([0, 0]);
    assert_eq!(words.len(), environment::HEADER as usize);
    words.extend(alias_rows(&weights, |weight| {
        weight / total * weights.len() as f64
    }));
    *data.buffer_mut(Buffer::Environment) = words;
    set_lights(data, &[vec![0]], &[1.0]);
}

/// Parameters of the one block that all triangles use.
pub(crate) fn set_params(data: &mut SceneData, values: &[f32]) {
    *data.buffer_mut(Buffer::Params) = reals(values);
}

/// The point of triangle `prim` at barycentric (u, v), seen along `dir`.
pub(crate) fn surface_at<D: Domain>(
    d: D,
    prim: u32,
    [u, v]: [f64; 2],
    dir: [f64; 3],
) -> Surface<D> {
    let [x, y, z] = dir.map(|c| d.lit(c));
    let hit = Hit {
        u: d.lit(u),
        v: d.lit(v),
        prim: d.uint(prim),
    };
    Surface::new(d, Attributes::default(), &hit, vec3(x, y, z))
}

/// The middle of triangle 0, seen from straight above its front.
pub(crate) fn floor<D: Domain>(d: D) -> Surface<D> {
    surface_at(d, 0, [1.0 / 3.0, 1.0 / 3.0], [0.0, 0.0, -1.0])
}
