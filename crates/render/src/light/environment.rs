//! An environment: a latitude-longitude image around the scene. Its centre is +X, u grows towards +Z, its top
//! row is +Y.
//!
//! Texels are picked from an alias table by the integral of the bilinear image over each, so that every direction
//! that shines can be sampled; the position within the texel is uniform.

use super::{Background, Emission, EmissionNumbers, LightKind, LightSample};
use crate::alias_table::{AliasEntry, AliasTable, Outcome};
use crate::domain::{Buffer, Domain};
use crate::math::elementary::{atan2, sincos_turns};
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::record::{BufferRecord, record};
use crate::scene_data::SceneData;
use crate::texture::{Bilinear, Clamp, Filtering, LinearFloat, Repeat, TexelFormat, Wrapping};

record! {
    /// What lies before the table over the texels in [`Buffer::Environment`].
    pub struct EnvironmentHeader in Environment {
        row {
            /// Width of the image in texels.
            width: word,
            /// Its height.
            height: word,
            /// Its first word in [`Buffer::Texels`].
            first_texel: word,
            /// What texels are multiplied with to give radiance.
            strength: real,
        }
        row {
            /// Cosine of the rotation about +Y.
            cos: real,
            /// Its sine.
            sin: real,
            /// Index of the light.
            light: word,
        }
    }
}

/// The table over the texels. Its densities are over the unit square of image coordinates.
const TEXELS: AliasTable = AliasTable {
    buffer: Buffer::Environment,
    first: EnvironmentHeader::WORDS,
};

/// The environment. A scene has at most one.
#[derive(Clone, Copy, Debug)]
pub struct Environment;

const PI: f64 = std::f64::consts::PI;

impl<D: Domain> EnvironmentHeader<D> {
    /// Coordinates in the image of a unit direction, and the sine of the angle to +Y.
    #[inline(always)]
    fn image_point(&self, d: D, dir: Vec3<D::F>) -> ([D::F; 2], D::F) {
        let (cos, sin) = (self.cos, self.sin);
        let (x, z) = (dir.x * cos - dir.z * sin, d.fma(dir.x, sin, dir.z * cos));
        let sin_theta = d.sqrt(d.fma(x, x, z * z));
        let u = d.fma(atan2(d, z, x), d.lit(0.5 / PI), d.lit(0.5));
        let v = atan2(d, sin_theta, dir.y) * d.lit(1.0 / PI);
        ([u, v], sin_theta)
    }

    /// The unit direction of image coordinates, and the sine of its angle to +Y.
    #[inline(always)]
    fn direction(&self, d: D, [u, v]: [D::F; 2]) -> (Vec3<D::F>, D::F) {
        let (cos, sin) = (self.cos, self.sin);
        let (sin_phi, cos_phi) = sincos_turns(d, u - d.lit(0.5));
        let (sin_theta, cos_theta) = sincos_turns(d, v * d.lit(0.5));
        let (x, z) = (sin_theta * cos_phi, sin_theta * sin_phi);
        (
            vec3(d.fma(x, cos, z * sin), cos_theta, z * cos - x * sin),
            sin_theta,
        )
    }

    /// Columns and rows of the image.
    #[inline(always)]
    fn size(&self, d: D) -> [D::F; 2] {
        [d.to_real(self.width), d.to_real(self.height)]
    }

    #[inline(always)]
    fn radiance(&self, d: D, [u, v]: [D::F; 2]) -> Color<D::F> {
        let [columns, rows] = self.size(d);
        let texel = |x: D::F, y: D::F| {
            let x = d.to_uint(Repeat.wrap(d, x, columns));
            let y = d.to_uint(Clamp.wrap(d, y, rows));
            let texel = y * self.width + x;
            LinearFloat.color(d, self.first_texel + texel * d.uint(LinearFloat.words()))
        };
        Bilinear
            .filter(d, u * columns, v * rows, texel, |a, b, t| a.lerp(b, t))
            .scale(self.strength)
    }
}

/// A texel's row and column. Above 2²³ texels the rounded quotient may be a row off, and is put right.
#[inline(always)]
fn row_and_column<D: Domain>(d: D, texel: D::U, width: D::U) -> (D::F, D::F) {
    let guess = d.to_uint(d.floor(d.to_real(texel) / d.to_real(width)));
    let one = d.uint(1);
    let guess = d.select_u(d.lt_u(texel, guess * width), guess - one, guess);
    let beyond = !d.lt_u(texel - guess * width, width);
    let row = d.select_u(beyond, guess + one, guess);
    (d.to_real(row), d.to_real(texel - row * width))
}

