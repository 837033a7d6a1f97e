//! How bright a pixel can be, as its neighbours say.
//!
//! Relative errors are divided by the square of a pixel's true mean, which is not known. A pixel that one rare bright
//! path has hit has a mean that is far too high, and its error, divided by that, seems small. No pixel is therefore
//! taken to be brighter than its neighbours say it can be: real edges and highlights have neighbours as bright.

/// For each pixel of an image of `width` pixels a row, the mean of the second and third brightest of its eight neighbours;
/// no limit where the image is less than three pixels wide or high.
pub(crate) fn brightest_plausible(image: &[f32], width: usize) -> Vec<f32> {
    let height = image.len() / width.max(1);
    if width < 3 || height < 3 {
        return vec![f32::MAX; image.len()];
    }
    let mut result = vec![0.0; image.len()];
    for y in 0..height {
        // Outside of the image, the nearest inside stands in.
        let rows = [y.saturating_sub(1), y, (y + 1).min(height - 1)]
            .map(|row| &image[row * width..][..width]);
        let of_row = &mut result[y * width..][..width];
        for x in 1..width - 1 {
            of_row[x] = limit(rows, [x - 1, x, x + 1]);
        }
        of_row[0] = limit(rows, [1, 0, 1]);
        of_row[width - 1] = limit(rows, [width - 2, width - 1, width - 2]);
    }
    result
}

/// The limit of the pixel in the middle of three rows and columns.
#[inline(always)]
fn limit(rows: [&[f32]; 3], [left, middle, right]: [usize; 3]) -> f32 {
    let [mut first, mut second, mut third] = [f32::MIN; 3];
    let mut insert = |value: f32| {
        third = larger(third, smaller(second, value));
        second = larger(second, smaller(first, value));
        first = larger(first, value);
    };
    for row in [0, 2] {
        insert(rows[row][left]);
        insert(rows[row][middle]);
        insert(rows[row][right]);
    }
    insert(rows[1][left]);
    insert(rows[1][right]);
    0.5 * (second + third)
}

#[inline(always)]
fn larger(a: f32, b: f32) -> f32 {
    if a < b { b } else { a }
}

#[inline(always)]
fn smaller(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::brightest_plausible;

    #[test]
    fn a_speck_is_beyond_the_limit_and_an_edge_is_not() {
        // Left half 1, right half 5, and a speck of 100 on the left.
        let image: Vec<f32> = (0..8 * 6)
            .map(|k| match (k % 8, k / 8) {
                (1, 3) => 100.0,
                (0..4, _) => 1.0,
                _ => 5.0,
            })
            .collect();
        let limits = brightest_plausible(&image, 8);
        for (k, (&value, &limit)) in image.iter().zip(&limits).enumerate() {
            let expected = if value == 100.0 { 1.0 } else { value };
            assert_eq!(value.min(limit), expected, "pixel {k}");
        }
    }

    #[test]
    fn limits_are_of_the_second_and_third_brightest() {
        let image = [9.0, 1.0, 2.0, 3.0, 100.0, 8.0, 0.0, 7.0, 4.0];
        assert_eq!(brightest_plausible(&image, 3)[4], 7.5);
        assert_eq!(brightest_plausible(&[1.0, 9.0], 2), [f32::MAX; 2]);
    }
}
