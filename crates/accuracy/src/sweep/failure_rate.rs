//! How often something fails that fails rarely, or has not failed at all.

/// Failures among independent trials.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FailureRate {
    /// Trials that failed.
    pub failures: u64,
    /// All trials, at least one.
    pub trials: u64,
}

impl FailureRate {
    /// Failures per trial.
    pub fn rate(self) -> f64 {
        self.failures as f64 / self.trials as f64
    }

    /// The interval of the rate with 95 % confidence. Without a failure it ends at 3 / trials: were the rate larger, nothing
    /// would have failed with a probability below 5 % (the rule of three; Hanley and Lippman-Hand 1983). Otherwise it is Wilson's (1927).
    ///
    /// ```
    /// use residual_accuracy::sweep::FailureRate;
    ///
    /// let never = FailureRate { failures: 0, trials: 1_000_000 };
    /// assert_eq!(never.interval(), [0.0, 3e-6]);
    /// ```
    pub fn interval(self) -> [f64; 2] {
        const Z: f64 = 1.96;
        let (n, p) = (self.trials as f64, self.rate());
        if self.failures == 0 {
            return [0.0, (3.0 / n).min(1.0)];
        }
        let middle = p + Z * Z / (2.0 * n);
        let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        [middle - half, middle + half].map(|end| end / (1.0 + Z * Z / n))
    }
}

#[cfg(test)]
mod tests {
    use super::FailureRate;

    #[test]
    fn intervals_are_those_of_the_tables() {
        let of = |failures, trials| FailureRate { failures, trials }.interval();
        let close = |found: [f64; 2], expected: [f64; 2]| {
            assert!((found[0] - expected[0]).abs() < 5e-4, "{found:?}");
            assert!((found[1] - expected[1]).abs() < 5e-4, "{found:?}");
        };
        // Newcombe 1998, table I, method 3.
        close(of(81, 263), [0.2553, 0.3662]);
        close(of(15, 148), [0.0624, 0.1605]);
        close(of(1, 29), [0.0061, 0.1718]);
        assert_eq!(of(0, 2), [0.0, 1.0]);
    }
}
