//! How wrong a film's image is, by its samples.

use residual_accuracy::{ErrorEstimate, Replicate, Sampled, guaranteed_mse};

use super::{Film, SecondSet, TileRect};

impl Film {
    /// The estimated error; `None` below four samples a pixel.
    pub fn error(&self) -> Option<ErrorEstimate> {
        self.error_within(self.rect())
    }

    /// The estimated error of a part of the image by itself; `None` below four samples a pixel.
    ///
    /// # Panics
    /// If the part is not within the image.
    pub fn error_within(&self, part: TileRect) -> Option<ErrorEstimate> {
        let (pixels, replicates) = self.observed(part);
        ErrorEstimate::of(part.width as usize, &pixels, replicates.as_deref())
    }

    /// A mean squared error that the image does not exceed with 95 % confidence, whatever light there is, if all samples lie in
    /// [0, 1]; of the pixels in whole blocks of the second set, which are all but a few at the right and bottom edges.
    /// `None` without a second set.
    pub fn guaranteed_mse(&self) -> Option<f64> {
        let (pixels, replicates) = self.observed(self.rect());
        guaranteed_mse(&pixels, &replicates?)
    }

    fn rect(&self) -> TileRect {
        TileRect {
            x: 0,
            y: 0,
            width: self.width,
            height: self.height,
        }
    }

    /// The samples of the pixels in a part of the image, and the second sets of some of them, if there are any.
    fn observed(&self, part: TileRect) -> (Vec<Sampled<'_>>, Option<Vec<Replicate<'_>>>) {
        let TileRect {
            x,
            y,
            width,
            height,
        } = part;
        assert!(x + width <= self.width && y + height <= self.height);
        let within = move |[px, py]: [u32; 2]| {
            let inside = px >= x && py >= y && px - x < width && py - y < height;
            inside.then(|| (py - y) as usize * width as usize + (px - x) as usize)
        };
        let pixels = grid(self.width, self.height)
            .zip(self.sampled())
            .filter_map(|(pixel, sampled)| within(pixel).map(|_| sampled))
            .collect();
        let replicates = self.second.as_deref().map(|second| {
            let SecondSet { set, seed, film } = second;
            let places = grid(film.width, film.height).zip(film.sampled());
            let replicates = places.filter_map(|(place, sampled)| {
                let pixel = within(set.pixel(*seed, place))?;
                Some(Replicate { pixel, sampled })
            });
            replicates.collect()
        });
        (pixels, replicates)
    }
}

/// Columns and rows, row by row.
fn grid(width: u32, height: u32) -> impl Iterator<Item = [u32; 2]> {
    (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
}
