//! Wavelengths as colours.

use super::elementary::exp2;
use super::vec3::vec3;
use super::{Color, Vec3};
use crate::domain::Domain;

/// The wavelengths that are sampled, in nanometres.
const VISIBLE: [f64; 2] = [400.0, 700.0];

/// The wavelength of the sodium d line, of which indices of refraction are given, in nanometres.
pub const D_LINE: f64 = 587.56;

/// The colour matching functions of the CIE 1931 observer as sums of Gaussians of two half-widths (Wyman, Sloan and Shirley
/// 2013, "Simple analytic approximations to the CIE XYZ color matching functions"): weight, mean, and inverse widths below and
/// above the mean, in nanometres.
const X: [[f64; 4]; 3] = [
    [1.056, 599.8, 0.0264, 0.0323],
    [0.362, 442.0, 0.0624, 0.0374],
    [-0.065, 501.1, 0.0490, 0.0382],
];
const Y: [[f64; 4]; 2] = [
    [0.821, 568.8, 0.0213, 0.0247],
    [0.286, 530.9, 0.0613, 0.0322],
];
const Z: [[f64; 4]; 2] = [
    [1.217, 437.0, 0.0845, 0.0278],
    [0.681, 459.0, 0.0385, 0.0725],
];

/// From XYZ to linear Rec. 709, by rows.
const RGB_OF_XYZ: [[f64; 3]; 3] = [
    [3.240_454_2, -1.537_138_5, -0.498_531_4],
    [-0.969_266, 1.876_010_8, 0.041_556],
    [0.055_643_4, -0.204_025_9, 1.057_225_2],
];
/// The inverse of the mean of each channel over the visible wavelengths, where negative values count as 0. A test computes the
/// means again.
const WHITE: [f64; 3] = [1.705113, 2.599648, 2.757881];

/// The wavelength that a random number in [0, 1) chooses, in nanometres; all are equally likely.
#[inline(always)]
pub fn wavelength_at<D: Domain>(d: D, u: D::F) -> D::F {
    let [shortest, longest] = VISIBLE;
    d.fma(u, d.lit(longest - shortest), d.lit(shortest))
}

/// The colour of light of one wavelength, in nanometres. The mean over the visible wavelengths is white, (1, 1, 1). Colours
/// that no display can show are clipped to those that it can.
#[inline(always)]
pub fn color_of<D: Domain>(d: D, wavelength: D::F) -> Color<D::F> {
    let xyz = vec3(
        sum(d, wavelength, &X),
        sum(d, wavelength, &Y),
        sum(d, wavelength, &Z),
    );
    let [r, g, b] = WHITE;
    let white = vec3(d.lit(r), d.lit(g), d.lit(b));
    rgb_of_xyz(d, xyz).map(|c| d.max(c, d.lit(0.0))) * white
}

/// A colour in CIE XYZ as linear Rec. 709; negative where no display can show it.
#[inline(always)]
pub fn rgb_of_xyz<D: Domain>(d: D, xyz: Vec3<D::F>) -> Color<D::F> {
    let [r, g, b] = RGB_OF_XYZ.map(|row| {
        let [x, y, z] = row.map(|value| d.lit(value));
        d.fma(x, xyz.x, d.fma(y, xyz.y, z * xyz.z))
    });
    vec3(r, g, b)
}

#[inline(always)]
fn sum<D: Domain, const N: usize>(d: D, wavelength: D::F, lobes: &[[f64; 4]; N]) -> D::F {
    let mut sum = d.lit(0.0);
    for [weight, mean, below, above] in lobes {
        let away = wavelength - d.lit(*mean);
        let inverse = d.select(d.lt(away, d.lit(0.0)), d.lit(*below), d.lit(*above));
        let t = away * inverse;
        let bell = exp2(d, t * t * d.lit(-0.5 * std::f64::consts::LOG2_E));
        sum = d.fma(bell, d.lit(*weight), sum);
    }
    sum
}
