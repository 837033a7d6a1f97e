//! All configurations after all numbers of samples: those that no other beats in both time and error, and the rest in grey.

use super::chart::{Anchor, Drawing, Labels, Scale};
use super::numbers;
use crate::findings::{Findings, Point};
use residual_frontend::precision::percent;

const SIZE: [f64; 2] = [860.0, 460.0];
const LEFT: f64 = 58.0;
const RIGHT: f64 = 840.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 410.0;

/// The chart.
pub(super) fn figure(findings: &Findings) -> Drawing {
    let mut drawing = Drawing::new(SIZE[0], SIZE[1]);
    let points = &findings.points;
    let x = Scale::of(points.iter().map(|p| p.seconds), LEFT, RIGHT);
    let y = Scale::of(points.iter().map(|p| p.error), BOTTOM, TOP);
    drawing.frame("What no other configuration beats", &x, &y);
    let name = |point: &Point| {
        findings.configurations[point.configuration]
            .configuration
            .name
    };
    let place = |point: &Point| [x.at(point.seconds), y.at(point.error)];
    let tip = |point: &Point| {
        let (time, error) = (numbers::time(point.seconds), percent(point.error));
        format!(
            "{}, {} samples: {time}, error {error}",
            name(point),
            point.samples
        )
    };
    for (index, point) in points.iter().enumerate() {
        if !findings.front.contains(&index) {
            drawing.circle(place(point), 3.2, "dot", &tip(point));
        }
    }
    let front: Vec<&Point> = findings.front.iter().map(|&index| &points[index]).collect();
    let places: Vec<_> = front.iter().map(|point| place(point)).collect();
    drawing.line(&places, "front");
    for point in &front {
        drawing.circle(place(point), 4.2, "best", &tip(point));
    }
    // The knee comes first, then names where the front goes over to another configuration, as far as there is room.
    let mut labels = Labels::default();
    if let Some(index) = findings.knee {
        let point = &points[index];
        drawing.circle(place(point), 8.0, "ring", &tip(point));
        let text = format!("knee: {}, {} samples", name(point), point.samples);
        let at = beside(place(point), &text);
        labels.take(at.0, at.1, &text);
        drawing.text(at.0, at.1, "name", &text);
    }
    if findings.knee.is_none() {
        let note = "no knee: along the front, more time buys as much as before";
        drawing.text([RIGHT - 6.0, TOP + 16.0], Anchor::End, "note", note);
    }
    let mut last = None;
    for (&index, point) in findings.front.iter().zip(&front) {
        let text = format!("{}, {}", name(point), point.samples);
        let (at, anchor) = beside(place(point), &text);
        let is_new = last != Some(point.configuration) && findings.knee != Some(index);
        if is_new && labels.take(at, anchor, &text) {
            drawing.text(at, anchor, "note", &text);
            last = Some(point.configuration);
        }
    }
    drawing
}

/// Above the front on its right side, unless that is beyond the chart.
fn beside([x, y]: [f64; 2], text: &str) -> ([f64; 2], Anchor) {
    let fits = x + 8.0 * text.len() as f64 <= RIGHT;
    let anchor = if fits { Anchor::Start } else { Anchor::End };
    let dx = if fits { 10.0 } else { -10.0 };
    ([x + dx, y - if fits { 6.0 } else { -16.0 }], anchor)
}
