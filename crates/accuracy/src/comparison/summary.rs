//! All metrics of two images.

use super::pair::Pair;
use super::pixel_errors::{
    PixelErrors, Trimmed, luminance_relmse, mean_absolute_error, mean_absolute_percentage_error,
    mean_ratios, symmetric_mean_absolute_percentage_error,
};
use super::squared_error::SquaredError;
use super::tile::TileError;
use super::z_scores::ZScores;
use crate::flip::{FlipMap, HdrFlip, flip_map};

/// Side of the tiles of which the worst is named, in pixels.
const TILE_SIDE: usize = 32;

/// Which part of the pixels the trimmed error leaves out.
const TRIMMED_PART: f64 = 0.001;

/// What values of the images mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DynamicRange {
    /// Radiance, without an upper bound.
    High,
    /// What a screen shows, from 0 to 1: there are no other exposures to look at.
    Low,
}

/// How far an image is from a reference, by all metrics.
///
/// ```
/// use residual_accuracy::comparison::{Comparison, DynamicRange, Image, Pair};
///
/// let reference = vec![[0.5, 0.5, 0.5]; 64 * 64];
/// let test = vec![[0.55, 0.5, 0.5]; 64 * 64];
/// let pair = Pair::new(Image::new(&reference, 64), Image::new(&test, 64))?;
/// let comparison = Comparison::of(&pair, DynamicRange::High);
/// assert!((comparison.mae - 0.05 / 3.0).abs() < 1e-6);
/// assert!((comparison.mean_ratios[0].unwrap() - 1.1).abs() < 1e-6);
/// assert!(comparison.flip.mean() > 0.0);
/// # Ok::<(), residual_accuracy::comparison::PairError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// Mean absolute error, in units of the images.
    pub mae: f64,
    /// Mean squared error, in squared units of the images.
    pub mse: SquaredError,
    /// Relative mean squared error; its root is a typical relative error. Independent of the unit.
    pub relmse: SquaredError,
    /// The same without the worst 0.1 % of the pixels. Never read it alone: see [`PixelErrors::trimmed`].
    pub relmse_trimmed: Trimmed,
    /// Relative mean squared error of luminance.
    pub relmse_luminance: f64,
    /// Mean absolute percentage error, as a part of 1: |test − reference| / √(reference² + ε).
    pub mape: f64,
    /// Symmetric mean absolute percentage error, from 0 to 2: 2·|test − reference| / (|test| + |reference|).
    pub smape: f64,
    /// The test's mean over the reference's for red, green and blue; `None` where the latter is 0.
    pub mean_ratios: [Option<f64>; 3],
    /// The tile of 32 × 32 pixels with the largest relative mean squared error.
    pub worst_tile: TileError,
    /// ꟻLIP at the exposure of the images (0 stops), clipped at 1, as PNGs are; seen from 67 pixels a degree.
    pub flip: FlipMap,
    /// ꟻLIP over all exposures, of images of high dynamic range.
    pub hdr_flip: Option<HdrFlip>,
    /// Differences in units of their noise, where both images come with their standard errors.
    pub z_scores: Option<ZScores>,
}

impl Comparison {
    /// Compares a pair. Nearly all time goes into HDR-ꟻLIP, some ten times that of ꟻLIP.
    pub fn of(pair: &Pair<'_>, range: DynamicRange) -> Self {
        let errors = PixelErrors::of(pair);
        let (reference, test) = (pair.reference().pixels(), pair.test().pixels());
        let [width, _] = pair.size();
        Self {
            mae: mean_absolute_error(pair),
            mse: SquaredError::mse(pair),
            relmse: SquaredError::relmse(pair),
            relmse_trimmed: errors.trimmed(TRIMMED_PART),
            relmse_luminance: luminance_relmse(pair),
            mape: mean_absolute_percentage_error(pair),
            smape: symmetric_mean_absolute_percentage_error(pair),
            mean_ratios: mean_ratios(pair),
            worst_tile: errors.worst_tile(TILE_SIDE),
            flip: flip_map(reference, test, width),
            hdr_flip: match range {
                DynamicRange::High => Some(HdrFlip::of(reference, test, width)),
                DynamicRange::Low => None,
            },
            z_scores: ZScores::of(pair).ok(),
        }
    }
}
