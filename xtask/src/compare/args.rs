//! Arguments of `cargo xtask compare`.

use std::path::PathBuf;

use clap::Args;

use super::crop::Crop;

/// What is compared, and what of it is shown and allowed.
#[derive(Args)]
pub(crate) struct CompareArgs {
    /// What is taken for the truth (.exr, .hdr, .png)
    pub(crate) reference: PathBuf,
    /// What is compared with it
    pub(crate) test: PathBuf,
    /// One JSON object on standard output
    #[arg(long)]
    pub(crate) json: bool,
    /// Compare this rectangle only
    #[arg(long, value_name = "X,Y,W,H")]
    pub(crate) crop: Option<Crop>,
    #[command(flatten)]
    pub(crate) pictures: PictureArgs,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

/// Pictures, as .png, or as .exr with the numbers themselves.
#[derive(Args)]
#[command(next_help_heading = "Pictures (.png, or .exr with the numbers)")]
pub(crate) struct PictureArgs {
    /// Relative difference of luminance: red where the test is brighter, blue where it is darker
    #[arg(long, value_name = "FILE")]
    pub(crate) difference: Option<PathBuf>,
    /// Absolute difference, the mean of the channels
    #[arg(long, value_name = "FILE")]
    pub(crate) absolute_difference: Option<PathBuf>,
    /// FLIP of each pixel
    #[arg(long, value_name = "FILE")]
    pub(crate) flip_map: Option<PathBuf>,
    /// HDR-FLIP of each pixel
    #[arg(long, value_name = "FILE")]
    pub(crate) hdr_flip_map: Option<PathBuf>,
    /// Difference over its standard error, ±4; both images need standard errors
    #[arg(long, value_name = "FILE")]
    pub(crate) z_map: Option<PathBuf>,
}

/// The largest values that are not an error.
#[derive(Args)]
#[command(next_help_heading = "Limits; above one the exit status is 1")]
pub(crate) struct LimitArgs {
    /// Of the mean absolute error
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_mae: Option<f64>,
    /// Of the mean squared error, noise included
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_mse: Option<f64>,
    /// Of the relative mean squared error, noise included
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_relmse: Option<f64>,
    /// Of the mean absolute percentage error, as a part of 1
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_mape: Option<f64>,
    /// Of the mean FLIP
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_flip: Option<f64>,
    /// Of the mean HDR-FLIP
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_hdr_flip: Option<f64>,
    /// Of the worst tile's relative mean squared error
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_tile_relmse: Option<f64>,
    /// Of the part of numbers that differ by more than 4.9 standard errors; both images need standard errors
    #[arg(long, value_name = "X", value_parser = limit)]
    pub(crate) max_z_fraction: Option<f64>,
}

fn limit(text: &str) -> Result<f64, String> {
    let number: f64 = text
        .parse()
        .map_err(|_| format!("{text:?} is not a number"))?;
    if number.is_finite() && number >= 0.0 {
        Ok(number)
    } else {
        Err("expected a finite number that is not negative".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::limit;

    #[test]
    fn limits_parse() {
        assert_eq!(limit("1e-4"), Ok(1e-4));
        assert_eq!(limit("0"), Ok(0.0));
        for text in ["", "x", "-1", "nan", "inf"] {
            assert!(limit(text).is_err(), "{text}");
        }
    }
}
