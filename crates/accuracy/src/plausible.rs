//! How bright a pixel can be, as its neighbours say.
//!
//! Relative errors are divided by the square of a pixel's true mean, which is not known. A pixel that one rare bright
//! path has hit has a mean that is far too high, and its error, divided by that, seems small. A pixel that is brighter by far
//! than its neighbours is therefore taken to be as bright as they are: real edges and highlights have neighbours as bright.

/// What a pixel's neighbours say of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plausible {
    /// The mean of the second and third brightest of its eight neighbours.
    bright: f32,
    /// As far above that as three times its distance to their median: noise hardly gets there.
    most: f32,
}

impl Plausible {
    /// The pixel's mean, or, if that is implausible, what it would be as one of its bright neighbours.
    #[inline(always)]
    pub(crate) fn limit(&self, mean: f64) -> f64 {
        if mean > f64::from(self.most) {
            f64::from(self.bright)
        } else {
            mean
        }
    }
}

/// For each pixel of an image of `width` pixels a row; everything is plausible where it is less than three pixels wide or
/// high.
pub(crate) fn plausible(image: &[f32], width: usize) -> Vec<Plausible> {
    let height = image.len() / width.max(1);
    let anything = Plausible {
        bright: f32::MAX,
        most: f32::MAX,
    };
    let mut result = vec![anything; image.len()];
    if width < 3 || height < 3 {
        return result;
    }
    for y in 0..height {
        // Outside of the image, the nearest inside stands in.
        let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)]
            .map(|row| &image[row * width..][..width]);
        let of_row = &mut result[y * width..][..width];
        for x in 1..width - 1 {
            of_row[x] = neighbours(rows, [x - 1, x, x + 1]);
        }
        of_row[0] = neighbours(rows, [1, 0, 1]);
        of_row[width - 1] = neighbours(rows, [width - 2, width - 1, width - 2]);
    }
    result
}

/// What those say that lie around the middle of three rows and columns.
#[inline(always)]
fn neighbours(rows: [&[f32]; 3], [left, middle, right]: [usize; 3]) -> Plausible {
    let [above, beside, below] = rows;
    let sorted = sorted([
        above[left],
        above[middle],
        above[right],
        beside[left],
        beside[right],
        below[left],
        below[middle],
        below[right],
    ]);
    let bright = 0.5 * (sorted[5] + sorted[6]);
    let median = 0.5 * (sorted[3] + sorted[4]);
    Plausible {
        bright,
        most: bright + 3.0 * (bright - median),
    }
}

/// Eight numbers in ascending order, by a network of comparisons (Knuth, *The Art of Computer Programming* 3, 5.3.4).
#[inline(always)]
fn sorted(mut values: [f32; 8]) -> [f32; 8] {
    const NETWORK: [(usize, usize); 19] = [
        (0, 2),
        (1, 3),
        (4, 6),
        (5, 7),
        (0, 4),
        (1, 5),
        (2, 6),
        (3, 7),
        (0, 1),
        (2, 3),
        (4, 5),
        (6, 7),
        (2, 4),
        (3, 5),
        (1, 4),
        (3, 6),
        (1, 2),
        (3, 4),
        (5, 6),
    ];
    for (a, b) in NETWORK {
        let (low, high) = (values[a], values[b]);
        let is_sorted = low <= high;
        values[a] = if is_sorted { low } else { high };
        values[b] = if is_sorted { high } else { low };
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speck_is_implausible_and_an_edge_is_not() {
        // Left half 1, right half 5, and a speck of 100 on the left.
        let image: Vec<f32> = (0..8 * 6)
            .map(|k| match (k % 8, k / 8) {
                (1, 3) => 100.0,
                (0..4, _) => 1.0,
                _ => 5.0,
            })
            .collect();
        let said = plausible(&image, 8);
        for (k, (&value, said)) in image.iter().zip(&said).enumerate() {
            let expected = if value == 100.0 {
                1.0
            } else {
                f64::from(value)
            };
            assert_eq!(said.limit(f64::from(value)), expected, "pixel {k}");
        }
    }

    #[test]
    fn limits_are_of_the_bright_neighbours() {
        let image = [9.0, 1.0, 2.0, 3.0, 100.0, 8.0, 0.0, 7.0, 4.0];
        let said = plausible(&image, 3)[4];
        assert_eq!((said.bright, said.most), (7.5, 7.5 + 3.0 * (7.5 - 3.5)));
        assert_eq!([said.limit(19.0), said.limit(20.0)], [19.0, 7.5]);
        assert_eq!(plausible(&[1.0, 9.0], 2)[1].limit(9.0), 9.0);
    }

    #[test]
    fn the_network_sorts() {
        // A network that sorts all sequences of 0 and 1 sorts everything.
        for bits in 0..256 {
            let values = std::array::from_fn(|k| (bits >> k & 1) as f32);
            assert!(sorted(values).is_sorted(), "{bits:b}");
        }
    }
}
