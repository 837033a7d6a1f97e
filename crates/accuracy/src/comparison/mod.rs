//! How far an image is from a reference: a [`Comparison`] of a [`Pair`], with each metric under its own name.
//!
//! Means are over pixels and channels unless they say otherwise. *Relative* is relative to √(reference² + ε), where ε is a
//! hundredth of the squared mean of the reference: near black an error counts as at a tenth of the mean. relMSE, MAPE, tiles and
//! the picture of the difference share this scale.
//!
//! Images may come with the standard error of their pixels. Then what noise adds to squared errors is known, and whether the
//! images differ by more than their noise ([`ZScores`]).

mod difference;
mod image;
mod pair;
mod pixel_errors;
mod squared_error;
mod summary;
mod tile;
mod z_scores;

pub use difference::{absolute_difference, relative_luminance_difference, shown_range};
pub use image::Image;
pub use pair::{MissingStandardError, Pair, PairError, Role};
pub use pixel_errors::{PixelErrors, Trimmed};
pub use squared_error::SquaredError;
pub use summary::{Comparison, DynamicRange};
pub use tile::{Tile, TileError};
pub use z_scores::{BIN_WIDTH, Bin, BlockScores, FAR, LargestBlock, ZScores};
