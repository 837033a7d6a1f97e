//! What the topics share: random numbers, statistics, oracles, and scenes made by hand.

pub(crate) mod agreement;
pub(crate) mod alias;
pub(crate) mod bsdfs;
pub(crate) mod irradiance;
pub(crate) mod random;
pub(crate) mod sampling;
pub(crate) mod scenes;
pub(crate) mod stats;

use residual_render::math::Vec3;

/// How many `f32` lie between two numbers; the zeros are one number.
pub(crate) fn ulp_diff(a: f32, b: f32) -> u64 {
    let place = |x: f32| {
        let bits = i64::from(x.to_bits() & 0x7fff_ffff);
        if x.is_sign_negative() { -bits } else { bits }
    };
    place(a).abs_diff(place(b))
}

/// Components as an array.
pub(crate) fn array<F>(v: Vec3<F>) -> [F; 3] {
    [v.x, v.y, v.z]
}

/// Scalar product in `f64`.
pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product in `f64`.
pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        a[i] * b[j] - a[j] * b[i]
    })
}

/// The unit vector of the same direction in `f64`.
pub(crate) fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|c| c / length)
}

/// The largest error that was met, with its place.
#[derive(Debug, Default)]
pub(crate) struct Worst {
    pub(crate) error: f64,
    pub(crate) place: String,
}

impl Worst {
    /// Takes one more error into account; NaN counts as infinite.
    pub(crate) fn add(&mut self, error: f64, place: impl FnOnce() -> String) {
        let error = if error.is_nan() { f64::INFINITY } else { error };
        if error > self.error {
            *self = Self {
                error,
                place: place(),
            };
        }
    }

    /// Panics if the bound does not hold; prints what was measured.
    #[track_caller]
    pub(crate) fn assert_below(&self, bound: f64, what: &str) {
        println!(
            "{what}: {:.3e} at {} (bound {bound:.1e})",
            self.error, self.place
        );
        assert!(
            self.error <= bound,
            "{what}: {:.3e} > {bound:.1e} at {}",
            self.error,
            self.place
        );
    }
}

#[test]
fn ulp_diff_counts() {
    assert_eq!(ulp_diff(1.0, 1.0_f32.next_up()), 1);
    assert_eq!(ulp_diff(0.0, -0.0), 0);
    assert_eq!(ulp_diff(0.0_f32.next_up(), 0.0_f32.next_down()), 2);
}
