//! Luminance.

/// Luminance of linear red, green and blue with the primaries of Rec. 709 (ITU-R BT.709-6, 3.2), in their unit.
#[inline(always)]
pub fn luminance<T: Into<f64>>(color: [T; 3]) -> f64 {
    let [r, g, b] = color.map(Into::into);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::luminance;

    #[test]
    fn white_is_one() {
        assert!((luminance([1.0_f32; 3]) - 1.0).abs() < 1e-12);
        assert_eq!(luminance([0.0, 2.0, 0.0]), 1.4304);
    }
}
