//! A comparison as JSON. Numbers that are infinite or do not exist are null.

use residual_accuracy::comparison::{Comparison, SquaredError, ZScores};
use serde_json::{Value, json};

use super::limits::Limit;

/// All metrics, and the limits.
pub(super) fn object(comparison: &Comparison, limits: &[Limit]) -> Value {
    let tile = comparison.worst_tile.tile;
    let hdr_flip = comparison.hdr_flip.as_ref().map(|hdr| {
        json!({
            "mean": hdr.map.mean(),
            "start": hdr.exposures.start,
            "stop": hdr.exposures.stop,
            "exposures": hdr.exposures.count,
        })
    });
    let limit = |limit: &Limit| {
        json!({
            "option": limit.option,
            "value": limit.value,
            "most": limit.most,
            "exceeded": limit.is_exceeded(),
        })
    };
    json!({
        "mae": comparison.mae,
        "mse": squared_error(&comparison.mse),
        "relmse": squared_error(&comparison.relmse),
        "relmse_trimmed": comparison.relmse_trimmed.mean,
        "relmse_trimmed_left_out": comparison.relmse_trimmed.left_out,
        "relmse_luminance": comparison.relmse_luminance,
        "mape": comparison.mape,
        "smape": comparison.smape,
        "mean_ratios": comparison.mean_ratios,
        "worst_tile": {
            "x": tile.x,
            "y": tile.y,
            "width": tile.width,
            "height": tile.height,
            "relmse": comparison.worst_tile.relmse,
        },
        "flip": comparison.flip.mean(),
        "hdr_flip": hdr_flip,
        "z": comparison.z_scores.as_ref().map(z_scores),
        "limits": limits.iter().map(limit).collect::<Vec<_>>(),
    })
}

fn squared_error(error: &SquaredError) -> Value {
    json!({
        "measured": error.measured,
        "reference_noise": error.reference_noise,
        "test_noise": error.test_noise,
        "without_reference_noise": error.without_reference_noise(),
        "without_noise": error.without_noise(),
    })
}

fn z_scores(z: &ZScores) -> Value {
    let histogram: Vec<_> = z
        .histogram()
        .iter()
        .map(|bin| {
            json!({
                "from": bin.from,
                "to": bin.to,
                "counted": bin.counted,
                "expected": bin.expected,
            })
        })
        .collect();
    let largest = z.blocks.largest.map(|largest| {
        json!({
            "x": largest.tile.x,
            "y": largest.tile.y,
            "channel": largest.channel,
            "z": largest.score,
            "probability": largest.probability,
        })
    });
    json!({
        "scored": z.scored,
        "exact": z.exact,
        "contradicting": z.contradicting,
        "mean": z.mean,
        "mean_square": z.mean_square,
        "far": z.far,
        "far_part": z.far_part(),
        "far_part_expected": ZScores::expected_far_part(),
        "histogram": histogram,
        "blocks": {
            "scored": z.blocks.scored,
            "mean_square": z.blocks.mean_square,
            "largest": largest,
        },
    })
}
