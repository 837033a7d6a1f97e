//! The film: per-pixel sums and variances, in `f64`, so that neither saturates nor cancels (hard cases S-01, S-02).
//!
//! Pixels are kept tile by tile, so that a device's threads each own the tiles they render and share nothing. Beside
//! radiance a film has the [`Layers`] that it was made for; what is kept of each is said by its
//! [`Reduction`].

use crate::layer::{Layer, Layers, Reduction};

/// Pixels along the side of a tile. The paths under way in one, with all they carry, fit a second-level cache.
pub const TILE_SIZE: u32 = 64;

/// What is kept of a pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Pixel {
    /// Sum of the samples.
    sum: [f64; 3],
    /// Running mean of the samples' luminance (Welford 1962).
    mean: f64,
    /// Sum of squared deviations from it.
    deviations: f64,
}

impl Pixel {
    /// Adds sample number `n`, counted from 1.
    fn add(&mut self, rgb: [f64; 3], n: f64) {
        for (sum, c) in self.sum.iter_mut().zip(rgb) {
            *sum += c;
        }
        let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        let delta = luminance - self.mean;
        self.mean += delta / n;
        self.deviations += delta * (luminance - self.mean);
    }
}

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileRect {
    /// Leftmost column.
    pub x: u32,
    /// Topmost row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl TileRect {
    /// How many pixels it has.
    pub fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// One tile of a [`Film`].
#[derive(Clone, Debug, PartialEq)]
pub struct FilmTile {
    rect: TileRect,
    pixels: Vec<Pixel>,
    layers: Layers,
    /// Sums, or first samples, of the channels behind radiance, pixel by pixel.
    channels: Vec<f64>,
    samples: u64,
    invalid: u64,
}

impl FilmTile {
    /// Where it lies.
    pub fn rect(&self) -> TileRect {
        self.rect
    }

    /// Adds samples to every pixel; `samples[sample][row][column][channel]`, with the channels of the film's layers
    /// behind those of radiance. Samples of a pixel are added in their order, so that the film depends neither on the
    /// tiling nor on threads.
    ///
    /// # Panics
    /// If `samples` is not a whole number of samples of the tile.
    pub fn add(&mut self, samples: &[f32]) {
        let stride = self.layers.stride();
        assert_eq!(
            samples.len() % (self.rect.area() * stride),
            0,
            "whole samples of the tile"
        );
        for sample in samples.chunks_exact(self.rect.area() * stride) {
            self.samples += 1;
            let n = self.samples as f64;
            for (pixel, values) in self.pixels.iter_mut().zip(sample.chunks_exact(stride)) {
                let rgb = [values[0], values[1], values[2]];
                let valid = rgb.iter().all(|c| c.is_finite() && *c >= 0.0);
                self.invalid += u64::from(!valid);
                pixel.add(if valid { rgb.map(f64::from) } else { [0.0; 3] }, n);
            }
            if stride > Layers::RADIANCE {
                self.add_channels(sample);
            }
        }
    }

    /// Adds the channels of one sample of all pixels.
    fn add_channels(&mut self, sample: &[f32]) {
        let stride = self.layers.stride();
        let is_added = |layer: &Layer| match layer.reduction() {
            Reduction::Mean => true,
            Reduction::First => self.samples == 1,
            Reduction::Count => false,
        };
        for layer in self.layers.iter().filter(is_added) {
            let first = self.layers.offset(layer);
            let numbers = first..first + layer.channels().len();
            let kept = self.channels.chunks_exact_mut(stride - Layers::RADIANCE);
            for (kept, values) in kept.zip(sample.chunks_exact(stride)) {
                for number in numbers.clone() {
                    kept[number - Layers::RADIANCE] += f64::from(values[number]);
                }
            }
        }
    }
}

/// An image being accumulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    tiles: Vec<FilmTile>,
    tile_size: u32,
    layers: Layers,
}

/// How far an image is from its limit, from its own variance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Relative mean squared error, averaged over pixels: var/n ÷ (mean² + 1e-2·(scene mean)²).
    pub relmse: f64,
    /// Half the width of the 95 % confidence interval of `relmse`.
    pub ci95: f64,
}

impl Film {
    /// A black film, cut into square tiles of `tile_size` pixels (less at the right and bottom edges).
    pub fn new(width: u32, height: u32, tile_size: u32, layers: Layers) -> Self {
        let starts = |length: u32| (0..length).step_by(tile_size as usize);
        let tile = |x: u32, y: u32| {
            let rect = TileRect {
                x,
                y,
                width: tile_size.min(width - x),
                height: tile_size.min(height - y),
            };
            FilmTile {
                rect,
                pixels: vec![Pixel::default(); rect.area()],
                layers,
                channels: vec![0.0; rect.area() * (layers.stride() - Layers::RADIANCE)],
                samples: 0,
                invalid: 0,
            }
        };
        let tiles = starts(height)
            .flat_map(|y| starts(width).map(move |x| tile(x, y)))
            .collect();
        Self {
            width,
            height,
            tiles,
            tile_size,
            layers,
        }
    }

    /// Pixels a row.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// What it keeps beside radiance.
    pub fn layers(&self) -> Layers {
        self.layers
    }

    /// The tiles, to be rendered into.
    pub fn tiles_mut(&mut self) -> &mut [FilmTile] {
        &mut self.tiles
    }

