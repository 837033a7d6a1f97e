//! A tile of a film: sums of the samples of its pixels.

use residual_accuracy::{PixelMoments, SampleIndex};

use super::noise::Noises;
use super::rect::TileRect;
use crate::cryptomatte::Coverage;
use crate::layer::{Layer, Layers, Reduction};

/// One tile of a [`Film`](super::Film).
#[derive(Clone, Debug, PartialEq)]
pub struct FilmTile {
    rect: TileRect,
    pub(super) pixels: Vec<PixelMoments>,
    layers: Layers,
    /// Sums, or first samples, of the channels behind radiance, pixel by pixel.
    pub(super) channels: Vec<f64>,
    /// The ids of each pixel, for every Cryptomatte layer.
    coverages: Vec<(Layer, Vec<Coverage>)>,
    pub(super) samples: u64,
    pub(super) invalid: u64,
    /// Read where samples are spent by it.
    noises: Option<Noises>,
}

impl FilmTile {
    pub(super) fn new(rect: TileRect, layers: Layers) -> Self {
        let coverages = layers
            .iter()
            .filter(|layer| layer.reduction() == Reduction::Coverage)
            .map(|layer| (layer, vec![Coverage::default(); rect.area()]));
        Self {
            rect,
            pixels: vec![PixelMoments::default(); rect.area()],
            layers,
            channels: vec![0.0; rect.area() * (layers.stride() - Layers::RADIANCE)],
            coverages: coverages.collect(),
            samples: 0,
            invalid: 0,
            noises: None,
        }
    }

    /// The same tile, whose noise is read on the way.
    pub(super) fn with_noises(self) -> Self {
        Self {
            noises: Some(Noises::default()),
            ..self
        }
    }

    /// The noise so far.
    ///
    /// # Panics
    /// If it is not read.
    pub(super) fn noises(&self) -> &Noises {
        self.noises.as_ref().expect("a tile whose noise is read")
    }

    /// Where it lies.
    pub fn rect(&self) -> TileRect {
        self.rect
    }

    /// Samples of each of its pixels so far.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// What its pixels keep beside radiance.
    pub fn layers(&self) -> Layers {
        self.layers
    }

    /// What the pixels keep of a Cryptomatte layer.
    ///
    /// # Panics
    /// If the film has no such layer.
    pub(super) fn coverage(&self, layer: Layer) -> &[Coverage] {
        let kept = self.coverages.iter().find(|(other, _)| *other == layer);
        let (_, pixels) = kept.expect("a Cryptomatte layer of the film");
        pixels
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
            let at = SampleIndex::new(self.samples);
            self.samples += 1;
            for (pixel, values) in self.pixels.iter_mut().zip(sample.chunks_exact(stride)) {
                let rgb = [values[0], values[1], values[2]];
                let valid = rgb.iter().all(|c| c.is_finite() && *c >= 0.0);
                self.invalid += u64::from(!valid);
                pixel.add(if valid { rgb.map(f64::from) } else { [0.0; 3] }, at);
            }
            if stride > Layers::RADIANCE {
                self.add_channels(sample);
            }
            if let Some(noises) = &mut self.noises {
                noises.note(&self.pixels, self.samples);
            }
        }
    }

    /// Adds the channels of one sample of all pixels.
    fn add_channels(&mut self, sample: &[f32]) {
        let stride = self.layers.stride();
        let is_added = |layer: &Layer| match layer.reduction() {
            Reduction::Mean => true,
            Reduction::First => self.samples == 1,
            Reduction::Coverage | Reduction::Statistic(_) => false,
        };
        for layer in self.layers.iter().filter(is_added) {
            let first = self.layers.offset(layer);
            let numbers = first..first + layer.width();
            let kept = self.channels.chunks_exact_mut(stride - Layers::RADIANCE);
            for (kept, values) in kept.zip(sample.chunks_exact(stride)) {
                for number in numbers.clone() {
                    kept[number - Layers::RADIANCE] += f64::from(values[number]);
                }
            }
        }
        for (layer, pixels) in &mut self.coverages {
            let number = self.layers.offset(*layer);
            for (pixel, values) in pixels.iter_mut().zip(sample.chunks_exact(stride)) {
                pixel.add(values[number]);
            }
        }
    }
}
