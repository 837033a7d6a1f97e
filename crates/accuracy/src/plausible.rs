//! How bright a pixel can be, as its neighbours say.
//!
//! Relative errors are divided by the square of a pixel's true mean, which is not known. A pixel that one rare bright
//! path has hit has a mean that is far too high, and its error, divided by that, seems small. A pixel that is brighter by far
//! than its neighbours is therefore taken to be as bright as they are: real edges and highlights have neighbours as bright.

use crate::moments::CHANNELS;

type Channels = [f32; CHANNELS];

/// What a pixel's neighbours say of it, by channel.
struct Plausible {
    /// The mean of the second and third brightest of its eight neighbours.
    bright: Channels,
    /// As far above that as three times its distance to their median: noise hardly gets there.
    most: Channels,
}

impl Plausible {
    /// What the neighbours say.
    #[inline(always)]
    fn of(neighbors: [Channels; 8]) -> Self {
        let sorted = sorted(neighbors);
        let mut said = Self {
            bright: [0.0; CHANNELS],
            most: [0.0; CHANNELS],
        };
        for (k, (bright, most)) in said.bright.iter_mut().zip(&mut said.most).enumerate() {
            let median = 0.5 * (sorted[3][k] + sorted[4][k]);
            *bright = 0.5 * (sorted[5][k] + sorted[6][k]);
            *most = *bright + 3.0 * (*bright - median);
        }
        said
    }

    /// The mean, or, where that is implausible, what it would be as one of its bright neighbours.
    #[inline(always)]
    fn limit(&self, mean: [f64; CHANNELS]) -> [f64; CHANNELS] {
        let mut limited = mean;
        for k in 0..CHANNELS {
            if mean[k] > f64::from(self.most[k]) {
                limited[k] = f64::from(self.bright[k]);
            }
        }
        limited
    }
}

/// A mean of pixel `p` of an image of `width` pixels a row, as far as its neighbours make it plausible. Everything is plausible
/// where the image is less than three pixels wide or high. Outside of the image, the nearest pixels inside stand in.
#[inline(always)]
pub(crate) fn plausible(
    image: &[Channels],
    width: usize,
    p: usize,
    mean: [f64; CHANNELS],
) -> [f64; CHANNELS] {
    let height = image.len() / width;
    if width < 3 || height < 3 {
        return mean;
    }
    let (x, y) = (p % width, p / width);
    let [left, right] = [
        if x > 0 { x - 1 } else { 1 },
        if x + 1 < width { x + 1 } else { width - 2 },
    ];
    let [above, beside, below] = [
        if y > 0 { y - 1 } else { 1 },
        y,
        if y + 1 < height { y + 1 } else { height - 2 },
    ]
    .map(|row| &image[row * width..][..width]);
    let neighbors = [
        above[left],
        above[x],
        above[right],
        beside[left],
        beside[right],
        below[left],
        below[x],
        below[right],
    ];
    // Where three are as bright, the limit is above the mean: no need to sort.
    let mut as_bright = [0; CHANNELS];
    for neighbor in &neighbors {
        for k in 0..CHANNELS {
            as_bright[k] += i32::from(f64::from(neighbor[k]) >= mean[k]);
        }
    }
    if as_bright.iter().all(|count| *count >= 3) {
        return mean;
    }
    Plausible::of(neighbors).limit(mean)
}

/// Eight numbers in ascending order, by a network of comparisons (Knuth, *The Art of Computer Programming* 3, 5.3.4), for each
/// channel.
#[inline(always)]
fn sorted(mut values: [Channels; 8]) -> [Channels; 8] {
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
        let (first, second) = (values[a], values[b]);
        for k in 0..CHANNELS {
            let is_sorted = first[k] <= second[k];
            values[a][k] = if is_sorted { first[k] } else { second[k] };
            values[b][k] = if is_sorted { second[k] } else { first[k] };
        }
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
        let image: Vec<_> = image.into_iter().map(|value| [value; CHANNELS]).collect();
        for (p, value) in image.iter().enumerate() {
            let value = value.map(f64::from);
            let expected = if value[0] == 100.0 {
                [1.0; CHANNELS]
            } else {
                value
            };
            assert_eq!(plausible(&image, 8, p, value), expected, "pixel {p}");
        }
    }

    #[test]
    fn limits_are_of_the_bright_neighbours() {
        let image = [9.0, 1.0, 2.0, 3.0, 100.0, 8.0, 0.0, 7.0, 4.0].map(|value| [value; CHANNELS]);
        // The bright neighbours are 7 and 8, the median is 3.5.
        let most = 7.5 + 3.0 * (7.5 - 3.5);
        let limited = plausible(&image, 3, 4, [most, most + 0.1, 1.0, 30.0]);
        assert_eq!(limited, [most, 7.5, 1.0, 7.5]);
        assert_eq!(
            plausible(&image[..2], 2, 1, [1e9; CHANNELS]),
            [1e9; CHANNELS]
        );
    }

    #[test]
    fn the_network_sorts() {
        // A network that sorts all sequences of 0 and 1 sorts everything.
        for bits in 0..256 {
            let values = std::array::from_fn(|k| [(bits >> k & 1) as f32; CHANNELS]);
            assert!(sorted(values).is_sorted(), "{bits:b}");
        }
    }
}
