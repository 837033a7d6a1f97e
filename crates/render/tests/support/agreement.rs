//! Formulas in every `f32` domain, side by side.

use fearless_simd::{Level, dispatch};
use residual_render::domain::{Buffer, Domain, Lanes, Lanes4, Lanes8, Lanes16, Scalar};
use residual_render::math::Vec3;
use residual_render::scene_data::SceneData;
use residual_render::texture::srgb_table;

use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, scene};

/// A formula over columns of words; its results, as words.
pub(crate) trait Formula {
    fn run<D: Lanes>(&self, d: D, x: &[D::U]) -> Vec<D::U>;
}

/// Rows in each column; a multiple of every lane count.
pub(crate) const ROWS: usize = 2048;

/// A scene whose texels are 256 numbers.
pub(crate) fn numbers() -> SceneData {
    let mut data = scene(&[FLOOR]);
    *data.buffer_mut(Buffer::Texels) = srgb_table().map(f32::to_bits).to_vec();
    data
}

pub(crate) fn evaluate<D: Lanes>(
    d: D,
    formula: &impl Formula,
    columns: &[Vec<u32>],
) -> Vec<Vec<u32>> {
    let mut results: Vec<Vec<u32>> = Vec::new();
    for first in (0..ROWS).step_by(D::LANES) {
        let x: Vec<_> = columns
            .iter()
            .map(|column| d.word(&column[first..first + D::LANES]))
            .collect();
        for (k, result) in formula.run(d, &x).into_iter().enumerate() {
            if results.len() <= k {
                results.push(vec![0; ROWS]);
            }
            d.store_word(result, &mut results[k][first..first + D::LANES]);
        }
    }
    results
}

/// Evaluates the formula in all domains and compares.
#[track_caller]
pub(crate) fn check(name: &str, data: &SceneData, formula: &impl Formula, columns: &[Vec<u32>]) {
    let buffers = data.buffers();
    // One NaN is like another: IEEE 754 leaves their payloads open.
    let same =
        |a: u32, b: u32| a == b || (f32::from_bits(a).is_nan() && f32::from_bits(b).is_nan());
    let expected = evaluate(Scalar::new(&buffers), formula, columns);
    let compare = |lanes: usize, results: Vec<Vec<u32>>| {
        for (k, (result, expected)) in results.iter().zip(&expected).enumerate() {
            for row in 0..ROWS {
                let input: Vec<_> = columns
                    .iter()
                    .map(|c| (c[row], f32::from_bits(c[row])))
                    .collect();
                let (a, b) = (expected[row], result[row]);
                assert!(
                    same(a, b),
                    "{name}, result {k}, {lanes} lanes: {a:#x} {b:#x} for {input:x?}"
                );
            }
        }
    };
    dispatch!(Level::new(), simd => {
        compare(4, evaluate(Lanes4::new(simd, &buffers), formula, columns));
        compare(8, evaluate(Lanes8::new(simd, &buffers), formula, columns));
        compare(16, evaluate(Lanes16::new(simd, &buffers), formula, columns));
    });
}

pub(crate) fn words<D: Domain>(d: D, values: impl IntoIterator<Item = D::F>) -> Vec<D::U> {
    values.into_iter().map(|value| d.to_bits(value)).collect()
}

pub(crate) fn vector<F>(v: Vec3<F>) -> [F; 3] {
    [v.x, v.y, v.z]
}

pub(crate) fn truth<D: Domain>(d: D, mask: D::M) -> D::F {
    d.select(mask, d.lit(1.0), d.lit(0.0))
}

const SPECIAL: [f32; 16] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    -0.5,
    f32::MAX,
    f32::MIN,
    f32::MIN_POSITIVE,
    1e-45,
    -1e-45,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    16_777_216.0,
    8_388_607.5,
];

/// Columns of bits: special values against one another, then anything.
pub(crate) fn any_bits(count: usize, seed: u64) -> Vec<Vec<u32>> {
    let mut rng = Rng::new(seed);
    let special = |row: usize, k: usize| SPECIAL[(row >> (4 * (k % 2))) & 15].to_bits();
    (0..count)
        .map(|k| {
            (0..ROWS)
                .map(|row| {
                    if row < 256 {
                        special(row, k)
                    } else {
                        rng.bits()
                    }
                })
                .collect()
        })
        .collect()
}

/// Columns of numbers made row by row.
pub(crate) fn reals<const N: usize>(
    seed: u64,
    mut row: impl FnMut(&mut Rng) -> [f32; N],
) -> Vec<Vec<u32>> {
    let mut rng = Rng::new(seed);
    let mut columns = vec![Vec::with_capacity(ROWS); N];
    for _ in 0..ROWS {
        for (column, value) in columns.iter_mut().zip(row(&mut rng)) {
            column.push(value.to_bits());
        }
    }
    columns
}
