//! What a render says of its error, and of what less of it would cost.

use residual_accuracy::{Convergence, Interval};
use serde_json::{Value, json};

/// A relative mean squared error as people read it: its root, in per cent, with three digits.
pub fn percent(relmse: f64) -> String {
    let percent = 100.0 * relmse.max(0.0).sqrt();
    let digits = match percent {
        0.0 => 0,
        _ => (2 - percent.log10().floor() as i32).clamp(0, 9),
    };
    format!("{percent:.*} %", digits as usize)
}

/// The error, the price of half of it, and, if the statement is not to be trusted, why.
pub fn lines(convergence: &Convergence) -> Vec<String> {
    let Some(last) = convergence.last() else {
        return vec!["too few samples to say how large the error is; it takes four".to_owned()];
    };
    let Interval { value, low, high } = last.error.relmse;
    let mut lines = vec![format!(
        "error {} ({} to {} with 95 % confidence), the root of the relative mean squared error {value:.2e}",
        percent(value),
        percent(low),
        percent(high)
    )];
    if let Some(half) = convergence.half() {
        lines.push(format!(
            "half of it: {:.1}× the time, {}, {:.0} samples per pixel",
            half.factor,
            time(half.seconds),
            half.samples
        ));
    }
    if let Some(distrust) = last.error.distrust {
        lines.push(format!("that is untrustworthy: {distrust}"));
    }
    lines
}

fn time(seconds: f64) -> String {
    match seconds {
        ..10.0 => format!("{seconds:.1} s"),
        10.0..120.0 => format!("{seconds:.0} s"),
        120.0..7200.0 => format!("{:.0} min", seconds / 60.0),
        _ => format!("{:.1} h", seconds / 3600.0),
    }
}

/// The same for programs; `null` if there are too few samples.
pub fn json(convergence: &Convergence) -> Value {
    let Some(last) = convergence.last() else {
        return Value::Null;
    };
    let error = &last.error;
    let of = |interval: Interval| json!({ "relmse": interval.value, "interval": [interval.low, interval.high] });
    let slope = convergence.slope();
    json!({
        "relmse": error.relmse.value,
        "interval": [error.relmse.low, error.relmse.high],
        "ci95": 0.5 * (error.relmse.high - error.relmse.low),
        "channels": error.channels.map(of),
        "luminance": of(error.luminance),
        "design_effect": error.design_effect,
        "trustworthy": error.distrust.is_none(),
        "reason": error.distrust.map(|distrust| distrust.to_string()),
        "slope": { "value": slope.value, "interval": [slope.low, slope.high] },
        "half": convergence.half().map(|half| json!({
            "factor": half.factor, "seconds": half.seconds, "spp": half.samples,
        })),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        let expected = [
            (1.0, "100 %"),
            (9.6e-4, "3.10 %"),
            (1e-8, "0.0100 %"),
            (0.0, "0 %"),
        ];
        for (relmse, text) in expected {
            assert_eq!(percent(relmse), text);
        }
        assert_eq!(
            [time(3.13), time(59.6), time(180.0), time(9000.0)],
            ["3.1 s", "60 s", "3 min", "2.5 h"]
        );
    }
}
