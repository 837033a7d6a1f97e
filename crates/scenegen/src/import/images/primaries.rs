//! Colours of other primaries as linear Rec. 709, which all colours of a scene are.

use glam::{DMat3, DVec3};

/// CIE xy chromaticities of what red, green and blue alone look like, and all of them together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Primaries {
    pub(super) red: [f64; 2],
    pub(super) green: [f64; 2],
    pub(super) blue: [f64; 2],
    pub(super) white: [f64; 2],
}

/// Rec. ITU-R BT.709, with white D65.
pub(super) const REC_709: Primaries = Primaries {
    red: [0.64, 0.33],
    green: [0.3, 0.6],
    blue: [0.15, 0.06],
    white: [0.3127, 0.329],
};

/// The axes of CIE XYZ, which have no white of their own: files give the middle of them.
const XYZ: [[f64; 2]; 3] = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]];

/// Chromaticities that differ by less are the same in other digits.
const TOLERANCE: f64 = 0.002;

/// Primaries of which one is so nearly between the others give no colours.
const LEAST_DETERMINANT: f64 = 1e-6;

/// The responses of cones by which whites are exchanged (Lam 1985, "Bradford").
const BRADFORD: DMat3 = DMat3::from_cols_array_2d(&[
    [0.8951, -0.7502, 0.0389],
    [0.2664, 1.7135, -0.0685],
    [-0.1614, 0.0367, 1.0296],
]);

impl Primaries {
    /// Whether they are those of Rec. 709.
    pub(super) fn are_rec_709(&self) -> bool {
        self.are_near(&REC_709, TOLERANCE)
    }

    /// Whether all chromaticities differ by less than that.
    pub(super) fn are_near(&self, other: &Self, tolerance: f64) -> bool {
        let mut pairs = self.all().into_iter().zip(other.all());
        pairs.all(|(a, b)| is_near(a, b, tolerance))
    }

    /// From red, green and blue to CIE XYZ, with a Y of 1 for white; `None` for what cannot be primaries.
    fn to_xyz(self) -> Option<DMat3> {
        let direction = |[x, y]: [f64; 2]| DVec3::new(x, y, 1.0 - x - y);
        let directions = DMat3::from_cols(
            direction(self.red),
            direction(self.green),
            direction(self.blue),
        );
        let is_sane = directions.is_finite()
            && directions.determinant().abs() > LEAST_DETERMINANT
            && self.white[1] > 0.0;
        let scales = is_sane.then(|| directions.inverse() * white_xyz(self.white))?;
        let are_positive = scales.is_finite() && scales.min_element() > 0.0;
        are_positive.then(|| directions * DMat3::from_diagonal(scales))
    }

    /// What red, green and blue contribute to luminance, 1 together; `None` for what cannot be primaries.
    pub(super) fn luminance_weights(self) -> Option<[f64; 3]> {
        let luminances = self.to_xyz()?.row(1);
        Some((luminances / luminances.element_sum()).to_array())
    }

    /// The matrix that makes linear Rec. 709 of colours, by which white stays white; `None` for what cannot be
    /// primaries.
    pub(super) fn to_rec_709(self) -> Option<DMat3> {
        let to_xyz = self.to_xyz()?;
        let axes = [self.red, self.green, self.blue];
        let adaptation = match axes
            .into_iter()
            .zip(XYZ)
            .all(|(a, b)| is_near(a, b, TOLERANCE))
        {
            true => DMat3::IDENTITY,
            false => exchange_white(self.white, REC_709.white),
        };
        Some(REC_709.to_xyz()?.inverse() * adaptation * to_xyz)
    }

    /// Makes linear Rec. 709 of the colours of texels. Infinities are `largest` from then on, as matrices make none of them.
    pub(super) fn convert(self, texels: &mut [[f32; 4]], largest: f32) {
        let Some(to_rec_709) = self.to_rec_709() else {
            return;
        };
        for [r, g, b, _] in texels {
            let finite = [*r, *g, *b].map(|value| f64::from(value.clamp(-largest, largest)));
            [*r, *g, *b] = (to_rec_709 * DVec3::from(finite)).as_vec3().to_array();
        }
    }

    fn all(&self) -> [[f64; 2]; 4] {
        [self.red, self.green, self.blue, self.white]
    }
}

fn is_near(a: [f64; 2], b: [f64; 2], tolerance: f64) -> bool {
    (a[0] - b[0]).abs() < tolerance && (a[1] - b[1]).abs() < tolerance
}

fn white_xyz([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x, y, 1.0 - x - y) / y
}

/// From CIE XYZ under one white to what looks the same under another.
fn exchange_white(from: [f64; 2], to: [f64; 2]) -> DMat3 {
    let [from, to] = [from, to].map(|white| BRADFORD * white_xyz(white));
    BRADFORD.inverse() * DMat3::from_diagonal(to / from) * BRADFORD
}

