//! What light paths bring to an image, which is not known tile by tile.

use super::{Pass, TileRect};

/// Radiance for every sample of every pixel of a pass.
///
/// Sums are kept in `f64`, of which `f32` keeps half of the digits: so they do not depend on the order in which devices find what
/// they add up, unless numbers meet of which one is 2²⁹ times the other.
#[derive(Clone, Debug)]
pub struct Splats {
    width: usize,
    pixels: usize,
    /// `values[sample][row][column]`.
    values: Vec<[f64; 3]>,
}

/// About as many light paths have their splats in memory at a time.
const LIGHT_PATHS: u64 = 1 << 20;

impl Splats {
    /// Nothing yet for an image of this size, with so many samples a pixel.
    pub fn new([width, height]: [u32; 2], samples: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width: width as usize,
            pixels,
            values: vec![[0.0; 3]; pixels * samples as usize],
        }
    }

    /// A pass over an image of this size in parts, whose splats are kept one after the other.
    pub fn parts(pass: Pass, size: [u32; 2]) -> impl Iterator<Item = Pass> {
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        let most = (LIGHT_PATHS / pixels.max(1)).max(1) as u32;
        (0..pass.count)
            .step_by(most as usize)
            .map(move |done| Pass {
                first: pass.first + done,
                count: most.min(pass.count - done),
            })
    }

    /// Adds a list of red, green, blue and the bits of an index in `[sample][row][column]`.
    pub fn add(&mut self, list: &[f32]) {
        let (rows, _) = list.as_chunks();
        for &[r, g, b, index] in rows {
            let sum = &mut self.values[index.to_bits() as usize];
            for (sum, value) in sum.iter_mut().zip([r, g, b]) {
                *sum += f64::from(value);
            }
        }
    }

    /// Adds what falls into a tile to samples of its pixels, from the `first`th of the pass on: `[sample][row][column][channel]`, of
    /// `stride` channels, the first three of which are radiance.
    pub fn add_to(&self, rect: TileRect, first: usize, stride: usize, samples: &mut [f32]) {
        let (width, height) = (rect.width as usize, rect.height as usize);
        let rows = samples.chunks_exact_mut(width * stride);
        for (at, row) in rows.enumerate() {
            let (sample, y) = (first + at / height, at % height + rect.y as usize);
            let start = sample * self.pixels + y * self.width + rect.x as usize;
            let values = &self.values[start..start + width];
            for (sample, value) in row.chunks_exact_mut(stride).zip(values) {
                for (sum, &value) in sample.iter_mut().zip(value) {
                    *sum += value as f32;
                }
            }
        }
    }
}
