//! The film: per-pixel sums and variances, in `f64`, so that neither saturates nor cancels (hard cases S-01, S-02).
//!
//! Pixels are kept tile by tile, so that a device's threads each own the tiles they render and share nothing. Beside
//! radiance a film has the [`Layers`] that it was made for; what is kept of each is said by its
//! [`Reduction`](crate::layer::Reduction).

mod adaptive;
mod estimates;
mod layers;
mod noise;
mod pass;
mod rect;
mod replicates;
mod sampling;
mod splats;
mod tile;

pub use pass::{Pass, TileSamples};
pub use rect::TileRect;
pub use replicates::SampleSet;
pub use sampling::Sampling;
pub use splats::Splats;
pub use tile::FilmTile;

use residual_accuracy::Sampled;

use crate::layer::Layers;

/// Pixels along the side of a tile. The paths under way in one, with all they carry, fit a second-level cache.
pub const TILE_SIZE: u32 = 64;

/// An image being accumulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    tiles: Vec<FilmTile>,
    tile_size: u32,
    layers: Layers,
    sampling: Sampling,
    /// Samples a pixel of all passes so far.
    asked: u64,
    second: Option<Box<SecondSet>>,
}

/// Samples that a tile of a film is to get.
#[derive(Debug)]
pub struct TilePass<'a> {
    /// The set of samples that the tile is of.
    pub set: SampleSet,
    /// Which samples.
    pub pass: Pass,
    /// The tile.
    pub tile: &'a mut FilmTile,
}

impl TilePass<'_> {
    /// What is to be rendered.
    pub fn samples(&self) -> TileSamples {
        TileSamples {
            rect: self.tile.rect(),
            pass: self.pass,
        }
    }
}

/// The second samples of some of a film's pixels.
#[derive(Clone, Debug, PartialEq)]
struct SecondSet {
    set: SampleSet,
    /// Seed of its random numbers.
    seed: u32,
    film: Film,
}

impl Film {
    /// A black film, cut into square tiles of `tile_size` pixels (less at the right and bottom edges).
    pub fn new(width: u32, height: u32, tile_size: u32, layers: Layers) -> Self {
        let tiles = TileRect::tiles([width, height], tile_size)
            .map(|rect| FilmTile::new(rect, layers))
            .collect();
        Self {
            width,
            height,
            tiles,
            tile_size,
            layers,
            sampling: Sampling::Uniform,
            asked: 0,
            second: None,
        }
    }

    /// A black film that gets its samples so; `tile_size` counts where they are spread evenly.
    pub fn sampled_by(sampling: Sampling, size: [u32; 2], tile_size: u32, layers: Layers) -> Self {
        let [width, height] = size;
        match sampling {
            Sampling::Uniform => Self::new(width, height, tile_size, layers),
            Sampling::Adaptive => {
                let film = Self::new(width, height, adaptive::SIDE, layers);
                let tiles = film.tiles.into_iter().map(FilmTile::with_noises).collect();
                Self {
                    tiles,
                    sampling,
                    ..film
                }
            }
        }
    }

    /// The same film with a second set of samples of some pixels, for a render with this seed: without it, the stated error
    /// is that of independent samples. Too small an image has none.
    #[must_use]
    pub fn with_second_set(mut self, seed: u32) -> Self {
        let largest = match self.sampling {
            Sampling::Uniform => u32::MAX,
            Sampling::Adaptive => adaptive::SIDE,
        };
        self.second = SampleSet::second(self.width, self.height, largest).map(|set| {
            let SampleSet::Second { block } = set else {
                unreachable!("the second set is one")
            };
            // What is left at the right and bottom edges is in no block. Small tiles keep many threads busy; where samples are
            // spread by noise, a tile is that of the same pixels, and gets as many.
            let (width, height) = (self.width / block, self.height / block);
            let tile_size = match self.sampling {
                Sampling::Uniform => self.tile_size.div_ceil(4),
                Sampling::Adaptive => adaptive::SIDE / block,
            };
            let film = Film::new(width, height, tile_size, self.layers);
            let seed = set.seed(seed);
            Box::new(SecondSet { set, seed, film })
        });
        self
    }

    /// Pixels a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// How its samples are spread.
    pub fn sampling(&self) -> Sampling {
        self.sampling
    }

    /// Forgets the second set of samples: the stated error is then that of independent samples.
    pub fn drop_second_set(&mut self) {
        self.second = None;
    }

    /// What it keeps beside radiance.
    pub fn layers(&self) -> Layers {
        self.layers
    }

    /// The tiles.
    pub fn tiles(&self) -> &[FilmTile] {
        &self.tiles
    }

    /// The tiles, to be rendered into.
    pub fn tiles_mut(&mut self) -> &mut [FilmTile] {
        &mut self.tiles
    }

    /// The tiles of the image and those of the second set of samples, to be rendered into as often as one another.
    pub fn sets_mut(&mut self) -> (&mut [FilmTile], Vec<(SampleSet, &mut FilmTile)>) {
        let second = self.second.iter_mut().flat_map(|second| {
            let set = second.set;
            second.film.tiles.iter_mut().map(move |tile| (set, tile))
        });
        (&mut self.tiles, second.collect())
    }

