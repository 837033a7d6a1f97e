//! Rectangles of an image.

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Its leftmost column.
    pub x: usize,
    /// Its uppermost row.
    pub y: usize,
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// A tile and its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileError {
    /// Where it is.
    pub tile: Tile,
    /// Its relative mean squared error, on the scale of the whole reference.
    pub relmse: f64,
}

impl Tile {
    /// The squares of `side` pixels that cover an image of this width and height, cut off at its right and lower border.
    pub(super) fn all([width, height]: [usize; 2], side: usize) -> impl Iterator<Item = Self> {
        assert!(side > 0);
        let rows = (0..height).step_by(side);
        rows.flat_map(move |y| {
            (0..width).step_by(side).map(move |x| Self {
                x,
                y,
                width: side.min(width - x),
                height: side.min(height - y),
            })
        })
    }

    /// How many pixels it has.
    pub fn pixels(&self) -> usize {
        self.width * self.height
    }

    /// The indices of its pixels in an image that is `image_width` wide.
    pub(super) fn indices(self, image_width: usize) -> impl Iterator<Item = usize> {
        (self.y..self.y + self.height)
            .flat_map(move |y| (self.x..self.x + self.width).map(move |x| y * image_width + x))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_each_pixel_once() {
        for (size, side) in [([7, 5], 3), ([4, 4], 4), ([1, 9], 2), ([3, 2], 8)] {
            let mut covered = vec![0; size[0] * size[1]];
            for tile in Tile::all(size, side) {
                let indices: Vec<_> = tile.indices(size[0]).collect();
                assert_eq!(indices.len(), tile.pixels());
                indices.iter().for_each(|&k| covered[k] += 1);
            }
            assert!(covered.iter().all(|&times| times == 1), "{size:?} {side}");
        }
    }
}
