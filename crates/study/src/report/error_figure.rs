//! Error against time, a chart for each axis: every run a thin line, the median a thick one, with the slope, and the floor that bias is.

use super::chart::{Anchor, Drawing, Scale, spread};
use super::numbers;
use crate::configuration::Axis;
use crate::findings::{Finding, Findings, Level, ONE_PERCENT};

const SIZE: [f64; 2] = [640.0, 400.0];
const LEFT: f64 = 58.0;
/// Labels stand to the right of it.
const RIGHT: f64 = 496.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 350.0;
/// Colours of lines.
const COLORS: usize = 6;

/// The chart of an axis: its configurations, beside the baseline. `None` if none was measured.
pub(super) fn of_axis(findings: &Findings, axis: Axis) -> Option<Drawing> {
    let (baseline, others) = findings.configurations.split_first()?;
    let mut shown = vec![baseline];
    shown.extend(others.iter().filter(|f| f.configuration.axis == axis));
    (shown.len() > 1).then(|| chart(axis.title(), &shown))
}

/// All charts, one below the other, in two columns.
pub(super) fn all(findings: &Findings) -> Drawing {
    let charts: Vec<_> = Axis::SWITCHED
        .into_iter()
        .filter_map(|axis| of_axis(findings, axis))
        .collect();
    let rows = charts.len().div_ceil(2).max(1);
    let mut drawing = Drawing::new(2.0 * SIZE[0], rows as f64 * SIZE[1]);
    for (index, chart) in charts.iter().enumerate() {
        let (column, row) = ((index % 2) as f64, (index / 2) as f64);
        drawing.put(chart, column * SIZE[0], row * SIZE[1]);
    }
    drawing
}

fn chart(title: &str, shown: &[&Finding]) -> Drawing {
    let mut drawing = Drawing::new(SIZE[0], SIZE[1]);
    let measured = || shown.iter().flat_map(|f| f.series.runs().iter().flatten());
    let x = Scale::of(measured().map(|m| m.seconds), LEFT, RIGHT);
    let y = Scale::of(measured().map(|m| m.error), BOTTOM, TOP);
    drawing.frame(title, &x, &y);
    if y.has(ONE_PERCENT) {
        let height = y.at(ONE_PERCENT);
        drawing.line(&[[LEFT, height], [RIGHT, height]], "mark");
        drawing.text(
            [LEFT + 6.0, height - 4.0],
            Anchor::Start,
            "note",
            "1 % error",
        );
    }
    for (index, finding) in shown.iter().enumerate() {
        let color = index % COLORS;
        // Without the error that is below the noise of the reference.
        for run in finding.series.runs() {
            let above = run.iter().filter(|m| m.error > 0.0);
            let points: Vec<_> = above.map(|m| [x.at(m.seconds), y.at(m.error)]).collect();
            drawing.line(&points, &format!("run s{color}"));
        }
        if y.has(finding.floor) {
            let height = y.at(finding.floor);
            drawing.line(
                &[[LEFT, height], [RIGHT, height]],
                &format!("floor s{color}"),
            );
        }
    }
    let ends: Vec<f64> = shown
        .iter()
        .enumerate()
        .map(|(index, finding)| {
            let levels = finding.series.levels().into_iter();
            let levels = levels.filter(|level| level.error.median > 0.0);
            let points: Vec<_> = levels
                .map(|level| [x.at(level.seconds.median), y.at(level.error.median)])
                .collect();
            drawing.line(&points, &format!("median s{}", index % COLORS));
            points.last().map_or(BOTTOM, |[_, y]| *y)
        })
        .collect();
    let places = spread(&ends, 45.0, BOTTOM - 20.0);
    for ((index, finding), height) in shown.iter().enumerate().zip(places) {
        let color = format!("s{}", index % COLORS);
        let place = |dy: f64| [RIGHT + 10.0, height + dy];
        drawing.text(
            place(0.0),
            Anchor::Start,
            &format!("name {color}"),
            finding.configuration.name,
        );
        let slope = format!("slope {}", numbers::jackknifed(finding.slope));
        drawing.text(place(13.0), Anchor::Start, "note", &slope);
        let bias = match finding.relative_bias() {
            Level::Seen { value, .. } => format!("bias {}", numbers::percent(value)),
            Level::Below(bound) => format!("bias below {}", numbers::percent(bound)),
        };
        drawing.text(place(26.0), Anchor::Start, "note", &bias);
    }
    drawing
}
