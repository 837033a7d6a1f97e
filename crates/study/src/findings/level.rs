//! Numbers that may be too small to be seen.

use residual_accuracy::Jackknifed;
use residual_accuracy::sweep::FailureRate;

/// A number that may be too small to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Level {
    /// With its interval.
    Seen {
        /// The number.
        value: f64,
        /// Lower and upper end.
        interval: [f64; 2],
    },
    /// It is below this one.
    Below(f64),
}

impl Level {
    /// The root of a square, which may come out negative.
    pub fn of_square(square: Jackknifed) -> Self {
        let Jackknifed { value, ci95 } = square;
        if value > ci95 {
            Self::Seen {
                value: value.sqrt(),
                interval: [value - ci95, value + ci95].map(f64::sqrt),
            }
        } else {
            Self::Below((value + ci95).max(0.0).sqrt())
        }
    }

    /// A rate of failures.
    pub fn of_rate(rate: FailureRate) -> Self {
        match rate.failures {
            0 => Self::Below(rate.interval()[1]),
            _ => Self::Seen {
                value: rate.rate(),
                interval: rate.interval(),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_certain_is_a_bound() {
        let square = |value, ci95| Level::of_square(Jackknifed { value, ci95 });
        assert_eq!(square(0.0, 0.04), Level::Below(0.2));
        assert_eq!(square(-0.05, 0.04), Level::Below(0.0));
        let Level::Seen { value, interval } = square(0.25, 0.11) else {
            panic!("it is certain")
        };
        assert!(value == 0.5 && (interval[1] - 0.6).abs() < 1e-12);
        let rate = |failures| {
            Level::of_rate(FailureRate {
                failures,
                trials: 1000,
            })
        };
        assert_eq!(rate(0), Level::Below(0.003));
        assert!(matches!(rate(5), Level::Seen { value, .. } if value == 0.005));
    }
}
