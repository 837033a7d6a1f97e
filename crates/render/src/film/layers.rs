//! What a film keeps beside radiance, as images: [`Layers`](crate::layer::Layers).

use residual_accuracy::Sampled;

use super::Film;
use super::tile::FilmTile;
use crate::layer::{Layer, Layers, Reduction, Statistic};

impl Film {
    /// One channel of a layer, row by row from the top; `None` where the film does not have the layer, or the layer not
    /// so many channels.
    pub fn channel(&self, layer: Layer, channel: usize) -> Option<Vec<f32>> {
        self.layer(layer)?.into_iter().nth(channel)
    }

    /// All channels of a layer; `None` where the film does not have it.
    pub fn layer(&self, layer: Layer) -> Option<Vec<Vec<f32>>> {
        if !self.layers.has(layer) {
            return None;
        }
        let is_mean = match layer.reduction() {
            Reduction::Mean => true,
            Reduction::First => false,
            Reduction::Coverage => return Some(self.coverage(layer)),
            Reduction::Statistic(statistic) => {
                return Some(self.statistic(statistic, layer.channels().len()));
            }
        };
        let stride = self.layers.stride() - Layers::RADIANCE;
        let first = self.layers.offset(layer) - Layers::RADIANCE;
        let values = |channel: usize| {
            let value = |(tile, index): (&FilmTile, usize)| {
                let kept = tile.channels[index * stride + first + channel];
                let count = if is_mean { tile.samples.max(1) } else { 1 };
                (kept / count as f64) as f32
            };
            self.places().map(value).collect()
        };
        Some((0..layer.channels().len()).map(values).collect())
    }

    /// What is known of the samples of each pixel, in so many channels.
    fn statistic(&self, statistic: Statistic, channels: usize) -> Vec<Vec<f32>> {
        // Of these points' error, the samples' variance says too much.
        let effect = match statistic {
            Statistic::StandardError => self.error().map_or(1.0, |error| error.design_effect),
            Statistic::Variance | Statistic::Count => 1.0,
        };
        let values = |channel: usize| {
            let value = |sampled: Sampled<'_>| {
                let samples = sampled.samples as f64;
                let variance = || sampled.moments.statistics(sampled.samples).0.variance[channel];
                let value = match statistic {
                    Statistic::Count => samples,
                    Statistic::Variance => variance(),
                    Statistic::StandardError => (variance() / samples.max(1.0) * effect).sqrt(),
                };
                value as f32
            };
            self.sampled().map(value).collect()
        };
        (0..channels).map(values).collect()
    }

    /// The ids of a Cryptomatte layer and what they cover, rank by rank.
    fn coverage(&self, layer: Layer) -> Vec<Vec<f32>> {
        let pixels = self.width as usize * self.height as usize;
        let mut channels = vec![Vec::with_capacity(pixels); layer.channels().len()];
        for (tile, index) in self.places() {
            let ranked = tile.coverage(layer)[index].ranked();
            for (channel, value) in channels.iter_mut().zip(ranked.as_flattened()) {
                channel.push(*value);
            }
        }
        channels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn coverage_is_counted() {
        let layers = Layers::NONE
            .with(Layer::CryptoObject)
            .with(Layer::CryptoMaterial);
        assert_eq!(layers.stride(), 5);
        let mut film = Film::new(2, 1, 8, layers);
        let pixel = |object: f32, material: f32| [0.5, 0.5, 0.5, object, material];
        for object in [2.0, 3.0, 2.0, 2.0] {
            let sample = [pixel(object, -1.0), pixel(0.0, object)].concat();
            film.tiles_mut()[0].add(&sample);
        }
        let ranks = |layer| {
            let channels = film.layer(layer).unwrap();
            [0, 1].map(|pixel| {
                channels
                    .iter()
                    .map(|c| c[pixel])
                    .take(6)
                    .collect::<Vec<_>>()
            })
        };
        let both = [2.0, 0.75, 3.0, 0.25, 0.0, 0.0];
        assert_eq!(
            ranks(Layer::CryptoObject),
            [both, [0.0, 1.0, 0.0, 0.0, 0.0, 0.0]]
        );
        assert_eq!(
            ranks(Layer::CryptoMaterial),
            [[-1.0, 1.0, 0.0, 0.0, 0.0, 0.0], both]
        );
        assert_eq!(film.channel(Layer::CryptoObject, 12), None);
    }
}
