//! The jackknife: how certain a number is that was made from several parts, such as the metric of averaged images.

/// A number made from all of some parts, and how far it may be from the number that infinitely many would make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jackknifed {
    /// From all parts.
    pub value: f64,
    /// Half the width of the interval of 95 % confidence; infinite for a single part.
    pub ci95: f64,
}

impl Jackknifed {
    /// `statistic` of the parts that it is told to use, of `parts`: all, and all but each (Quenouille 1949, Tukey 1958).
    pub fn of(parts: usize, statistic: impl Fn(&dyn Fn(usize) -> bool) -> f64) -> Self {
        let value = statistic(&|_| true);
        if parts < 2 {
            return Self {
                value,
                ci95: f64::INFINITY,
            };
        }
        let without: Vec<f64> = (0..parts)
            .map(|left_out| statistic(&|part| part != left_out))
            .collect();
        let count = parts as f64;
        let mean = without.iter().sum::<f64>() / count;
        let squares: f64 = without.iter().map(|value| (value - mean).powi(2)).sum();
        Self {
            value,
            ci95: 1.96 * (squares * (count - 1.0) / count).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_jackknife_of_a_mean_is_its_standard_error() {
        let numbers = [1.0, 4.0, 2.0, 7.0, 6.0];
        let mean = |used: &dyn Fn(usize) -> bool| {
            let used: Vec<f64> = (0..5).filter(|k| used(*k)).map(|k| numbers[k]).collect();
            used.iter().sum::<f64>() / used.len() as f64
        };
        let of = Jackknifed::of(5, mean);
        let variance = numbers.iter().map(|x| (x - 4.0_f64).powi(2)).sum::<f64>() / 4.0;
        assert!((of.value - 4.0).abs() < 1e-12);
        assert!((of.ci95 - 1.96 * (variance / 5.0).sqrt()).abs() < 1e-12);
        assert_eq!(Jackknifed::of(1, |_| 3.0).ci95, f64::INFINITY);
    }
}
