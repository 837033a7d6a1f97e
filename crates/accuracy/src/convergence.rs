//! How the error of a render falls as samples are added, and what less of it would cost.

use crate::error_estimate::{ErrorEstimate, Interval};

/// The error after so many samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Samples of a pixel.
    pub samples: u64,
    /// Seconds since the start.
    pub seconds: f64,
    /// The estimate then.
    pub error: ErrorEstimate,
}

/// Estimates on the way of one render, of more and more samples.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Convergence {
    measured: Vec<Measured>,
}

/// What a smaller error costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// Samples of a pixel, in all.
    pub samples: f64,
    /// Seconds, in all.
    pub seconds: f64,
    /// Seconds in all ÷ seconds so far.
    pub factor: f64,
}

/// The first estimate that says something of how the error falls.
const FIRST: u64 = 16;
/// The next is made after so many times its samples: each takes as long as some tenths of a sample of every pixel.
const FACTOR: u64 = 4;
/// The slope is that of so large a part of the samples: it changes on the way.
const RECENT: u64 = 64;
/// How far the slope of other renders is from −1, before anything is known of this one: between independent points and the
/// best of smooth pixels.
const USUAL: f64 = 0.15;

impl Convergence {
    /// Whether the next estimate is due: after four times the samples of the last, or, on the way to a relative mean squared
    /// error, when that may have been reached, and after twice the samples at the latest. Estimates take time, so that few are
    /// made.
    pub fn is_due(&self, samples: u64, target: Option<f64>) -> bool {
        let Some(last) = self.measured.last() else {
            return samples >= FIRST;
        };
        let due = target.map_or(FACTOR * last.samples, |target| {
            // The upper end has to be below the target, and falls as the error does.
            let factor = (last.error.relmse.high / target).powf(-1.0 / self.slope().value);
            let expected = (last.samples as f64 * factor) as u64;
            let soonest = last.samples + last.samples.div_ceil(16);
            expected.clamp(soonest, 2 * last.samples)
        });
        samples >= due
    }

    /// Adds an estimate, of more samples than the last.
    ///
    /// # Panics
    /// If there are not more.
    pub fn add(&mut self, measured: Measured) {
        let last = self.measured.last().map_or(0, |last| last.samples);
        assert!(measured.samples > last, "samples are only added");
        self.measured.push(measured);
    }

    /// All estimates so far.
    pub fn measured(&self) -> &[Measured] {
        &self.measured
    }

    /// The last estimate.
    pub fn last(&self) -> Option<&Measured> {
        self.measured.last()
    }

    /// The power of the number of samples with which the relative mean squared error falls: −1 for independent samples, less for
    /// well-distributed ones.
    ///
    /// It is fitted to the logarithms of recent estimates, and drawn towards −1 as far as these are uncertain.
    pub fn slope(&self) -> Interval {
        let last = self.measured.last().map_or(0, |last| last.samples);
        let recent = self.measured.iter().filter(|measured| {
            measured.samples * RECENT >= last && measured.error.relmse.value > 0.0
        });
        let points: Vec<[f64; 3]> = recent
            .map(|measured| {
                let Interval { value, high, .. } = measured.error.relmse;
                let error = ((high / value).ln() / 1.96).max(1e-3);
                [(measured.samples as f64).ln(), value.ln(), error.powi(-2)]
            })
            .collect();
        let weight: f64 = points.iter().map(|[_, _, w]| w).sum();
        let mean = |of: usize| points.iter().map(|p| p[of] * p[2]).sum::<f64>() / weight;
        let (x, y) = (mean(0), mean(1));
        let spread: f64 = points.iter().map(|p| p[2] * (p[0] - x).powi(2)).sum();
        let usual = USUAL.powi(-2);
        if points.len() < 2 || spread <= 0.0 {
            return interval(-1.0, USUAL);
        }
        let product: f64 = points.iter().map(|p| p[2] * (p[0] - x) * (p[1] - y)).sum();
        // The weighted mean of the fit, whose precision is `spread`, and of what is usual.
        let precision = spread + usual;
        interval((product - usual) / precision, precision.powf(-0.5))
    }

