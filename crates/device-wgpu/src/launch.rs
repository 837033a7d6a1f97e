//! What one launch renders: so many paths at once, of neighbouring pixels, sample after sample.

use bytemuck::{Pod, Zeroable};
use residual_render::tracer::TracerOptions;

/// Pixels along the side of a block; kernels number pixels block by block.
const BLOCK: u32 = 8;

/// The kernels' `Settings`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
pub(crate) struct Settings {
    width: f32,
    height: f32,
    columns: u32,
    places: u32,
    first_sample: u32,
    first: u32,
    pub(crate) count: u32,
    slots: u32,
    seed: u32,
    pub(crate) max_depth: u32,
    roulette_from: u32,
    reach: f32,
    first_packet: u32,
    _unused: [u32; 3],
}

impl Settings {
    /// These samples: some of the places of those from `first_sample` on.
    pub(crate) fn of(self, first_sample: u32, first: u32, count: u32) -> Self {
        Self {
            first_sample,
            first,
            count,
            ..self
        }
    }
}

/// The pixels of an image in the order in which kernels number them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Places {
    size: [u32; 2],
    columns: u32,
}

impl Places {
    pub(crate) fn new(size: [u32; 2]) -> Self {
        Self {
            size,
            columns: size[0].div_ceil(BLOCK),
        }
    }

    /// Pixels in all blocks; some lie outside of the image.
    pub(crate) fn count(self) -> u32 {
        self.columns * self.size[1].div_ceil(BLOCK) * BLOCK * BLOCK
    }

    /// The number of a pixel.
    pub(crate) fn of(self, x: u32, y: u32) -> u32 {
        let block = y / BLOCK * self.columns + x / BLOCK;
        block * BLOCK * BLOCK + y % BLOCK * BLOCK + x % BLOCK
    }

    /// What kernels of light paths are told, of which there are as many as pixels, row by row.
    pub(crate) fn settings_of_lights(
        self,
        options: &TracerOptions,
        slots: u32,
        first_packet: u32,
    ) -> Settings {
        let [width, height] = self.size;
        Settings {
            columns: width,
            places: width * height,
            ..self.settings(options, slots, first_packet)
        }
    }

    /// What kernels are told.
    pub(crate) fn settings(
        self,
        options: &TracerOptions,
        slots: u32,
        first_packet: u32,
    ) -> Settings {
        let [width, height] = self.size.map(|pixels| pixels as f32);
        Settings {
            width,
            height,
            columns: self.columns,
            places: self.count(),
            first_sample: 0,
            first: 0,
            count: 0,
            slots,
            seed: options.seed,
            max_depth: options.max_depth,
            roulette_from: options.roulette_from,
            reach: options.reach,
            first_packet,
            _unused: [0; 3],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pixel_has_a_place_of_its_own() {
        let places = Places::new([21, 10]);
        assert_eq!(places.count(), 24 * 16);
        let mut seen = vec![false; places.count() as usize];
        for (x, y) in (0..10).flat_map(|y| (0..21).map(move |x| (x, y))) {
            let place = places.of(x, y) as usize;
            assert!(!std::mem::replace(&mut seen[place], true));
        }
    }
}
