//! What light paths bring to an image in one pass.

use residual_render::film::TileSamples;

/// Radiance for every sample of every pixel, added up in an order that depends on no thread.
pub(crate) struct Splats {
    width: usize,
    pixels: usize,
    /// `values[sample][row][column]`.
    values: Vec<[f32; 3]>,
}

impl Splats {
    /// Nothing yet for an image of this size.
    pub(crate) fn new([width, height]: [u32; 2], samples: u32) -> Self {
        let pixels = width as usize * height as usize;
        Self {
            width: width as usize,
            pixels,
            values: vec![[0.0; 3]; pixels * samples as usize],
        }
    }

    /// Adds a list of red, green, blue and the bits of an index, as a renderer of tiles makes it.
    pub(crate) fn add(&mut self, list: &[f32]) {
        let (rows, _) = list.as_chunks();
        for &[r, g, b, index] in rows {
            let sum = &mut self.values[index.to_bits() as usize];
            for (sum, value) in sum.iter_mut().zip([r, g, b]) {
                *sum += value;
            }
        }
    }

    /// Adds what falls into a tile to its samples, of so many numbers each, of which the first three are radiance.
    pub(crate) fn add_to(&self, tile: &TileSamples, stride: usize, samples: &mut [f32]) {
        let rect = tile.rect;
        let (width, height) = (rect.width as usize, rect.height as usize);
        let rows = samples.chunks_exact_mut(width * stride);
        for (at, row) in rows.enumerate() {
            let (sample, y) = (at / height, at % height + rect.y as usize);
            let first = sample * self.pixels + y * self.width + rect.x as usize;
            let values = &self.values[first..first + width];
            for (sample, value) in row.chunks_exact_mut(stride).zip(values) {
                for (sum, value) in sample.iter_mut().zip(value) {
                    *sum += value;
                }
            }
        }
    }
}
