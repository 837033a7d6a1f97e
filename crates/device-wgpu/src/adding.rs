//! Samples on their way from the device to a film.

use rayon::prelude::*;
use residual_render::film::{FilmTile, Splats};
use residual_render::layer::Layers;
use residual_render::tracer::CostMap;

use crate::launch::Places;

/// How samples come back: `[sample][place][channel]`.
#[derive(Clone, Copy)]
pub(crate) struct Samples {
    pub(crate) places: Places,
    pub(crate) layers: Layers,
    /// How numbers of visits are shown, if they are what comes back.
    pub(crate) cost_map: Option<CostMap>,
}

/// Samples of a pass, added to the film as soon as they are there of all pixels.
pub(crate) struct Adding<'a> {
    of: Samples,
    film: &'a mut [FilmTile],
    /// What light paths bring to them.
    splats: Option<&'a Splats>,
    /// How many of a pixel are in the film.
    done: usize,
    /// One that is not there of all pixels yet.
    part: Vec<f32>,
}

impl<'a> Adding<'a> {
    pub(crate) fn new(of: Samples, film: &'a mut [FilmTile], splats: Option<&'a Splats>) -> Self {
        Self {
            of,
            film,
            splats,
            done: 0,
            part: Vec::new(),
        }
    }

    /// Takes some whole samples, or the next part of one.
    pub(crate) fn take(&mut self, values: &[f32]) {
        let whole = self.of.places.count() as usize * self.of.layers.stride();
        if values.len() >= whole {
            self.add(values);
            return;
        }
        self.part.extend_from_slice(values);
        if self.part.len() == whole {
            let sample = std::mem::take(&mut self.part);
            self.add(&sample);
        }
    }

    fn add(&mut self, values: &[f32]) {
        let Samples {
            places,
            layers,
            cost_map,
        } = self.of;
        let stride = layers.stride();
        let samples = values.chunks_exact(places.count() as usize * stride);
        let (first, count, splats) = (self.done, samples.len(), self.splats);
        self.film.par_iter_mut().for_each(|tile| {
            let rect = tile.rect();
            let mut of_tile = Vec::with_capacity(rect.area() * stride);
            for (index, sample) in (first..).zip(samples.clone()) {
                of_tile.clear();
                for y in rect.y..rect.y + rect.height {
                    for x in rect.x..rect.x + rect.width {
                        let row = places.of(x, y) as usize * stride;
                        let first = of_tile.len();
                        of_tile.extend_from_slice(&sample[row..row + stride]);
                        if let Some(map) = cost_map {
                            let color = map.color(of_tile[first] as u32);
                            of_tile[first..first + Layers::RADIANCE].copy_from_slice(&color);
                        }
                    }
                }
                if let Some(splats) = splats {
                    splats.add_to(rect, index, stride, &mut of_tile);
                }
                tile.add(&of_tile);
            }
        });
        self.done += count;
    }
}
