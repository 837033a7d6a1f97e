//! How a mean squared error falls, and where it stops: b² + v·x^−β.

/// The error after x, which may be samples or seconds: noise that falls with a power of x, and what no amount of x removes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorCurve {
    /// b², the squared bias.
    pub floor: f64,
    /// v, the noise at x = 1.
    pub scale: f64,
    /// −β: −1 for independent samples.
    pub power: f64,
}

/// The powers among which [`ErrorCurve::fit`] looks, and their distance.
const POWERS: [f64; 3] = [-3.0, -0.2, 0.005];

impl ErrorCurve {
    /// The curve through points (x, error) whose floor is known: least squares of the logarithms of what is above the floor.
    /// `None` if fewer than two points are above it.
    pub fn with_floor(points: &[[f64; 2]], floor: f64) -> Option<Self> {
        let logarithms: Vec<[f64; 2]> = points
            .iter()
            .filter(|[x, error]| *x > 0.0 && *error > floor)
            .map(|[x, error]| [x.ln(), (error - floor).ln()])
            .collect();
        let count = logarithms.len() as f64;
        let mean = |k: usize| logarithms.iter().map(|point| point[k]).sum::<f64>() / count;
        let [x, y] = [mean(0), mean(1)];
        let moment = |k: usize| -> f64 {
            let terms = logarithms.iter().map(|p| (p[0] - x) * (p[k] - [x, y][k]));
            terms.sum()
        };
        let spread = moment(0);
        (spread > 0.0).then(|| {
            let power = moment(1) / spread;
            Self {
                floor,
                scale: (y - power * x).exp(),
                power,
            }
        })
    }

    /// The curve through points (x, error), with whatever floor fits best: least squares of relative errors, with b² and v not
    /// below 0. The bias is well determined only if the last points are close to it; where images are at hand,
    /// [`squared_bias`](super::squared_bias()) says more. `None` below three points, or if an error is not above 0.
    ///
    /// ```
    /// use residual_accuracy::sweep::ErrorCurve;
    ///
    /// let points = [1.0, 4.0, 16.0, 64.0].map(|n: f64| [n, 0.02 + 1.5 / n]);
    /// let curve = ErrorCurve::fit(&points).unwrap();
    /// assert!((curve.floor - 0.02).abs() < 1e-4 && (curve.power + 1.0).abs() < 0.01);
    /// ```
    pub fn fit(points: &[[f64; 2]]) -> Option<Self> {
        if points.len() < 3 || points.iter().any(|[x, error]| *x <= 0.0 || *error <= 0.0) {
            return None;
        }
        let [first, last, step] = POWERS;
        let count = ((last - first) / step).round() as usize;
        let candidates = (0..=count).map(|k| linear(points, first + step * k as f64));
        candidates
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(curve, _)| curve)
    }

    /// The error at x.
    pub fn at(&self, x: f64) -> f64 {
        self.floor + self.scale * x.powf(self.power)
    }

    /// Where it is `error`; `None` if that is not above the floor, or the error does not fall.
    pub fn reaches(&self, error: f64) -> Option<f64> {
        let noise = error - self.floor;
        (noise > 0.0 && self.power < 0.0).then(|| (noise / self.scale).powf(1.0 / self.power))
    }
}

/// The best floor and scale for a power, with the sum of squared relative errors.
fn linear(points: &[[f64; 2]], power: f64) -> (ErrorCurve, f64) {
    // Minimises Σ (1 − b²/y − v·x^p/y)².
    let rows: Vec<[f64; 2]> = points
        .iter()
        .map(|[x, y]| [1.0 / y, x.powf(power) / y])
        .collect();
    let sum = |of: &dyn Fn(&[f64; 2]) -> f64| rows.iter().map(of).sum::<f64>();
    let [aa, ab, bb] = [
        sum(&|r| r[0] * r[0]),
        sum(&|r| r[0] * r[1]),
        sum(&|r| r[1] * r[1]),
    ];
    let [a, b] = [sum(&|r| r[0]), sum(&|r| r[1])];
    let determinant = aa * bb - ab * ab;
    let both = [
        (bb * a - ab * b) / determinant,
        (aa * b - ab * a) / determinant,
    ];
    let [floor, scale] = match both {
        [floor, scale] if floor >= 0.0 && scale >= 0.0 => [floor, scale],
        [_, scale] if scale < 0.0 => [a / aa, 0.0],
        _ => [0.0, b / bb],
    };
    let residual = sum(&|r| (1.0 - floor * r[0] - scale * r[1]).powi(2));
    let curve = ErrorCurve {
        floor,
        scale,
        power,
    };
    (curve, residual)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(floor: f64, scale: f64, power: f64) -> Vec<[f64; 2]> {
        let curve = ErrorCurve {
            floor,
            scale,
            power,
        };
        (0..10)
            .map(|k| f64::from(1 << k))
            .map(|x| [x, curve.at(x)])
            .collect()
    }

    #[test]
    fn curves_are_found_again() {
        for (floor, scale, power) in [(0.0, 2.0, -1.0), (1e-3, 0.5, -1.4), (0.3, 1.0, -0.7)] {
            let points = points(floor, scale, power);
            let known = ErrorCurve::with_floor(&points, floor).unwrap();
            assert!((known.power - power).abs() < 1e-9 && (known.scale / scale - 1.0).abs() < 1e-9);
            let fit = ErrorCurve::fit(&points).unwrap();
            assert!((fit.power - power).abs() < 0.006, "{fit:?}");
            assert!((fit.floor - floor).abs() < 0.02 * points[9][1], "{fit:?}");
        }
    }

    #[test]
    fn a_floor_is_never_negative() {
        // Noise that falls ever faster looks like a floor below 0 to a fixed power.
        let steep: Vec<_> = [1.0, 2.0, 4.0, 8.0_f64]
            .map(|x| [x, x.powi(-3) * (-x).exp()])
            .to_vec();
        assert_eq!(ErrorCurve::fit(&steep).unwrap().floor, 0.0);
    }

    #[test]
    fn what_is_below_the_floor_is_never_reached() {
        let curve = ErrorCurve::with_floor(&points(0.1, 1.0, -1.0), 0.1).unwrap();
        assert_eq!(curve.reaches(0.1), None);
        assert!((curve.reaches(0.2).unwrap() - 10.0).abs() < 1e-9);
        assert_eq!(
            ErrorCurve::with_floor(&[[1.0, 0.5], [2.0, 0.05]], 0.1),
            None
        );
        assert_eq!(ErrorCurve::fit(&[[1.0, 1.0], [2.0, 0.5]]), None);
    }
}
