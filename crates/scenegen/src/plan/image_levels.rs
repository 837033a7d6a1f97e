//! The levels of an image: smaller and smaller images of it, down to one texel, whose texels are means.

/// Red, green, blue and alpha, linear.
pub(super) type Texel = [f32; 4];

/// The sizes of all levels, the image's own first: each has half the texels of the one before along a side, rounded down, and at
/// least one.
pub(super) fn sizes(size: [u32; 2]) -> Vec<[u32; 2]> {
    let half = |size: &[u32; 2]| (*size != [1; 2]).then(|| size.map(|side| (side / 2).max(1)));
    std::iter::successors(Some(size), half).collect()
}

/// The texels of all levels but the image itself, level by level, row by row.
pub(super) fn texels(size: [u32; 2], image: impl Fn(usize) -> Texel) -> Vec<Vec<Texel>> {
    let sizes = sizes(size);
    let mut levels: Vec<Vec<Texel>> = Vec::new();
    for pair in sizes.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let level = match levels.last() {
            None => reduced(from, to, &image),
            Some(above) => reduced(from, to, |index| above[index]),
        };
        levels.push(level);
    }
    levels
}

/// An image of another size whose texels are the means of what lies under them: parts of texels count as parts.
fn reduced(
    [width, height]: [u32; 2],
    [columns, rows]: [u32; 2],
    texel: impl Fn(usize) -> Texel,
) -> Vec<Texel> {
    let (across, down) = (weights(width, columns), weights(height, rows));
    let mut means = Vec::with_capacity(across.len() * down.len());
    for row in &down {
        for column in &across {
            let mut sum = [0.0_f64; 4];
            for &(y, part_of_row) in row {
                for &(x, part_of_column) in column {
                    let weight = part_of_row * part_of_column;
                    let texel = texel(y as usize * width as usize + x as usize);
                    for (sum, channel) in sum.iter_mut().zip(texel) {
                        *sum += weight * f64::from(channel);
                    }
                }
            }
            means.push(sum.map(|sum| sum as f32));
        }
    }
    means
}

/// For each of `parts` equal parts of a side of `count` texels, the texels that lie in it, with their shares of it.
fn weights(count: u32, parts: u32) -> Vec<Vec<(u32, f64)>> {
    let length = f64::from(count) / f64::from(parts);
    let of_part = |part: u32| {
        let (start, end) = (f64::from(part) * length, f64::from(part + 1) * length);
        let texels = start.floor() as u32..(end.ceil() as u32).min(count);
        let share = |texel: u32| {
            let inside = end.min(f64::from(texel + 1)) - start.max(f64::from(texel));
            (texel, inside / length)
        };
        texels
            .map(share)
            .filter(|(_, share)| *share > 1e-9)
            .collect()
    };
    (0..parts).map(of_part).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of images of any size: as many levels as the filter counts, each with the mean of the image.
    #[test]
    fn levels_keep_the_mean() {
        for size in [
            [1, 1],
            [2, 1],
            [1, 7],
            [5, 3],
            [16, 16],
            [33, 64],
            [255, 10],
        ] {
            let [width, height] = size.map(|side| side as usize);
            let image: Vec<Texel> = (0..width * height)
                .map(|k| [0.0, 0.37, 2.5, 1.0].map(|c| c * ((k * 2_654_435 % 97) as f32)))
                .collect();
            let mean = |texels: &[Texel]| {
                let sum: f64 = texels.iter().map(|texel| f64::from(texel[1])).sum();
                sum / texels.len() as f64
            };
            let levels = texels(size, |index| image[index]);
            assert_eq!(levels.len() as u32, size[0].max(size[1]).ilog2());
            for (level, size) in levels.iter().zip(&sizes(size)[1..]) {
                assert_eq!(level.len() as u32, size[0] * size[1]);
                assert!((mean(level) / mean(&image) - 1.0).abs() < 1e-5, "{size:?}");
            }
        }
    }

    #[test]
    fn texels_are_means_of_what_lies_under_them() {
        let image = |index: usize| [index as f32, 0.0, 0.0, 0.0];
        // 0 1 2 / 3 4 5 / 6 7 8 / 9 10 11 becomes two texels, each of six and all columns.
        let levels = texels([3, 4], image);
        assert_eq!(levels[0][0][0], 2.5);
        assert_eq!(levels[0][1][0], 8.5);
        assert_eq!(levels[1], [[5.5, 0.0, 0.0, 0.0]]);
        // Five columns become two: the middle one counts half for either.
        let [left, right] = texels([5, 1], image)[0][..] else {
            panic!("two texels")
        };
        assert_eq!([left[0], right[0]], [2.0 / 2.5, 8.0 / 2.5]);
    }
}