    /// Samples a pixel so far; the fewest of any tile.
    pub fn samples(&self) -> u64 {
        self.tiles
            .iter()
            .map(|tile| tile.samples)
            .min()
            .unwrap_or(0)
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
                let index = (y - tile.rect.y) * tile.rect.width + (x - tile.rect.x);
                (tile, index as usize)
            })
        })
    }

    /// Pixels with how many samples they have.
    fn pixels(&self) -> impl Iterator<Item = (&Pixel, f64)> {
        self.places()
            .map(|(tile, index)| (&tile.pixels[index], tile.samples as f64))
    }

    /// One channel of a layer, row by row from the top; `None` where the film does not have the layer, or the layer not
    /// so many channels.
    pub fn channel(&self, layer: Layer, channel: usize) -> Option<Vec<f32>> {
        if !self.layers.has(layer) || channel >= layer.channels().len() {
            return None;
        }
        let stride = self.layers.stride() - Layers::RADIANCE;
        let offset = self.layers.offset(layer) - Layers::RADIANCE + channel;
        let value = |(tile, index): (&FilmTile, usize)| {
            let kept = || tile.channels[index * stride + offset];
            let samples = tile.samples as f64;
            let value = match layer.reduction() {
                Reduction::Mean => kept() / samples.max(1.0),
                Reduction::First => kept(),
                Reduction::Count => samples,
            };
            value as f32
        };
        Some(self.places().map(value).collect())
    }

    /// The image: mean linear red, green, blue, row by row from the top.
    pub fn image(&self) -> Vec<[f32; 3]> {
        self.pixels()
            .map(|(p, n)| p.sum.map(|c| (c / n.max(1.0)) as f32))
            .collect()
    }

    /// Mean of the whole image.
    pub fn mean(&self) -> [f64; 3] {
        let count = f64::from(self.width) * f64::from(self.height);
        let sum = self.pixels().fold([0.0; 3], |sum, (p, n)| {
            [0, 1, 2].map(|k| sum[k] + p.sum[k] / n.max(1.0))
        });
        sum.map(|c| c / count)
    }

    /// The estimated error; `None` below two samples a pixel.
    pub fn error(&self) -> Option<ErrorEstimate> {
        if self.samples() < 2 {
            return None;
        }
        let count = f64::from(self.width) * f64::from(self.height);
        let scene = self.pixels().map(|(p, _)| p.mean).sum::<f64>() / count;
        let floor = 1e-2 * scene * scene;
        let relative = |(p, n): (&Pixel, f64)| {
            let variance = p.deviations / (n - 1.0) / n;
            let denominator = p.mean * p.mean + floor;
            if denominator > 0.0 {
                variance / denominator
            } else {
                0.0
            }
        };
        let relmse = self.pixels().map(relative).sum::<f64>() / count;
        let spread = self
            .pixels()
            .map(|p| (relative(p) - relmse).powi(2))
            .sum::<f64>();
        let ci95 = 1.96 * (spread / (count - 1.0).max(1.0) / count).sqrt();
        Some(ErrorEstimate { relmse, ci95 })
    }
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
                .flat_map(|s| [1000.0 + if s % 2 == 0 { 0.5 } else { -0.5 }; 3])
                .collect();
            film.tiles_mut()[0].add(&tile);
        }
        let n = 512.0 * f64::from(samples);
        assert_eq!(film.samples(), n as u64);
        assert!((film.mean()[0] - 1000.0).abs() < 1e-6);
        let expected = 0.25 / n / (1000.0 * 1000.0 * 1.01);
        assert!((film.error().unwrap().relmse / expected - 1.0).abs() < 1e-3);
    }

    #[test]
    fn layers_are_means_first_samples_and_counts() {
        let layers = Layers::NONE
            .with(Layer::Normal)
            .with(Layer::Depth)
            .with(Layer::SampleCount);
        assert_eq!(layers.stride(), 7);
        let mut film = Film::new(2, 1, 8, layers);
        let pixel = |normal: f32, depth| [1.0, 1.0, 1.0, normal, 0.0, -normal, depth];
        let first = [pixel(0.0, 5.0), pixel(1.0, 7.0)].concat();
        let second = [pixel(1.0, 9.0), pixel(0.5, 11.0)].concat();
        film.tiles_mut()[0].add(&[first, second].concat());
        let channel = |layer, channel| film.channel(layer, channel).unwrap();
        assert_eq!(channel(Layer::Normal, 0), [0.5, 0.75]);
        assert_eq!(channel(Layer::Normal, 2), [-0.5, -0.75]);
        assert_eq!(channel(Layer::Depth, 0), [5.0, 7.0]);
        assert_eq!(channel(Layer::SampleCount, 0), [2.0, 2.0]);
        assert_eq!(film.channel(Layer::Normal, 3), None);
        assert_eq!(film.channel(Layer::Albedo, 0), None);
        assert_eq!(film.image(), [[1.0; 3]; 2]);
    }

    #[test]
    fn invalid_samples_are_counted_and_dropped() {
        let mut film = Film::new(1, 1, 1, Layers::NONE);
        film.tiles_mut()[0].add(&[f32::NAN, 0.0, 0.0, 2.0, 2.0, 2.0, 1.0, f32::INFINITY, 0.0]);
        assert_eq!(film.invalid_samples(), 2);
        assert!((film.image()[0][0] - 2.0 / 3.0).abs() < 1e-7);
    }
}