    /// A pass of samples, tile by tile, of both sets: each tile gets all of it, or as many samples as its neighbors' noise says.
    pub fn tile_passes(&mut self, pass: Pass) -> Vec<TilePass<'_>> {
        let columns = self.width.div_ceil(self.tile_size) as usize;
        let passes = match self.sampling {
            Sampling::Uniform => vec![pass; self.tiles.len()],
            Sampling::Adaptive => adaptive::passes(&self.tiles, columns, pass),
        };
        let sampling = self.sampling;
        self.asked = u64::from(pass.first) + u64::from(pass.count);
        let (first, second) = self.sets_mut();
        let of_second = |set: SampleSet, tile: &FilmTile| match (sampling, set) {
            (Sampling::Adaptive, SampleSet::Second { block }) => {
                let [column, row] =
                    [tile.rect().x, tile.rect().y].map(|k| k * block / adaptive::SIDE);
                passes[row as usize * columns + column as usize]
            }
            _ => pass,
        };
        let second = second.into_iter().map(|(set, tile)| TilePass {
            set,
            pass: of_second(set, tile),
            tile,
        });
        let first = first.iter_mut().zip(&passes).map(|(tile, pass)| TilePass {
            set: SampleSet::First,
            pass: *pass,
            tile,
        });
        first
            .chain(second)
            .filter(|tile| tile.pass.count > 0)
            .collect()
    }

    /// Samples a pixel so far: the fewest of any tile, or, where they are spread by noise, as many as were asked for on average.
    pub fn samples(&self) -> u64 {
        match self.sampling {
            Sampling::Uniform => self
                .tiles
                .iter()
                .map(|tile| tile.samples)
                .min()
                .unwrap_or(0),
            Sampling::Adaptive => self.asked,
        }
    }

    /// Samples that were NaN, infinite or negative. They count as black; a healthy render has none.
    pub fn invalid_samples(&self) -> u64 {
        self.tiles.iter().map(|tile| tile.invalid).sum()
    }

    /// The tile of each pixel and the pixel's index in it, row by row from the top, whatever the tiling.
    fn places(&self) -> impl Iterator<Item = (&FilmTile, usize)> {
        let per_row = self.width.div_ceil(self.tile_size);
        (0..self.height).flat_map(move |y| {
            (0..self.width).map(move |x| {
                let tile =
                    &self.tiles[(y / self.tile_size * per_row + x / self.tile_size) as usize];
                let rect = tile.rect();
                let index = (y - rect.y) * rect.width + (x - rect.x);
                (tile, index as usize)
            })
        })
    }

    /// The samples of each pixel.
    fn sampled(&self) -> impl Iterator<Item = Sampled<'_>> {
        self.places().map(|(tile, index)| Sampled {
            moments: &tile.pixels[index],
            samples: tile.samples,
        })
    }

    /// The image: mean linear red, green, blue, row by row from the top.
    pub fn image(&self) -> Vec<[f32; 3]> {
        self.sampled().map(|s| mean(&s).map(|c| c as f32)).collect()
    }

    /// Mean of the whole image.
    pub fn mean(&self) -> [f64; 3] {
        let count = f64::from(self.width) * f64::from(self.height);
        let sum = self.sampled().fold([0.0; 3], |sum, sampled| {
            let mean = mean(&sampled);
            [0, 1, 2].map(|k| sum[k] + mean[k])
        });
        sum.map(|c| c / count)
    }
}

/// Mean red, green and blue.
fn mean(sampled: &Sampled<'_>) -> [f64; 3] {
    let [red, green, blue, _] = sampled.moments.mean(sampled.samples);
    [red, green, blue]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiling_does_not_show() {
        let sample = |x: u32, y: u32, s: u32| ((x * 7 + y * 13 + s * 29) % 31) as f32 * 0.37;
        let render = |tile_size: u32| {
            let mut film = Film::new(37, 21, tile_size, Layers::NONE);
            for tile in film.tiles_mut() {
                let r = tile.rect();
                for s in 0..5 {
                    let pixel = |i: u32| [sample(r.x + i % r.width, r.y + i / r.width, s); 3];
                    tile.add(&(0..r.area() as u32).flat_map(pixel).collect::<Vec<_>>());
                }
            }
            film
        };
        let (a, b) = (render(8), render(64));
        assert_eq!(a.image(), b.image());
        assert_eq!((a.mean(), a.error(), a.samples()), (b.mean(), b.error(), 5));
    }

    #[test]
    fn saturates_not_and_cancels_not() {
        // S-01 and S-02: mean 1000 ± 0.5, and more samples than f32 can count.
        let mut film = Film::new(1, 1, 1, Layers::NONE);
        let samples = 1 << 16;
        for _ in 0..512 {
            let tile: Vec<f32> = (0..samples)
                .flat_map(|s| [1000.0 + if s / 2 % 2 == 0 { 0.5 } else { -0.5 }; 3])
                .collect();
            film.tiles_mut()[0].add(&tile);
        }
        let n = 512.0 * f64::from(samples);
        assert_eq!(film.samples(), n as u64);
        assert!((film.mean()[0] - 1000.0).abs() < 1e-6);
        let expected = 0.25 / n / (1000.0 * 1000.0 * 1.01);
        assert!((film.error().unwrap().relmse.value / expected - 1.0).abs() < 1e-3);
    }

    #[test]
    fn invalid_samples_are_counted_and_dropped() {
        let mut film = Film::new(1, 1, 1, Layers::NONE);
        film.tiles_mut()[0].add(&[f32::NAN, 0.0, 0.0, 2.0, 2.0, 2.0, 1.0, f32::INFINITY, 0.0]);
        assert_eq!(film.invalid_samples(), 2);
        assert!((film.image()[0][0] - 2.0 / 3.0).abs() < 1e-7);
    }
}
