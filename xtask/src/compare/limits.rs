//! What a comparison may not exceed.

use residual_accuracy::comparison::{Comparison, ZScores};

use super::args::LimitArgs;

/// A metric with a limit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    /// What it is called.
    pub(super) metric: &'static str,
    /// The option that limits it.
    pub(super) option: &'static str,
    /// What it is.
    pub(super) value: f64,
    /// What it may be.
    pub(super) most: f64,
}

impl Limit {
    pub(super) fn is_exceeded(&self) -> bool {
        self.value > self.most
    }
}

/// The limits that are asked for, of metrics that there are.
pub(super) fn limits(args: &LimitArgs, comparison: &Comparison) -> Vec<Limit> {
    let hdr_flip = comparison.hdr_flip.as_ref().map(|hdr| hdr.map.mean());
    let far_part = comparison.z_scores.as_ref().map(ZScores::far_part);
    let tile = comparison.worst_tile.relmse;
    let rows = [
        ("MAE", "--max-mae", Some(comparison.mae), args.max_mae),
        (
            "MSE",
            "--max-mse",
            Some(comparison.mse.measured),
            args.max_mse,
        ),
        (
            "relMSE",
            "--max-relmse",
            Some(comparison.relmse.measured),
            args.max_relmse,
        ),
        ("MAPE", "--max-mape", Some(comparison.mape), args.max_mape),
        (
            "FLIP",
            "--max-flip",
            Some(comparison.flip.mean()),
            args.max_flip,
        ),
        ("HDR-FLIP", "--max-hdr-flip", hdr_flip, args.max_hdr_flip),
        (
            "relMSE of the worst tile",
            "--max-tile-relmse",
            Some(tile),
            args.max_tile_relmse,
        ),
        (
            "the part of z beyond 4.9",
            "--max-z-fraction",
            far_part,
            args.max_z_fraction,
        ),
    ];
    let limit = |(metric, option, value, most): (_, _, Option<f64>, Option<f64>)| {
        Some(Limit {
            metric,
            option,
            value: value?,
            most: most?,
        })
    };
    rows.into_iter().filter_map(limit).collect()
}
