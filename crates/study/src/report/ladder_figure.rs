//! The truth ladder: of each accuracy switch the time that it costs, and what is wrong without it and with it. Open symbols are upper
//! bounds, where nothing was seen.

use super::chart::{Anchor, Drawing, Scale};
use super::numbers;
use crate::configuration::Removes;
use crate::findings::{Findings, Level, Rung};

const WIDTH: f64 = 900.0;
const NAMES: f64 = 190.0;
const BARS: [f64; 2] = [210.0, 430.0];
const LEVELS: [f64; 2] = [500.0, 880.0];
const TOP: f64 = 54.0;
const ROW: f64 = 30.0;

/// The chart.
pub(super) fn figure(findings: &Findings) -> Drawing {
    let rungs = &findings.ladder;
    let bottom = TOP + ROW * rungs.len() as f64;
    let mut drawing = Drawing::new(WIDTH, bottom + 64.0);
    drawing.text([BARS[0], 20.0], Anchor::Start, "title", "Time");
    drawing.text(
        [BARS[0], 38.0],
        Anchor::Start,
        "note",
        "with the switch, beside without",
    );
    drawing.text([LEVELS[0], 20.0], Anchor::Start, "title", "What is wrong");
    let note = "misses per aimed ray, or relative bias";
    drawing.text([LEVELS[0], 38.0], Anchor::Start, "note", note);
    let levels = rungs
        .iter()
        .flat_map(|rung| [shown(rung.without), shown(rung.with)]);
    let scale = Scale::of(levels, LEVELS[0], LEVELS[1]);
    drawing.horizontal(&scale, TOP, bottom);
    let time = TimeScale::of(rungs);
    for tick in time.ticks() {
        let x = time.at(tick);
        drawing.line(
            &[[x, TOP], [x, bottom]],
            if tick == 0.0 { "axis" } else { "grid" },
        );
        let label = format!("{:+} %", (100.0 * tick).round()).replace('-', "−");
        let label = if tick == 0.0 { "0".to_owned() } else { label };
        drawing.text([x, bottom + 16.0], Anchor::Middle, "tick", &label);
    }
    for (index, rung) in rungs.iter().enumerate() {
        let y = TOP + ROW * (index as f64 + 0.5);
        drawing.text([NAMES, y + 4.0], Anchor::End, "", rung.switch.name);
        let [from, to] = [time.at(0.0), time.at(rung.time.median)];
        drawing.bar(
            [from.min(to), y - 7.0],
            [(to - from).abs().max(1.0), 14.0],
            "bar",
        );
        let whisker = rung.time.interval.map(|end| [time.at(end), y]);
        drawing.line(&whisker, "whisker");
        let label = numbers::change(rung.time.median);
        let right = time.at(rung.time.interval[1]).max(to).max(from);
        drawing.text([right + 5.0, y + 4.0], Anchor::Start, "note", &label);
        let ends = [rung.without, rung.with].map(|level| [scale.at(shown(level)), y]);
        drawing.line(&ends, "link");
        level(&mut drawing, ends[0], "without", rung, rung.without);
        level(&mut drawing, ends[1], "with", rung, rung.with);
    }
    let y = bottom + 46.0;
    drawing.circle([LEVELS[0] + 4.0, y - 4.0], 5.0, "without", "without");
    drawing.text([LEVELS[0] + 14.0, y], Anchor::Start, "note", "without");
    drawing.circle([LEVELS[0] + 74.0, y - 4.0], 5.0, "with", "with");
    drawing.text([LEVELS[0] + 84.0, y], Anchor::Start, "note", "with");
    drawing.circle([LEVELS[0] + 124.0, y - 4.0], 5.0, "with open", "bound");
    let note = "open: nothing seen, upper bound of 95 %";
    drawing.text([LEVELS[0] + 134.0, y], Anchor::Start, "note", note);
    drawing
}

/// What is drawn of a level.
fn shown(level: Level) -> f64 {
    match level {
        Level::Seen { value, .. } => value,
        Level::Below(bound) => bound,
    }
}

fn level(drawing: &mut Drawing, place: [f64; 2], class: &str, rung: &Rung, level: Level) {
    let text = match rung.switch.removes {
        Removes::Misses(..) => format!("{} misses per ray", numbers::rate(level)),
        Removes::Bias | Removes::Stagnation => format!("bias {}", numbers::bias(level)),
    };
    let class = match level {
        Level::Seen { .. } => class.to_owned(),
        Level::Below(_) => format!("{class} open"),
    };
    drawing.circle(place, 5.0, &class, &format!("{}: {text}", rung.switch.name));
}

/// A linear scale of changes of time, with 0 on it.
struct TimeScale {
    low: f64,
    high: f64,
}

impl TimeScale {
    fn of(rungs: &[Rung]) -> Self {
        let ends = || rungs.iter().flat_map(|rung| rung.time.interval);
        let high = ends().fold(0.05, f64::max);
        let low = ends().fold(0.0, f64::min);
        Self { low, high }
    }

    /// Room for a label is left at the right end.
    fn at(&self, part: f64) -> f64 {
        let width = BARS[1] - BARS[0];
        BARS[0] + width * (part - self.low) / (self.high - self.low)
    }

    fn ticks(&self) -> Vec<f64> {
        let span = self.high - self.low;
        let power = 10_f64.powf((span / 3.0).log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
        let step = steps
            .into_iter()
            .find(|step| span / step <= 4.0)
            .unwrap_or(span);
        let (first, last) = (
            (self.low / step).ceil() as i32,
            (self.high / step).floor() as i32,
        );
        (first..=last).map(|k| f64::from(k) * step).collect()
    }
}