/// Density per steradian, from the density over the image.
#[inline(always)]
fn solid_angle_pdf<D: Domain>(d: D, over_image: D::F, sin_theta: D::F) -> D::F {
    over_image / d.max(sin_theta * d.lit(2.0 * PI * PI), d.lit(1e-9))
}

impl<D: Domain> LightKind<D> for Environment {
    #[inline(always)]
    fn takes_three(&self) -> bool {
        true
    }

    #[inline(always)]
    fn sample(&self, d: D, _: D::U, _: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D> {
        let header = EnvironmentHeader::uniform(d);
        let [columns, rows] = header.size(d);
        let one = d.lit(1.0);
        let (x, y) = (u[0] * columns, u[1] * rows);
        let (column, row) = (
            d.min(d.floor(x), columns - one),
            d.min(d.floor(y), rows - one),
        );
        let slot = d.to_uint(row) * header.width + d.to_uint(column);
        let Outcome {
            index: texel,
            density,
            ..
        } = TEXELS.resolve(d, slot, u[2]);
        let (row, column) = row_and_column(d, texel, header.width);
        let uv = [
            (column + (x - d.floor(x))) / columns,
            (row + (y - d.floor(y))) / rows,
        ];
        let (wi, sin_theta) = header.direction(d, uv);
        LightSample {
            wi,
            position: wi,
            infinite: d.truth(true),
            radiance: header.radiance(d, uv),
            pdf: solid_angle_pdf(d, density, sin_theta),
            delta: d.truth(false),
            spread: d.lit(0.0),
        }
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let [x, y] = u.place;
        let nowhere = Vec3::splat(d.lit(0.0));
        let sample = self.sample(d, record, nowhere, [x, y, u.third]);
        let weight = sample.radiance.scale(d.lit(1.0) / sample.pdf);
        Emission::from_afar(d, sample.wi, weight, sample.pdf, u.direction)
    }

    #[inline(always)]
    fn background(&self, d: D, dir: Vec3<D::F>) -> Option<Background<D>> {
        let header = EnvironmentHeader::uniform(d);
        let (uv, sin_theta) = header.image_point(d, dir);
        let [columns, rows] = header.size(d);
        let column = d.to_uint(Clamp.wrap(d, d.floor(uv[0] * columns), columns));
        let row = d.to_uint(Clamp.wrap(d, d.floor(uv[1] * rows), rows));
        let density = TEXELS.density(d, row * header.width + column);
        Some(Background {
            radiance: header.radiance(d, uv),
            pdf: solid_angle_pdf(d, density, sin_theta),
            light: header.light,
        })
    }
}

/// Sets the environment, and the table from which its texels are picked: an entry each.
pub fn set_environment(
    data: &mut SceneData,
    header: EnvironmentHeader,
    entries: impl ExactSizeIterator<Item = AliasEntry>,
) {
    let buffer = data.buffer_mut(Buffer::Environment);
    buffer.clear();
    let entry = AliasEntry::WORDS as usize;
    buffer.reserve_exact(EnvironmentHeader::WORDS as usize + entry * entries.len());
    header.append_to(buffer);
    entries.for_each(|entry| entry.append_to(buffer));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{Buffers, Scalar, Uint};

    #[test]
    fn rows_and_columns_are_exact_for_large_images() {
        let d = Scalar::new(&Buffers::EMPTY);
        for (width, height) in [
            (1_u32, 1_u32),
            (3, 5),
            (8190, 4095),
            (10_007, 5_003),
            (16_384, 8_192),
        ] {
            let texels = u64::from(width) * u64::from(height);
            for step in 0..20_000_u64 {
                // Row ends and starts are where rounding decides.
                let row = (step * 7919 % u64::from(height)) as u32;
                for column in [0, width / 2, width - 1] {
                    let texel = row * width + column;
                    assert!(u64::from(texel) < texels);
                    let found = row_and_column(d, Uint(texel), Uint(width));
                    assert_eq!(found, (row as f32, column as f32), "{width}×{height}");
                }
            }
        }
    }
}
