//! The report: one HTML file that needs nothing else, its figures as SVG, its numbers as CSV.

mod chart;
mod crops;
mod csv;
mod error_figure;
mod html;
mod ladder_figure;
mod numbers;
mod pareto_figure;

use std::path::Path;

use anyhow::Result;
use residual_frontend::output::write_atomically;

use crate::findings::{Findings, Study};

/// The files of a report.
pub const FILES: [&str; 6] = [
    "report.html",
    "configurations.csv",
    "measurements.csv",
    "error-against-time.svg",
    "pareto-front.svg",
    "truth-ladder.svg",
];

/// Writes all files into a folder.
///
/// # Errors
/// If one cannot be written.
pub fn write(folder: &Path, study: &Study, findings: &Findings) -> Result<()> {
    let contents = [
        html::report(study, findings)?,
        csv::configurations(findings),
        csv::measurements(findings),
        chart::file(&error_figure::all(findings)),
        chart::file(&pareto_figure::figure(findings)),
        chart::file(&ladder_figure::figure(findings)),
    ];
    for (name, text) in FILES.into_iter().zip(contents) {
        write_atomically(&folder.join(name), text.as_bytes())?;
    }
    Ok(())
}