#[cfg(test)]
mod tests {
    use super::*;

    const REC_2020: Primaries = Primaries {
        red: [0.708, 0.292],
        green: [0.17, 0.797],
        blue: [0.131, 0.046],
        white: [0.3127, 0.329],
    };

    /// ACES2065-1.
    const AP0: Primaries = Primaries {
        red: [0.7347, 0.2653],
        green: [0.0, 1.0],
        blue: [0.0001, -0.077],
        white: [0.32168, 0.33767],
    };

    fn check(found: DMat3, rows: [[f64; 3]; 3], tolerance: f64) {
        let expected = DMat3::from_cols_array_2d(&rows).transpose();
        assert!(found.abs_diff_eq(expected, tolerance), "{found} {expected}");
    }

    #[test]
    fn matrices_are_those_of_the_literature() {
        assert!(REC_709.are_rec_709() && !REC_2020.are_rec_709() && !AP0.are_rec_709());
        check(
            REC_709.to_rec_709().unwrap(),
            DMat3::IDENTITY.to_cols_array_2d(),
            1e-12,
        );
        // ITU-R BT.2087 and its inverse.
        let rows = [
            [1.6605, -0.5876, -0.0728],
            [-0.1246, 1.1329, -0.0083],
            [-0.0182, -0.1006, 1.1187],
        ];
        check(REC_2020.to_rec_709().unwrap(), rows, 1e-4);
        // From the ACES transforms, Bradford.
        let rows = [
            [2.5217, -1.1341, -0.3876],
            [-0.2765, 1.3727, -0.0962],
            [-0.0154, -0.1530, 1.1684],
        ];
        check(AP0.to_rec_709().unwrap(), rows, 2e-3);
        // IEC 61966-2-1.
        let xyz = Primaries {
            red: XYZ[0],
            green: XYZ[1],
            blue: XYZ[2],
            white: [1.0 / 3.0; 2],
        };
        let rows = [
            [3.2410, -1.5374, -0.4986],
            [-0.9692, 1.8760, 0.0416],
            [0.0556, -0.2040, 1.0570],
        ];
        check(xyz.to_rec_709().unwrap(), rows, 1e-4);
        for primaries in [REC_709, REC_2020, AP0] {
            let white = primaries.to_rec_709().unwrap() * DVec3::ONE;
            assert!(white.abs_diff_eq(DVec3::ONE, 1e-9), "{white}");
        }
        let weights = REC_709.luminance_weights().unwrap();
        let expected = [0.2126, 0.7152, 0.0722];
        assert!(
            weights
                .iter()
                .zip(expected)
                .all(|(a, b)| (a - b).abs() < 1e-4)
        );
        assert_eq!(xyz.luminance_weights(), Some([0.0, 1.0, 0.0]));
    }

    #[test]
    fn colours_are_converted_and_infinities_stay_bright() {
        let mut texels = [
            [1.0, 1.0, 1.0, 0.5],
            [f32::INFINITY, 0.0, 0.0, 1.0],
            [0.25, 0.5, 0.125, 1.0],
        ];
        REC_2020.convert(&mut texels, 1000.0);
        let [white, bright, color] = texels;
        assert!(white[..3].iter().all(|value| (value - 1.0).abs() < 1e-6) && white[3] == 0.5);
        assert!((bright[0] - 1660.5).abs() < 0.1 && bright[1] < 0.0 && bright[3] == 1.0);
        let expected = [
            1.6605 * 0.25 - 0.5876 * 0.5 - 0.0728 * 0.125,
            -0.1246 * 0.25 + 1.1329 * 0.5 - 0.0083 * 0.125,
            -0.0182 * 0.25 - 0.1006 * 0.5 + 1.1187 * 0.125,
        ];
        assert!(
            color
                .iter()
                .zip(expected)
                .all(|(a, b): (&f32, f32)| (a - b).abs() < 1e-4)
        );
    }

    #[test]
    fn what_cannot_be_primaries_is_none() {
        for primaries in [
            Primaries {
                red: [f64::NAN; 2],
                ..REC_709
            },
            Primaries {
                red: REC_709.green,
                ..REC_709
            },
            Primaries {
                white: [0.0; 2],
                ..REC_709
            },
            Primaries {
                white: [0.3, -0.3],
                ..REC_709
            },
            // Outside of the triangle.
            Primaries {
                white: [0.64, 0.1],
                ..REC_709
            },
            Primaries {
                red: [0.0; 2],
                green: [0.0; 2],
                blue: [0.0; 2],
                white: [0.0; 2],
            },
        ] {
            assert_eq!(primaries.to_rec_709(), None, "{primaries:?}");
            assert_eq!(primaries.luminance_weights(), None);
        }
    }
}
