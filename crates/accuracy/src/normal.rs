//! The standard normal distribution.

use std::f64::consts::{PI, SQRT_2};

/// Probability that a standard normal variable is farther from 0 than `z`, on either side; relative error below 1e-11.
pub fn two_sided_tail(z: f64) -> f64 {
    complementary_error_function(z.abs() / SQRT_2)
}

/// Probability that a standard normal variable is below `z`.
pub fn normal_cdf(z: f64) -> f64 {
    let tail = 0.5 * two_sided_tail(z);
    if z < 0.0 { tail } else { 1.0 - tail }
}

/// 2/√π ∫ exp(−t²) dt from x ≥ 0 to infinity (Abramowitz and Stegun, 7.1.6 and 7.1.14).
fn complementary_error_function(x: f64) -> f64 {
    const SERIES_BELOW: f64 = 2.5;
    let density = (-x * x).exp() / PI.sqrt();
    if x < SERIES_BELOW {
        // erf x = 2/√π exp(−x²) Σ 2ⁿ x²ⁿ⁺¹ / (1·3···(2n+1)), of positive terms.
        let (mut term, mut sum) = (x, x);
        for n in 1..100 {
            term *= 2.0 * x * x / f64::from(2 * n + 1);
            sum += term;
        }
        return 1.0 - 2.0 * density * sum;
    }
    // The continued fraction, from its end.
    let fraction = (1..=100)
        .rev()
        .fold(x, |fraction, n| x + 0.5 * f64::from(n) / fraction);
    density / fraction
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computed with 30 digits.
    #[test]
    fn tails_are_those_of_the_tables() {
        for (z, expected) in [
            (0.0, 1.0),
            (0.5, 0.617_075_077_451_973_9),
            (1.0, 0.317_310_507_862_914_1),
            (1.959_963_984_540_054, 0.05),
            (3.0, 0.002_699_796_063_260_188),
            (3.5, 4.652_581_580_710_501e-4),
            (3.6, 3.182_171_803_150_678e-4),
            (4.9, 9.583_665_531_806_397e-7),
            (8.0, 1.244_192_114_854_357e-15),
        ] {
            for z in [z, -z] {
                let error = (two_sided_tail(z) / expected - 1.0).abs();
                assert!(error < 1e-11, "{z}: {error:e}");
            }
            assert!((normal_cdf(z) + normal_cdf(-z) - 1.0).abs() < 1e-15);
            assert!((normal_cdf(-z) - 0.5 * expected).abs() < 1e-15);
        }
        assert_eq!(two_sided_tail(f64::INFINITY), 0.0);
    }
}
