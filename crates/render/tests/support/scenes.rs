//! Scene data made by hand.

use residual_render::alias_table::AliasEntry;
use residual_render::domain::{Buffer, Domain};
use residual_render::light::{self, EnvironmentHeader, LightRecord};
use residual_render::math::vec3::vec3;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;
use residual_render::surface::{Attributes, Surface, SurfaceHit};
use residual_render::triangle::TriangleRecord;

use super::alias::alias_table;

/// A triangle.
pub(crate) type Triangle = [[f32; 3]; 3];

/// A triangle in the plane z = 0 around the origin, its front up.
pub(crate) const FLOOR: Triangle = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 2.0, 0.0]];

/// Triangles with programs and parameters 0.
pub(crate) fn scene(triangles: &[Triangle]) -> SceneData {
    let mut data = SceneData::default();
    for &triangle in triangles {
        data.push(TriangleRecord::new(triangle));
    }
    data
}

/// Entries of an alias table with the densities of slots and aliases.
fn alias_entries(
    weights: &[f64],
    density: impl Fn(f64) -> f64,
) -> impl ExactSizeIterator<Item = AliasEntry> {
    let density = move |k: usize| density(weights[k]) as f32;
    let entry = move |(k, (threshold, alias)): (usize, (f32, u32))| AliasEntry {
        threshold,
        alias,
        density: density(k),
        alias_density: density(alias as usize),
    };
    alias_table(weights).into_iter().enumerate().map(entry)
}

/// Lights, with the weights by which they are picked.
pub(crate) fn set_lights<R: BufferRecord>(data: &mut SceneData, records: &[R], weights: &[f64]) {
    assert_eq!(records.len(), weights.len());
    data.buffer_mut(Buffer::Lights).clear();
    for &record in records {
        light::push_light(data, record);
    }
    let total: f64 = weights.iter().sum();
    light::set_picks(data, alias_entries(weights, |weight| weight / total));
}

/// An environment image of `width` columns, rotated about +Y, as light 0 among the texels from word 0.
pub(crate) fn set_environment(
    data: &mut SceneData,
    width: usize,
    texels: &[[f32; 3]],
    rotation: f64,
) {
    let height = texels.len() / width;
    let words = texels.iter().flat_map(|&[r, g, b]| [r, g, b, 1.0]);
    *data.buffer_mut(Buffer::Texels) = words.map(f32::to_bits).collect();
    let weights = texel_weights(width, texels);
    let total: f64 = weights.iter().sum();
    let header = EnvironmentHeader {
        width: width as u32,
        height: height as u32,
        first_texel: 0,
        strength: 1.0,
        cos: rotation.cos() as f32,
        sin: rotation.sin() as f32,
        light: 0,
    };
    let mean = total / weights.len() as f64;
    let entries = alias_entries(&weights, |weight| weight / mean);
    light::set_environment(data, header, entries);
    set_lights(data, &[LightRecord { kind: 0 }], &[1.0]);
}

/// The integral of the bilinear luminance over each texel of an environment image, times the sine of its row's angle.
pub(crate) fn texel_weights(width: usize, texels: &[[f32; 3]]) -> Vec<f64> {
    let height = texels.len() / width;
    // Tent weights 1/8, 6/8, 1/8 along each axis.
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
    weights
}

/// The one parameter block, which all triangles use: a record.
pub(crate) fn set_params(data: &mut SceneData, record: impl BufferRecord) {
    let params = data.buffer_mut(Buffer::Params);
    params.clear();
    record.append_to(params);
}

/// The point of triangle `prim` at barycentric (u, v), seen along `dir`.
pub(crate) fn surface_at<D: Domain>(
    d: D,
    prim: u32,
    [u, v]: [f64; 2],
    dir: [f64; 3],
) -> Surface<D> {
    let [x, y, z] = dir.map(|c| d.lit(c));
    let hit = SurfaceHit {
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
