//! Luminance and chroma of OpenEXR pictures: RY = (R − Y) / Y, Y and BY = (B − Y) / Y, of which the chroma has usually fewer
//! pixels. Y is the luminance of R, G and B (OpenEXR, "Technical Introduction").

/// Red, green and blue of RY, Y and BY. `weights` are what the three contribute to Y.
pub(super) fn to_rgb([ry, y, by]: [f32; 3], weights: [f64; 3]) -> [f32; 3] {
    let [red, green, blue] = weights;
    let [r, b] = [ry, by].map(|chroma| (f64::from(chroma) + 1.0) * f64::from(y));
    let g = (f64::from(y) - red * r - blue * b) / green;
    [r as f32, g as f32, b as f32]
}

#[cfg(test)]
mod tests {
    use super::super::primaries::REC_709;
    use super::*;

    #[test]
    fn colours_come_back() {
        let weights = REC_709.luminance_weights().unwrap();
        for rgb in [[0.25, 0.5, 1.0], [100.0, 0.0, 3.0], [0.5; 3]] {
            let y: f64 = rgb.iter().zip(weights).map(|(c, weight)| c * weight).sum();
            let encoded = [(rgb[0] - y) / y, y, (rgb[2] - y) / y].map(|value| value as f32);
            let found = to_rgb(encoded, weights);
            let scale = rgb.into_iter().fold(0.0, f64::max);
            assert!(
                found
                    .iter()
                    .zip(rgb)
                    .all(|(&a, b)| (f64::from(a) - b).abs() < 1e-6 * scale),
                "{found:?} {rgb:?}"
            );
        }
        assert_eq!(to_rgb([0.0; 3], weights), [0.0; 3]);
    }
}
