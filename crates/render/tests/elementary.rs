//! Elementary functions against `f64`, over dense and edge inputs: the bounds that `math::elementary` documents.

use residual_render::domain::{Buffers, Scalar};
use residual_render::math::elementary::{atan2, exp2, log2, pow, sincos_turns};
use residual_render::math::warp;

use crate::support::Worst;
use crate::support::random::Rng;

fn scalar() -> Scalar<'static> {
    static NOTHING: Buffers<'static> = Buffers::EMPTY;
    Scalar::new(&NOTHING)
}

/// Every `stride`-th `f32` from `low` to `high`, both positive, and both ends.
fn floats(low: f32, high: f32, stride: usize) -> impl Iterator<Item = f32> {
    let bits = (low.to_bits()..=high.to_bits())
        .step_by(stride)
        .map(f32::from_bits);
    bits.chain([low, high])
}

#[test]
fn sincos_turns_keeps_its_bound() {
    let d = scalar();
    let mut worst = Worst::default();
    let mut check = |u: f32| {
        let (sin, cos) = sincos_turns(d, u);
        // Reduced exactly, so that the oracle is better than f64's own rounding of 2πu.
        let (s, c) = (f64::from(u).fract() * std::f64::consts::TAU).sin_cos();
        let error = (f64::from(sin) - s).abs().max((f64::from(cos) - c).abs());
        worst.add(error, || format!("{u:e}"));
    };
    for u in floats(1e-30, 4.0, 311) {
        check(u);
        check(-u);
    }
    for k in 0..=64 {
        let u = k as f32 / 16.0;
        [u, u.next_up(), u.next_down(), -u]
            .into_iter()
            .for_each(&mut check);
    }
    [0.0, -0.0, 1.0 - 1.0 / 16_777_216.0]
        .into_iter()
        .for_each(&mut check);
    worst.assert_below(1.5e-7, "sincos_turns, absolute");
}

#[test]
fn sincos_turns_is_exact_at_quarters() {
    let d = scalar();
    for k in 0..16 {
        let (sin, cos) = sincos_turns(d, k as f32 * 0.25);
        let exact = [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][k % 4];
        assert_eq!((sin, cos), exact, "quarter {k}");
    }
}

#[test]
fn atan2_keeps_its_bound() {
    let d = scalar();
    let mut worst = Worst::default();
    let mut check = |y: f32, x: f32| {
        let exact = f64::from(y).atan2(f64::from(x));
        worst.add((f64::from(atan2(d, y, x)) - exact).abs(), || {
            format!("({y:e}, {x:e})")
        });
    };
    let mut rng = Rng::new(10);
    for _ in 0..2_000_000 {
        check(rng.signed_power(-20.0, 20.0), rng.signed_power(-20.0, 20.0));
        let [x, y, _] = rng.direction();
        check(y as f32, x as f32);
    }
    for x in [1.0, -1.0, 1e-30, -1e30, 0.0, 3e38, -3e38] {
        for y in [1.0, -1.0, 1e-30, 1e30, 0.414_213_57, 3e38] {
            check(y, x);
        }
    }
    worst.assert_below(4e-7, "atan2, absolute");
    assert_eq!(atan2(d, 0.0, 0.0), 0.0);
    assert_eq!(atan2(d, 0.0, -1.0), std::f32::consts::PI);
}

#[test]
fn exp2_keeps_its_bound() {
    let d = scalar();
    let mut worst = Worst::default();
    let mut check = |x: f32| {
        let exact = f64::from(x.clamp(-126.0, 127.0)).exp2();
        worst.add((f64::from(exp2(d, x)) / exact - 1.0).abs(), || {
            format!("{x:e}")
        });
    };
    for x in floats(1e-10, 127.0, 131) {
        check(x);
        check(-x);
    }
    for x in -127..=128 {
        let x = x as f32;
        [x, x + 0.5, (x + 0.5).next_down(), x.next_down()]
            .into_iter()
            .for_each(&mut check);
    }
    worst.assert_below(2e-7, "exp2, relative");
    assert_eq!(
        (exp2(d, 1e30), exp2(d, -1e30)),
        (2.0_f32.powi(127), f32::MIN_POSITIVE)
    );
}