    /// What it takes to get to a relative mean squared error; `None` before the first estimate, or if there is no error.
    pub fn forecast(&self, relmse: f64) -> Option<Forecast> {
        let last = self.measured.last()?;
        let value = last.error.relmse.value;
        if value <= 0.0 {
            return None;
        }
        let samples = last.samples as f64 * (relmse / value).powf(1.0 / self.slope().value);
        // The pace of late: renderers get faster when compiled ones take over.
        let [before, seconds_before] = match self.measured.len() {
            0 | 1 => [0.0; 2],
            count => {
                let before = &self.measured[count - 2];
                [before.samples as f64, before.seconds]
            }
        };
        let pace = (last.seconds - seconds_before) / (last.samples as f64 - before);
        let seconds = last.seconds + (samples - last.samples as f64) * pace;
        Some(Forecast {
            samples,
            seconds,
            factor: seconds / last.seconds,
        })
    }

    /// What it takes to halve the error, which is a quarter of its mean square.
    pub fn half(&self) -> Option<Forecast> {
        self.forecast(0.25 * self.measured.last()?.error.relmse.value)
    }
}

fn interval(value: f64, error: f64) -> Interval {
    Interval {
        value,
        low: value - 1.96 * error,
        high: value + 1.96 * error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn error(relmse: f64, relative: f64) -> ErrorEstimate {
        let relmse = Interval {
            value: relmse,
            low: relmse * (-1.96 * relative).exp(),
            high: relmse * (1.96 * relative).exp(),
        };
        ErrorEstimate {
            relmse,
            channels: [relmse; 3],
            luminance: relmse,
            design_effect: 1.0,
            distrust: None,
        }
    }

    /// A render whose error falls with this power, estimated without noise at powers of two.
    fn render(power: f64, relative: f64) -> Convergence {
        let mut convergence = Convergence::default();
        for samples in [16, 64, 256] {
            assert!(convergence.is_due(samples, None) && !convergence.is_due(samples - 1, None));
            convergence.add(Measured {
                samples,
                seconds: 0.5 * samples as f64,
                error: error((samples as f64).powf(power), relative),
            });
        }
        convergence
    }

    #[test]
    fn the_slope_is_found_and_used() {
        for power in [-1.0, -1.2, -1.5] {
            let render = render(power, 0.01);
            let slope = render.slope();
            assert!((slope.value - power).abs() < 0.01, "{slope:?}");
            assert!(slope.low < power && power < slope.high);
            let half = render.half().unwrap();
            let factor = 4_f64.powf(-1.0 / power);
            assert!(
                (half.factor / factor - 1.0).abs() < 0.02,
                "{half:?}, not {factor}"
            );
            assert!((half.seconds / (128.0 * half.factor) - 1.0).abs() < 1e-12);
            assert!((half.samples / (256.0 * half.factor) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn uncertain_slopes_are_drawn_to_that_of_independent_samples() {
        let slope = render(-1.5, 0.5).slope();
        assert!(-1.2 < slope.value && slope.value < -1.0, "{slope:?}");
        assert_eq!(Convergence::default().slope().value, -1.0);
        assert_eq!(Convergence::default().half(), None);
    }

    #[test]
    fn estimates_are_due_when_a_target_may_be_reached() {
        // Four times the target, falling as 1 / N: after four times the samples, so first after twice.
        let render = render(-1.0, 1e-3);
        let high = render.last().unwrap().error.relmse.high;
        assert!(!render.is_due(511, Some(high / 4.0)) && render.is_due(512, Some(high / 4.0)));
        // A fifth above it.
        assert!(!render.is_due(300, Some(high / 1.2)) && render.is_due(310, Some(high / 1.2)));
    }
}
