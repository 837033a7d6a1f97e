//! Numbers as people read them.

use residual_accuracy::{Interval, Jackknifed};

use crate::findings::Level;

/// With three digits.
pub(super) fn digits(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 || !magnitude.is_finite() {
        return format!("{value}");
    }
    if !(1e-3..1e6).contains(&magnitude) {
        return power(value);
    }
    let digits = (2 - magnitude.log10().floor() as i32).clamp(0, 6);
    format!("{value:.*}", digits as usize).replace('-', "−")
}

/// As 1.2·10⁻⁷.
fn power(value: f64) -> String {
    let text = format!("{value:.1e}");
    let (mantissa, exponent) = text.split_once('e').expect("an exponent was asked for");
    let mantissa = mantissa.replace('-', "−");
    format!("{mantissa}·10{}", superscript(exponent))
}

/// A whole number as an exponent.
pub(super) fn superscript(number: &str) -> String {
    let digits = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let sign = |c| if c == '-' { '⁻' } else { c };
    let digit = |c: char| c.to_digit(10).map_or(sign(c), |d| digits[d as usize]);
    number.chars().map(digit).collect()
}

/// Seconds, minutes or hours.
pub(super) fn time(seconds: f64) -> String {
    match seconds {
        ..1e-3 => format!("{} µs", digits(1e6 * seconds)),
        1e-3..1.0 => format!("{} ms", digits(1e3 * seconds)),
        1.0..180.0 => format!("{} s", digits(seconds)),
        180.0..10_800.0 => format!("{} min", digits(seconds / 60.0)),
        _ => format!("{} h", digits(seconds / 3600.0)),
    }
}

/// A part of 1, in per cent.
pub(super) fn percent(part: f64) -> String {
    format!("{} %", digits(100.0 * part))
}

/// A change in per cent, with its sign.
pub(super) fn change(part: f64) -> String {
    let percent = 100.0 * part;
    if percent.abs() < 5e-4 {
        return "0 %".to_owned();
    }
    let digits = if percent.abs() < 0.1 { 3 } else { 1 };
    format!("{percent:+.digits$} %").replace('-', "−")
}

/// A number with its interval.
pub(super) fn jackknifed(number: Option<Jackknifed>) -> String {
    number.map_or("—".to_owned(), |n| {
        format!("{:.2} ± {:.2}", n.value, n.ci95).replace('-', "−")
    })
}

/// A time with its interval.
pub(super) fn interval(interval: Option<Interval>) -> String {
    match interval {
        None => "never".to_owned(),
        Some(i) if i.high.is_infinite() => {
            format!("{} ({} or more, or never)", time(i.value), time(i.low))
        }
        Some(i) => format!("{} ({} to {})", time(i.value), time(i.low), time(i.high)),
    }
}

/// A bias.
pub(super) fn bias(level: Level) -> String {
    match level {
        Level::Seen { value, interval } => {
            let [low, high] = interval.map(percent);
            format!("{} ({low} to {high})", percent(value))
        }
        Level::Below(bound) => format!("below {}", percent(bound)),
    }
}

/// A rate of failures.
pub(super) fn rate(level: Level) -> String {
    match level {
        Level::Seen { value, interval } => {
            let [low, high] = interval.map(digits);
            format!("{} ({low} to {high})", digits(value))
        }
        Level::Below(bound) => format!("0, below {}", digits(bound)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_and_units() {
        assert_eq!(digits(0.012345), "0.0123");
        assert_eq!(digits(-123.4), "−123");
        assert_eq!(digits(1.25e-7), "1.2·10⁻⁷");
        assert_eq!(
            [time(2e-3), time(61.25), time(7200.0)],
            ["2.00 ms", "61.2 s", "120 min"]
        );
        assert_eq!(
            [change(-0.0123), change(2e-4), change(-1e-6)],
            ["−1.2 %", "+0.020 %", "0 %"]
        );
    }
}
