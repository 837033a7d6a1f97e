//! Statistical judgement: goodness of fit, means, and families of tests.

use statrs::distribution::{ChiSquared, ContinuousCDF, Normal};

use super::random::Rng;

/// The level at which a whole family of tests may fail by chance.
const FAMILY_LEVEL: f64 = 0.01;

/// Pearson's χ² of counts against expectations; neighbouring cells are pooled until 5 are expected in each.
/// The p-value. The last pool takes what is left. Counts where nothing is expected are a failure: 0.
pub(crate) fn chi_squared(observed: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(observed.len(), expected.len());
    let mut cells: Vec<(f64, f64)> = Vec::new();
    let mut pool = (0.0, 0.0);
    for (&o, &e) in observed.iter().zip(expected) {
        if e <= 0.0 && o > 0.0 {
            return 0.0;
        }
        pool = (pool.0 + o, pool.1 + e);
        if pool.1 >= 5.0 {
            cells.push(std::mem::take(&mut pool));
        }
    }
    if let Some(last) = cells.last_mut() {
        *last = (last.0 + pool.0, last.1 + pool.1);
    }
    if cells.len() < 2 {
        return 1.0;
    }
    let statistic: f64 = cells.iter().map(|(o, e)| (o - e) * (o - e) / e).sum();
    let freedom = ChiSquared::new(cells.len() as f64 - 1.0).expect("positive");
    freedom.sf(statistic)
}

/// A family of p-values that is judged as a whole.
#[derive(Debug, Default)]
pub(crate) struct Family(Vec<(f64, String)>);

impl Family {
    pub(crate) fn add(&mut self, p: f64, name: impl Into<String>) {
        self.0.push((p, name.into()));
    }

    /// Adds the two-sided p-value of a standard normal deviate.
    pub(crate) fn add_z(&mut self, z: f64, name: impl Into<String>) {
        let normal = Normal::standard();
        self.add(
            if z.is_finite() {
                2.0 * normal.sf(z.abs())
            } else {
                0.0
            },
            name,
        );
    }

    fn level(&self) -> f64 {
        1.0 - (1.0 - FAMILY_LEVEL).powf(1.0 / self.0.len() as f64)
    }

    /// Panics if any member is below the Šidák-corrected level.
    #[track_caller]
    pub(crate) fn assert_plausible(&self) {
        assert!(!self.0.is_empty());
        let level = self.level();
        let mut failed: Vec<_> = self
            .0
            .iter()
            .filter(|(p, _)| p.is_nan() || *p < level)
            .collect();
        failed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let count = failed.len();
        failed.truncate(12);
        let all = self.0.len();
        assert!(
            count == 0,
            "{count} of {all} below {level:.2e}, first {failed:#?}"
        );
    }

    /// Whether some member is below the corrected level.
    pub(crate) fn rejects(&self) -> bool {
        self.0.iter().any(|(p, _)| *p < self.level())
    }
}

/// Running mean and variance (Welford 1962).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Mean {
    count: f64,
    mean: f64,
    deviations: f64,
}

impl Mean {
    pub(crate) fn add(&mut self, x: f64) {
        self.count += 1.0;
        let delta = x - self.mean;
        self.mean += delta / self.count;
        self.deviations += delta * (x - self.mean);
    }

    pub(crate) fn value(&self) -> f64 {
        self.mean
    }

    /// Variance of what was added.
    pub(crate) fn variance(&self) -> f64 {
        self.deviations / (self.count - 1.0)
    }

    /// Standard error of the mean.
    pub(crate) fn error(&self) -> f64 {
        (self.deviations / (self.count - 1.0) / self.count).sqrt()
    }

    /// Standard errors between the mean and what is expected. Rounding of `f32` formulas is not an error of the
    /// mean: `tolerance`, relative to `expected`, is added in quadrature.
    pub(crate) fn z(&self, expected: f64, tolerance: f64) -> f64 {
        let error = self.error().hypot(expected * tolerance);
        let difference = self.mean - expected;
        if difference == 0.0 {
            0.0
        } else {
            difference / error
        }
    }
}

#[test]
fn chi_squared_accepts_what_is_right_and_rejects_what_is_not() {
    let expected: Vec<f64> = (0..64)
        .map(|k| 200.0 + 50.0 * (f64::from(k) * 0.3).sin())
        .collect();
    let total: f64 = expected.iter().sum();
    let draw = |weights: &[f64], rng: &mut Rng| {
        let sum: f64 = weights.iter().sum();
        let mut counts = vec![0.0; weights.len()];
        for _ in 0..total as usize {
            let mut u = rng.range(0.0, sum);
            let cell = weights.iter().position(|w| {
                u -= w;
                u < 0.0
            });
            counts[cell.unwrap_or(weights.len() - 1)] += 1.0;
        }
        counts
    };
    let mut family = Family::default();
    let mut rng = Rng::new(1);
    for run in 0..50 {
        family.add(
            chi_squared(&draw(&expected, &mut rng), &expected),
            format!("run {run}"),
        );
    }
    family.assert_plausible();
    // A fifth more in a quarter of the cells is found.
    let wrong: Vec<f64> = expected
        .iter()
        .enumerate()
        .map(|(k, e)| if k < 16 { e * 1.2 } else { *e })
        .collect();
    assert!(chi_squared(&draw(&wrong, &mut rng), &expected) < 1e-4);
    // Counts where nothing may be are a failure.
    assert_eq!(chi_squared(&[10.0, 1.0, 10.0], &[10.0, 0.0, 10.0]), 0.0);
}

#[test]
fn families_reject_one_bad_member() {
    let mut family = Family::default();
    for k in 0..99 {
        family.add(0.005 + f64::from(k) * 0.01, "fair");
    }
    family.assert_plausible();
    family.add_z(5.0, "foul");
    assert!(family.rejects());
}

#[test]
fn means_find_a_bias() {
    let mut rng = Rng::new(2);
    let mut mean = Mean::default();
    for _ in 0..100_000 {
        mean.add(rng.range(0.0, 1.0));
    }
    assert!(mean.z(0.5, 0.0).abs() < 4.5 && mean.z(0.505, 0.0).abs() > 4.5);
}
