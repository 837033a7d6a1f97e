//! Colours for numbers, as 8-bit sRGB.

/// Magma, by which ꟻLIP's papers show errors: from black over purple to light yellow, ever lighter (N. Smith and S. van der
/// Walt, for matplotlib, CC0). At 16 equal steps, and linear between them: within 3 codes of the table of 256.
const MAGMA: [[u8; 3]; 17] = [
    [0, 0, 4],
    [10, 8, 34],
    [29, 17, 70],
    [54, 16, 106],
    [80, 18, 124],
    [105, 28, 129],
    [130, 38, 129],
    [156, 46, 127],
    [182, 55, 121],
    [207, 65, 112],
    [230, 81, 99],
    [245, 105, 92],
    [251, 135, 97],
    [254, 165, 113],
    [254, 195, 135],
    [253, 224, 162],
    [252, 253, 191],
];

/// Two hues that get darker from the light grey in the middle on, in the same steps of lightness.
const DIVERGING: [[u8; 3]; 9] = [
    [16, 42, 110],
    [42, 88, 168],
    [93, 142, 204],
    [168, 196, 226],
    [240, 240, 240],
    [236, 183, 160],
    [214, 114, 88],
    [173, 48, 42],
    [110, 8, 24],
];

/// Magma of a value from 0 to 1; what is beyond gets the colour of the end.
pub fn magma(value: f64) -> [u8; 3] {
    interpolated(&MAGMA, value)
}

/// Blue from −1 to light grey at 0 to red at 1; what is beyond gets the colour of the end.
pub fn diverging(value: f64) -> [u8; 3] {
    interpolated(&DIVERGING, 0.5 + 0.5 * value)
}

fn interpolated(colors: &[[u8; 3]], value: f64) -> [u8; 3] {
    let place = value.clamp(0.0, 1.0) * (colors.len() - 1) as f64;
    let index = (place as usize).min(colors.len() - 2);
    let part = place - index as f64;
    [0, 1, 2].map(|k| {
        let (from, to) = (f64::from(colors[index][k]), f64::from(colors[index + 1][k]));
        (from + part * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness, from 0 to 100.
    fn lightness(color: [u8; 3]) -> f64 {
        let linear = color.map(|code| {
            let c = f64::from(code) / 255.0;
            (if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }) as f32
        });
        let luminance = crate::luminance::luminance(linear);
        if luminance > 0.008856 {
            116.0 * luminance.cbrt() - 16.0
        } else {
            903.3 * luminance
        }
    }

    #[test]
    fn magma_is_that_of_matplotlib() {
        for (index, expected) in [
            (0, [0, 0, 4]),
            (64, [81, 18, 124]),
            (100, [137, 40, 129]),
            (128, [183, 55, 121]),
            (200, [253, 152, 105]),
            (255, [252, 253, 191]),
        ] {
            let ours = magma(f64::from(index) / 255.0);
            let error = (0..3)
                .map(|k| i32::abs_diff(ours[k].into(), expected[k]))
                .max();
            assert!(error <= Some(3), "{index}: {ours:?} {expected:?}");
        }
        let lightnesses: Vec<_> = (0..=64)
            .map(|k| lightness(magma(f64::from(k) / 64.0)))
            .collect();
        assert!(lightnesses.windows(2).all(|pair| pair[0] < pair[1]));
    }

    #[test]
    fn opposite_differences_are_as_dark() {
        for k in 0..=32 {
            let value = f64::from(k) / 32.0;
            let (blue, red) = (diverging(-value), diverging(value));
            let (below, above) = (lightness(blue), lightness(red));
            assert!((below - above).abs() < 4.0, "{value}: {below} {above}");
            assert!(k == 0 || (blue[2] > blue[0] && red[0] > red[2]), "{value}");
            let inner = lightness(diverging(value - 1.0 / 32.0));
            assert!(k == 0 || above < inner, "{value}");
        }
    }

    #[test]
    fn ends_hold_what_is_beyond() {
        assert_eq!(magma(7.0), magma(1.0));
        assert_eq!(magma(-1.0), magma(0.0));
        assert_eq!(diverging(f64::INFINITY), [110, 8, 24]);
        assert_eq!(diverging(f64::NEG_INFINITY), [16, 42, 110]);
        assert_eq!(diverging(0.0), [240, 240, 240]);
    }
}
