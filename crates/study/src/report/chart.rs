//! What charts are made of: scales, axes, text, lines and points of SVG. Colours are classes, so that a page and a file of its own
//! show them light or dark.

use super::numbers::superscript;

/// Colours and fonts of all charts.
pub(super) const STYLE: &str = include_str!("chart.css");

/// A drawing of some size.
#[derive(Clone, Debug)]
pub(super) struct Drawing {
    pub(super) size: [f64; 2],
    /// SVG elements.
    pub(super) body: String,
}

/// A drawing as a file.
pub(super) fn file(drawing: &Drawing) -> String {
    let [width, height] = drawing.size;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\">\n\
         <style>{STYLE}</style>\n<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>\n{}</svg>\n",
        drawing.body
    )
}

/// A drawing as a part of a page that has the style.
pub(super) fn inline(drawing: &Drawing, label: &str) -> String {
    let [width, height] = drawing.size;
    format!(
        "<svg viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{}\">\n{}</svg>\n",
        escaped(label),
        drawing.body
    )
}

/// Text that may stand between tags and in attributes.
pub(super) fn escaped(text: &str) -> String {
    // What belongs together stays on one line.
    text.replace(" %", "\u{a0}%")
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

/// A logarithmic scale: values from `low` to `high` lie from `from` to `to`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale {
    low: f64,
    high: f64,
    from: f64,
    to: f64,
}

impl Scale {
    /// The scale of these values, of which those above 0 count, with some room at both ends.
    pub(super) fn of(values: impl Iterator<Item = f64>, from: f64, to: f64) -> Self {
        let values = values.filter(|value| *value > 0.0 && value.is_finite());
        let (low, high) = values.fold((f64::MAX, 0.0_f64), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        let (low, high) = if low > high { (0.1, 10.0) } else { (low, high) };
        Self {
            low: low / 1.3,
            high: high * 1.3,
            from,
            to,
        }
    }

    /// Where a value lies; what is beyond an end, at that end.
    pub(super) fn at(&self, value: f64) -> f64 {
        let part = (value / self.low).ln() / (self.high / self.low).ln();
        self.from + (self.to - self.from) * part.clamp(0.0, 1.0)
    }

    /// Whether it is between the ends.
    pub(super) fn has(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value)
    }

    /// Powers of ten between the ends, thinned out to six; 2 and 5 times these where there are few.
    pub(super) fn ticks(&self) -> Vec<f64> {
        let (first, last) = (
            self.low.log10().ceil() as i32,
            self.high.log10().floor() as i32,
        );
        let step = (last - first) / 6 + 1;
        let factors: &[f64] = if last - first < 2 {
            &[1.0, 2.0, 5.0]
        } else {
            &[1.0]
        };
        (first - 1..=last)
            .filter(|power| (power - first) % step == 0)
            .flat_map(|power| factors.iter().map(move |f| f * 10_f64.powi(power)))
            .filter(|value| self.has(*value))
            .collect()
    }
}

/// A tick's label: a plain number where that is short.
pub(super) fn tick_label(value: f64) -> String {
    if (0.009..9_999.0).contains(&value) {
        let text = format!("{value:.2}");
        return text.trim_end_matches('0').trim_end_matches('.').to_owned();
    }
    let power = value.log10().floor();
    let factor = (value / 10_f64.powf(power)).round();
    let factor = if factor == 1.0 {
        String::new()
    } else {
        format!("{factor}·")
    };
    format!("{factor}10{}", superscript(&format!("{power}")))
}

