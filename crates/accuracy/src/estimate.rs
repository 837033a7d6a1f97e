//! What a handful of noisy numbers says about the median.

/// A median with its interval of at least 95 % confidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The median.
    pub median: f64,
    /// Lower and upper end. Below six samples no such interval exists, and it is that of all samples.
    pub interval: [f64; 2],
}

impl Estimate {
    /// The median and the interval between two order statistics: the number of samples below the true median is
    /// binomial with p = ½, whatever their distribution (H. A. David, *Order Statistics*, 7.1).
    ///
    /// # Panics
    /// Without samples.
    pub fn of(mut samples: Vec<f64>) -> Estimate {
        assert!(!samples.is_empty());
        samples.sort_by(f64::total_cmp);
        let count = samples.len();
        // The most samples that can be dropped at each end: P(Binomial(count, ½) < dropped) ≤ 2.5 %.
        let mut dropped = 0;
        let mut term = 0.5f64.powi(count as i32);
        let mut tail = term;
        while tail <= 0.025 {
            dropped += 1;
            term *= (count + 1 - dropped) as f64 / dropped as f64;
            tail += term;
        }
        let dropped = dropped.saturating_sub(1).min((count - 1) / 2);
        let middle = count / 2;
        let median = if count % 2 == 1 {
            samples[middle]
        } else {
            0.5 * (samples[middle - 1] + samples[middle])
        };
        Estimate {
            median,
            interval: [samples[dropped], samples[count - 1 - dropped]],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Estimate;

    #[test]
    fn intervals_are_those_of_the_tables() {
        let of = |count: usize| Estimate::of((1..=count).rev().map(|x| x as f64).collect());
        assert_eq!(of(1).interval, [1.0, 1.0]);
        assert_eq!(of(5).interval, [1.0, 5.0]);
        assert_eq!(of(6).interval, [1.0, 6.0]);
        assert_eq!(of(9).interval, [2.0, 8.0]);
        assert_eq!(of(11).interval, [2.0, 10.0]);
        assert_eq!(of(20).interval, [6.0, 15.0]);
        assert_eq!(of(11).median, 6.0);
        assert_eq!(of(20).median, 10.5);
    }
}
