//! A table of directional albedos over roughness and cosine, for lobes that no short fit describes.

use super::ggx::{Ggx, MIN_ALPHA};
use crate::domain::{Buffer, Domain};

/// Rows, which are evenly spaced in roughness from 0 to 1.
const ROWS: u32 = 32;
/// Columns, which are close where cosines are small and where they are about α: albedos change fast there.
const COLUMNS: u32 = 56;

/// Words of a table.
pub(super) const ALBEDO_TABLE_WORDS: u32 = ROWS * COLUMNS;

/// The table of what `albedo` says of α and the cosine between the normal and where light goes.
#[inline(always)]
pub(super) fn albedo_table(albedo: impl Fn(f64, f64) -> f32) -> Vec<f32> {
    let part = |index: u32, count: u32| f64::from(index) / f64::from(count - 1);
    let mut table = Vec::with_capacity(ALBEDO_TABLE_WORDS as usize);
    for row in 0..ROWS {
        let alpha = part(row, ROWS).powi(2).max(MIN_ALPHA);
        for column in 0..COLUMNS {
            // The inverse of `position_of`.
            let x = part(column, COLUMNS);
            let (near, far) = (x * x * alpha, (1.0 - x) * (1.0 - x) * (1.0 + alpha));
            let cos = near / (near + far);
            // At a cosine of 0 itself nothing is seen.
            table.push(albedo(alpha, cos.max(1e-7)));
        }
    }
    table
}

/// Where a cosine stands among the columns, from 0 to 1.
#[inline(always)]
fn position_of<D: Domain>(d: D, alpha: D::F, cos: D::F) -> D::F {
    let near = d.sqrt(d.fma(cos, alpha, cos));
    let far = d.sqrt((d.lit(1.0) - cos) * alpha);
    near / (near + far)
}

/// What the table that begins at this word of the parameters says of facets that are seen at an angle of this cosine,
/// interpolated.
#[inline(always)]
pub(super) fn tabulated_albedo<D: Domain>(d: D, table: D::U, ggx: &Ggx<D::F>, cos: D::F) -> D::F {
    let (zero, one) = (d.lit(0.0), d.lit(1.0));
    let alpha = ggx.mean_alpha(d);
    let cos = d.min(d.max(cos, zero), one);
    let place = |position: D::F, count: u32| {
        let position = position * d.lit(f64::from(count - 1));
        let index = d.min(d.floor(position), d.lit(f64::from(count - 2)));
        (index, position - index)
    };
    let (row, down) = place(d.min(d.sqrt(alpha), one), ROWS);
    let (column, right) = place(position_of(d, alpha, cos), COLUMNS);
    let first = table + d.to_uint(d.fma(row, d.lit(f64::from(COLUMNS)), column));
    let entry = |offset: u32| d.load_real(Buffer::Params, first + d.uint(offset));
    let between = |a: D::F, b: D::F, at: D::F| d.fma(b - a, at, a);
    let above = between(entry(0), entry(1), right);
    let below = between(entry(COLUMNS), entry(COLUMNS + 1), right);
    between(above, below, down)
}