/// How text lies about its place.
#[derive(Clone, Copy, Debug)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Drawing {
    /// An empty one.
    pub(super) fn new(width: f64, height: f64) -> Self {
        Self {
            size: [width, height],
            body: String::new(),
        }
    }

    /// Puts another one into this one.
    pub(super) fn put(&mut self, other: &Self, x: f64, y: f64) {
        self.body.push_str(&format!(
            "<g transform=\"translate({x} {y})\">\n{}</g>\n",
            other.body
        ));
    }

    /// Text with this class.
    pub(super) fn text(&mut self, [x, y]: [f64; 2], anchor: Anchor, class: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        self.body.push_str(&format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" class=\"{class}\">{}</text>\n",
            escaped(text)
        ));
    }

    /// A line through points.
    pub(super) fn line(&mut self, points: &[[f64; 2]], class: &str) {
        let points: Vec<_> = points
            .iter()
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        self.body.push_str(&format!(
            "<polyline points=\"{}\" class=\"{class}\"/>\n",
            points.join(" ")
        ));
    }

    /// A circle, about which a pointer is told something.
    pub(super) fn circle(&mut self, [x, y]: [f64; 2], radius: f64, class: &str, tip: &str) {
        self.body.push_str(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" class=\"{class}\"><title>{}</title></circle>\n",
            escaped(tip)
        ));
    }

    /// A filled rectangle.
    pub(super) fn bar(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], class: &str) {
        self.body.push_str(&format!(
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" class=\"{class}\"/>\n"
        ));
    }

    /// The title of a chart of errors over time, its grid and its axes.
    pub(super) fn frame(&mut self, title: &str, x: &Scale, y: &Scale) {
        let ([left, right], [bottom, top]) = ([x.from, x.to], [y.from, y.to]);
        self.text([left, 20.0], Anchor::Start, "title", title);
        self.horizontal(x, top, bottom);
        self.vertical(y, left, right);
        self.line(&[[left, top], [left, bottom], [right, bottom]], "axis");
        let below = [0.5 * (left + right), bottom + 36.0];
        self.text(below, Anchor::Middle, "note", "CPU seconds");
        let above = [right, 20.0];
        self.text(above, Anchor::End, "note", "relative mean squared error");
    }

    /// Grid lines and labels of a horizontal scale, from `top` to `bottom`.
    pub(super) fn horizontal(&mut self, scale: &Scale, top: f64, bottom: f64) {
        for tick in scale.ticks() {
            let x = scale.at(tick);
            self.line(&[[x, top], [x, bottom]], "grid");
            self.text(
                [x, bottom + 16.0],
                Anchor::Middle,
                "tick",
                &tick_label(tick),
            );
        }
    }

    /// Grid lines and labels of a vertical scale, from `left` to `right`.
    fn vertical(&mut self, scale: &Scale, left: f64, right: f64) {
        for tick in scale.ticks() {
            let y = scale.at(tick);
            self.line(&[[left, y], [right, y]], "grid");
            self.text(
                [left - 6.0, y + 4.0],
                Anchor::End,
                "tick",
                &tick_label(tick),
            );
        }
    }
}

/// Labels that have a place, so that no other is put over them.
#[derive(Clone, Debug, Default)]
pub(super) struct Labels {
    /// Left, top, right and bottom.
    boxes: Vec<[f64; 4]>,
}

/// Width of a letter and height of a line of labels.
const LETTER: [f64; 2] = [6.4, 14.0];

impl Labels {
    /// Whether there is room for text that ends or begins here; if so, it is taken.
    pub(super) fn take(&mut self, [x, y]: [f64; 2], anchor: Anchor, text: &str) -> bool {
        let width = LETTER[0] * text.chars().count() as f64;
        let left = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - 0.5 * width,
            Anchor::End => x - width,
        };
        let new = [left, y - LETTER[1], left + width, y];
        let overlaps =
            |b: &[f64; 4]| new[0] < b[2] && b[0] < new[2] && new[1] < b[3] && b[1] < new[3];
        let free = !self.boxes.iter().any(overlaps);
        if free {
            self.boxes.push(new);
        }
        free
    }
}

/// Moves heights apart that are closer than `distance`, as little as their order allows, and keeps them above `bottom`.
pub(super) fn spread(heights: &[f64], distance: f64, bottom: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..heights.len()).collect();
    order.sort_by(|&a, &b| heights[a].total_cmp(&heights[b]));
    let mut placed = heights.to_vec();
    for pair in order.windows(2) {
        placed[pair[1]] = placed[pair[1]].max(placed[pair[0]] + distance);
    }
    let mut limit = bottom;
    for &index in order.iter().rev() {
        placed[index] = placed[index].min(limit);
        limit = placed[index] - distance;
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_logarithmic() {
        let scale = Scale::of([1.0, 100.0].into_iter(), 0.0, 100.0);
        assert!((scale.at(10.0) - 50.0).abs() < 1e-9);
        assert_eq!(scale.ticks(), [1.0, 10.0, 100.0]);
        let narrow = Scale::of([1.0, 4.0].into_iter(), 0.0, 1.0);
        assert_eq!(narrow.ticks(), [1.0, 2.0, 5.0]);
        assert!(Scale::of([].into_iter(), 0.0, 1.0).at(1.0).is_finite());
    }

    #[test]
    fn labels_are_short() {
        let labels = [0.01, 0.5, 20.0, 1e-4, 2e-7, 1e5].map(tick_label);
        assert_eq!(labels, ["0.01", "0.5", "20", "10⁻⁴", "2·10⁻⁷", "10⁵"]);
    }

    #[test]
    fn labels_do_not_overlap() {
        assert_eq!(spread(&[10.0, 12.0, 50.0], 10.0, 100.0), [10.0, 20.0, 50.0]);
        assert_eq!(spread(&[95.0, 99.0], 10.0, 100.0), [90.0, 100.0]);
    }

    #[test]
    fn labels_take_their_room() {
        let mut labels = Labels::default();
        assert!(labels.take([100.0, 50.0], Anchor::Start, "ten letters"));
        assert!(!labels.take([120.0, 55.0], Anchor::Start, "x"));
        assert!(labels.take([100.0, 50.0], Anchor::End, "before"));
        assert!(labels.take([120.0, 70.0], Anchor::Middle, "below"));
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("a<b & \"c\""), "a&lt;b &amp; &quot;c&quot;");
    }
}