#[test]
fn log2_keeps_its_bound() {
    let d = scalar();
    let mut worst = Worst::default();
    let mut check = |x: f32| {
        let exact = f64::from(x).log2();
        let error = (f64::from(log2(d, x)) - exact).abs();
        worst.add(error / exact.abs().max(1.0), || format!("{x:e}"));
    };
    for x in floats(f32::MIN_POSITIVE, f32::MAX, 997).chain(floats(0.25, 4.0, 13)) {
        check(x);
    }
    worst.assert_below(2e-7, "log2, absolute below 1, relative above");
    for k in -126..=127 {
        assert_eq!(log2(d, 2.0_f32.powi(k)), k as f32);
    }
}

#[test]
fn pow_keeps_its_bound() {
    let d = scalar();
    let mut worst = Worst::default();
    let mut rng = Rng::new(11);
    for _ in 0..4_000_000 {
        let x = if rng.word() & 1 == 0 {
            rng.unit()
        } else {
            rng.signed_power(-60.0, 60.0).abs()
        };
        let y = rng.signed_power(-8.0, 12.0);
        let logarithm = f64::from(y) * f64::from(x).log2();
        if x < f32::MIN_POSITIVE || logarithm.abs() > 125.0 {
            continue;
        }
        let error = f64::from(pow(d, x, y)) / logarithm.exp2() - 1.0;
        worst.add(error.abs() / (1.0 + logarithm.abs()), || {
            format!("{x:e}^{y:e}")
        });
    }
    worst.assert_below(3e-7, "pow, relative ÷ (1 + |y·log₂ x|)");
    assert_eq!(
        (pow(d, 0.0, 3.0), pow(d, f32::MIN_POSITIVE / 2.0, 0.5)),
        (0.0, 0.0)
    );
    assert_eq!(
        (pow(d, 1.0, 1e9), pow(d, 0.5, 1e9)),
        (1.0, f32::MIN_POSITIVE)
    );
}

/// Numbers at the ends of what samplers give, and some between (hard case S-07).
fn edge_numbers() -> Vec<f32> {
    let step = 1.0 / 16_777_216.0;
    let mut numbers = vec![
        0.0,
        step,
        2.0 * step,
        0.25,
        0.5 - step,
        0.5,
        0.5 + step,
        0.75,
    ];
    numbers.extend([1.0 - 2.0 * step, 1.0 - step]);
    let mut rng = Rng::new(12);
    numbers.extend((0..300).map(|_| rng.unit()));
    numbers
}

#[test]
fn triangle_warp_stays_inside() {
    let d = scalar();
    for u in edge_numbers() {
        for v in edge_numbers() {
            let (b1, b2) = warp::triangle(d, [u, v]);
            assert!(
                b1 >= 0.0 && b2 >= 0.0 && b1 + b2 <= 1.0,
                "({u}, {v}) → ({b1}, {b2})"
            );
        }
    }
}

#[test]
fn triangle_warp_is_uniform() {
    let d = scalar();
    let mut rng = Rng::new(13);
    let mut counts = vec![0.0; 100];
    let n = 200_000;
    for _ in 0..n {
        let (b1, b2) = warp::triangle(d, [rng.unit(), rng.unit()]);
        // ((1 − b₁)², b₂ ÷ (1 − b₁)) is uniform on the square where (b₁, b₂) is on the triangle.
        let across = f64::from(1.0 - b1).powi(2);
        let along = f64::from(b2 / (1.0 - b1));
        counts[((across * 10.0) as usize).min(9) * 10 + ((along * 10.0) as usize).min(9)] += 1.0;
    }
    let expected = vec![f64::from(n) / 100.0; 100];
    assert!(crate::support::stats::chi_squared(&counts, &expected) > 0.01);
}

#[test]
fn cosine_warp_stays_on_the_hemisphere() {
    let d = scalar();
    let mut worst = Worst::default();
    for u in edge_numbers() {
        for v in edge_numbers() {
            let w = warp::cosine_hemisphere(d, [u, v]);
            assert!(w.z > 0.0, "({u}, {v}) → {w:?}");
            worst.add((f64::from(w.dot(d, w)) - 1.0).abs(), || {
                format!("({u}, {v})")
            });
            assert!(warp::cosine_hemisphere_pdf(d, w.z) > 0.0);
        }
    }
    worst.assert_below(
        8.0 * f64::from(f32::EPSILON) / 2.0,
        "cosine_hemisphere, |length² − 1|",
    );
}
