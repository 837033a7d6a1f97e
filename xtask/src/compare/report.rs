//! A comparison for people.

use std::fmt::Write as _;

use residual_accuracy::comparison::{Comparison, FAR, SquaredError, TileError, ZScores};

const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// Below this probability, what a block of pixels differs by is not put down to noise.
const IMPROBABLE: f64 = 1e-3;

/// The metrics as a table, with a line that reads them.
pub(super) fn table(comparison: &Comparison) -> String {
    let mut table = String::new();
    let mut row = |name: &str, value: String, remark: &str| {
        let line = format!("{name:<12} {value:>10}  {remark}");
        writeln!(table, "{}", line.trim_end()).expect("a string takes any text");
    };
    let number = |value: f64| format!("{value:.3e}");
    let percent = |value: f64| format!("{:.3} %", 100.0 * value);
    let squared = |unit: &str, error: &SquaredError| match (
        error.without_reference_noise(),
        error.without_noise(),
    ) {
        (Some(of_truth), None) => format!("{unit}{of_truth:.3e} without the reference's noise"),
        (Some(of_truth), Some(bias)) => {
            format!(
                "{unit}{of_truth:.3e} without the reference's noise, {bias:.3e} without that of both"
            )
        }
        _ => unit.trim_end_matches("; ").to_owned(),
    };
    row("MAE", number(comparison.mae), "in units of the images");
    let mse = squared("in their squares; ", &comparison.mse);
    row("MSE", number(comparison.mse.measured), &mse);
    let relmse = squared("", &comparison.relmse);
    row("relMSE", number(comparison.relmse.measured), &relmse);
    let trimmed = comparison.relmse_trimmed;
    let remark = format!(
        "without the worst 0.1 % of the pixels ({}); not to be read alone",
        trimmed.left_out
    );
    row("  trimmed", number(trimmed.mean), &remark);
    row("  luminance", number(comparison.relmse_luminance), "");
    row(
        "  worst tile",
        number(comparison.worst_tile.relmse),
        &place(&comparison.worst_tile),
    );
    row("MAPE", percent(comparison.mape), "");
    row("SMAPE", percent(comparison.smape), "of at most 200 %");
    let flip = format!("{:.5}", comparison.flip.mean());
    row(
        "FLIP",
        flip,
        "from 0 to 1; at 0 stops, clipped at 1, 67 pixels a degree",
    );
    if let Some(hdr) = &comparison.hdr_flip {
        let exposures = hdr.exposures;
        let remark = format!(
            "from 0 to 1; the largest at {} exposures from {:+.2} to {:+.2} stops",
            exposures.count, exposures.start, exposures.stop
        );
        row("HDR-FLIP", format!("{:.5}", hdr.map.mean()), &remark);
    }
    let ratios = comparison.mean_ratios.map(|ratio| match ratio {
        Some(ratio) => format!("{ratio:.5}"),
        None => "none".to_owned(),
    });
    let [red, green, blue] = &ratios;
    let remark = format!("{green} {blue}  the test's mean over the reference's: red, green, blue");
    row("means", red.clone(), &remark);
    if let Some(z) = &comparison.z_scores {
        let remark = format!(
            "mean square of differences in standard errors (mean {:+.3}; 1 and 0 if only noise differs)",
            z.mean
        );
        row("z", format!("{:.4}", z.mean_square), &remark);
        let remark = format!(
            "of {} numbers beyond ±{FAR}; {:.1} expected of noise{}",
            z.scored + z.contradicting,
            z.scored as f64 * ZScores::expected_far_part(),
            match z.contradicting {
                0 => String::new(),
                count => format!("; {count} differ without noise"),
            }
        );
        row("  beyond", (z.far + z.contradicting).to_string(), &remark);
        if let Some(largest) = z.blocks.largest {
            let remark = format!(
                "mean square over {} blocks of 32 × 32; the largest is {:+.1}, of {} at {},{} (p = {:.2e})",
                z.blocks.scored,
                largest.score,
                CHANNELS[largest.channel],
                largest.tile.x,
                largest.tile.y,
                largest.probability
            );
            row("  blocks", format!("{:.4}", z.blocks.mean_square), &remark);
        }
    }
    writeln!(table, "{}", reading(comparison)).expect("a string takes any text");
    table
}

/// Where a tile is.
pub(super) fn place(worst: &TileError) -> String {
    let tile = worst.tile;
    format!("{} × {} at {},{}", tile.width, tile.height, tile.x, tile.y)
}

/// What the numbers mean, in a line.
fn reading(comparison: &Comparison) -> String {
    let relmse = comparison.relmse.measured;
    if comparison.mse.measured == 0.0 {
        return "→ the images are the same, number for number".to_owned();
    }
    let mut parts = vec![format!(
        "the root of relMSE is {:.2} %: a typical number is off by so much",
        100.0 * relmse.sqrt()
    )];
    let deviations = comparison.mean_ratios.iter().flatten();
    let deviation = deviations
        .map(|ratio| (ratio - 1.0).abs())
        .fold(0.0, f64::max);
    parts.push(format!(
        "means differ by {:.2} % at most",
        100.0 * deviation
    ));
    if comparison.relmse_trimmed.mean < 0.5 * relmse {
        parts.push(format!(
            "{} pixels carry most of the error",
            comparison.relmse_trimmed.left_out
        ));
    }
    if let Some(z) = &comparison.z_scores {
        let block = z.blocks.largest;
        parts.push(match block.filter(|block| block.probability < IMPROBABLE) {
            Some(block) => format!(
                "noise does not explain the difference at {},{}",
                block.tile.x, block.tile.y
            ),
            None if z.contradicting > 0 => {
                "there are differences where neither image has noise".to_owned()
            }
            None => "no block of pixels differs by more than noise explains".to_owned(),
        });
    }
    format!("→ {}", parts.join("; "))
}
