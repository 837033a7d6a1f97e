//! Pixels that are sampled twice: what tells the error of well-distributed points, which cannot be seen from inside
//! (`residual_accuracy::ErrorEstimate` says how).
//!
//! They are few, spread evenly, one in each square block of the image, and their second samples are of no use but for the
//! estimate, so that images do not depend on it.

use crate::domain::{Buffers, Scalar, Uint};
use crate::sampler::SampleKey;

/// Which of two independent sets of samples, and of which pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SampleSet {
    /// The image's, of all pixels.
    First,
    /// Another one, of one pixel in each block of this many pixels along its side.
    Second {
        /// Pixels along the side of a block.
        block: u32,
    },
}

/// Side of the blocks of images of at least so many pixels: in large images, a smaller part of them says as much. It costs
/// 1 % of the time from 512 × 512 pixels on.
const BLOCKS: [(u64, u32); 3] = [(1 << 18, 10), (1 << 16, 8), (0, 4)];

impl SampleSet {
    /// The second set for an image of this size, with blocks of at most `largest` pixels along their sides; `None` if the image is
    /// too small for one.
    pub(super) fn second(width: u32, height: u32, largest: u32) -> Option<Self> {
        let pixels = u64::from(width) * u64::from(height);
        let fits = |(least, block): &(u64, u32)| pixels >= *least && *block <= largest;
        let (_, block) = BLOCKS.into_iter().find(fits)?;
        (width >= block && height >= block).then_some(Self::Second { block })
    }

    /// The seed of the set's random numbers, where the render has this one.
    pub fn seed(self, seed: u32) -> u32 {
        match self {
            Self::First => seed,
            // Far from those that people give to renders that they average.
            Self::Second { .. } => seed ^ 0xd1b5_4a35,
        }
    }

    /// The pixel of the image that pixel (x, y) of the set is, where the set has this seed.
    #[inline]
    pub fn pixel(self, seed: u32, [x, y]: [u32; 2]) -> [u32; 2] {
        match self {
            Self::First => [x, y],
            Self::Second { block } => {
                let key = SampleKey::new(
                    Scalar::new(&Buffers::EMPTY),
                    Uint(x),
                    Uint(y),
                    Uint(0),
                    Uint(seed),
                );
                let Uint(random) = key.pixel;
                let within = [random % block, (random >> 16) % block];
                [x * block + within[0], y * block + within[1]]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_has_one_pixel_anywhere_in_it() {
        let set = SampleSet::second(320, 240, u32::MAX).unwrap();
        assert_eq!(set, SampleSet::Second { block: 8 });
        let mut seen = [[0; 8]; 8];
        for (x, y) in (0..80).flat_map(|x| (0..60).map(move |y| (x, y))) {
            let [column, row] = set.pixel(set.seed(7), [x, y]);
            assert_eq!([column / 8, row / 8], [x, y]);
            seen[row as usize % 8][column as usize % 8] += 1;
        }
        // 75 are expected in each of 64 places; 5 standard deviations are 43.
        assert!(
            seen.as_flattened().iter().all(|n| (32..=118).contains(n)),
            "{seen:?}"
        );
        assert_eq!(SampleSet::second(3, 480, u32::MAX), None);
        assert_eq!(SampleSet::second(1000, 480, 8), Some(set));
        assert_eq!(SampleSet::First.pixel(1, [5, 6]), [5, 6]);
    }
}
