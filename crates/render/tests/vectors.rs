//! Vectors and frames (hard case S-12).

use residual_render::domain::{Buffers, Scalar};
use residual_render::math::vec3::vec3;
use residual_render::math::{Frame, Vec3};

use crate::support::random::Rng;
use crate::support::{Worst, array, cross, dot, ulp_diff};

static NOTHING: Buffers<'static> = Buffers::EMPTY;

fn length(v: Vec3<f32>) -> f64 {
    let v = array(v).map(f64::from);
    dot(v, v).sqrt()
}

#[test]
fn normalize_any_gives_unit_vectors() {
    let d = Scalar::new(&NOTHING);
    let mut worst = Worst::default();
    let mut direction = Worst::default();
    let mut rng = Rng::new(20);
    for _ in 0..1_000_000 {
        let (low, high) = [(-126.0, -120.0), (-60.0, 60.0), (120.0, 127.9), (-3.0, 3.0)]
            [(rng.word() & 3) as usize];
        let v = [0, 1, 2].map(|_| rng.signed_power(low, high));
        let n = vec3(v[0], v[1], v[2]).normalize_any(d);
        worst.add((length(n) - 1.0).abs(), || format!("{v:?}"));
        let exact = crate::support::unit(v.map(f64::from));
        let error = array(n)
            .into_iter()
            .zip(exact)
            .map(|(a, b)| (f64::from(a) - b).abs());
        direction.add(error.fold(0.0, f64::max), || format!("{v:?}"));
    }
    let ulp = f64::from(f32::EPSILON);
    worst.assert_below(2.0 * ulp, "normalize_any, |length − 1|");
    direction.assert_below(2.0 * ulp, "normalize_any, component");
}

#[test]
fn normalize_any_at_the_ends() {
    let d = Scalar::new(&NOTHING);
    assert_eq!(vec3(0.0, 0.0, 0.0).normalize_any(d), vec3(0.0, 0.0, 0.0));
    for size in [1e-23, 1e-37, 1e-38, 1e20, 3e38] {
        let n = vec3(0.0, -size, 0.0).normalize_any(d);
        assert_eq!(n, vec3(0.0, -1.0, 0.0), "{size:e}");
        let n = vec3(size, size, size).normalize_any(d);
        assert!((length(n) - 1.0).abs() < 3e-7, "{size:e}: {n:?}");
    }
    // Subnormal vectors keep a direction, if not all its digits.
    let n = vec3(f32::from_bits(1), 0.0, 0.0).normalize_any(d);
    assert_eq!(n, vec3(1.0, 0.0, 0.0));
}

#[test]
fn parallel_vectors_have_no_cross_product() {
    let mut rng = Rng::new(21);
    for _ in 0..100_000 {
        let v = vec3(
            rng.signed_power(-9.0, 9.0),
            rng.signed_power(-9.0, 9.0),
            rng.signed_power(-9.0, 9.0),
        );
        let power = 2.0_f32.powi((rng.word() % 20) as i32 - 10);
        assert_eq!(v.cross(v.scale(power)), vec3(0.0, 0.0, 0.0));
    }
}

#[test]
fn dot_and_lerp() {
    let d = Scalar::new(&NOTHING);
    let mut rng = Rng::new(22);
    let mut worst = Worst::default();
    for _ in 0..100_000 {
        let [a, b] = [0, 1].map(|_| [0, 1, 2].map(|_| rng.signed_power(-4.0, 4.0)));
        let got = vec3(a[0], a[1], a[2]).dot(d, vec3(b[0], b[1], b[2]));
        let (a, b) = (a.map(f64::from), b.map(f64::from));
        let size = dot(a.map(f64::abs), b.map(f64::abs));
        worst.add((f64::from(got) - dot(a, b)).abs() / size, || {
            format!("{a:?}·{b:?}")
        });
    }
    worst.assert_below(3.0 * f64::from(f32::EPSILON) / 2.0, "dot ÷ Σ|aᵢbᵢ|");
    let (a, b) = (vec3(1.0, 2.0, 3.0), vec3(5.0, 6.0, 7.0));
    assert_eq!(
        (a.lerp(b, 0.0), a.lerp(b, 1.0), a.lerp(b, 0.5)),
        (a, b, vec3(3.0, 4.0, 5.0))
    );
}

/// Unit normals in general position, at the poles and next to them, and along axes.
fn normals() -> Vec<[f64; 3]> {
    let mut rng = Rng::new(23);
    let mut normals: Vec<_> = (0..200_000).map(|_| rng.direction()).collect();
    for power in 0..160 {
        for sign in [-1.0, 1.0] {
            let size = 0.7_f64.powi(power);
            let [x, y, _] = rng.direction();
            normals.push(crate::support::unit([x * size, y * size, sign]));
            normals.push(crate::support::unit([x, y, sign * size]));
        }
    }
    for axis in 0..3 {
        for sign in [-1.0, 1.0] {
            let mut n = [0.0; 3];
            n[axis] = sign;
            normals.push(n);
            normals.push(n.map(|c| if c == 0.0 { -0.0 } else { c }));
        }
    }
    normals
}

#[test]
fn frames_are_orthonormal_and_right_handed() {
    let d = Scalar::new(&NOTHING);
    let mut worst = Worst::default();
    for n in normals() {
        let n = n.map(|c| c as f32);
        let frame = Frame::around(d, vec3(n[0], n[1], n[2]));
        let [t, b, n] =
            [frame.tangent, frame.bitangent, frame.normal].map(|v| array(v).map(f64::from));
        let handed = cross(t, b)
            .iter()
            .zip(n)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        let errors = [
            dot(t, t) - 1.0,
            dot(b, b) - 1.0,
            dot(t, b),
            dot(t, n),
            dot(b, n),
            handed,
        ];
        worst.add(errors.into_iter().map(f64::abs).fold(0.0, f64::max), || {
            format!("{n:?}")
        });
    }
    worst.assert_below(6e-7, "frames: length², angles, handedness");
}

#[test]
fn frames_round_trip() {
    let d = Scalar::new(&NOTHING);
    let mut rng = Rng::new(24);
    let mut worst = Worst::default();
    for n in normals().into_iter().step_by(7) {
        let n = n.map(|c| c as f32);
        let v = rng.direction().map(|c| c as f32);
        let frame = Frame::around(d, vec3(n[0], n[1], n[2]));
        let back = frame.to_world(frame.to_local(d, vec3(v[0], v[1], v[2])));
        let error = array(back)
            .into_iter()
            .zip(v)
            .map(|(a, b)| f64::from((a - b).abs()));
        worst.add(error.fold(0.0, f64::max), || format!("{v:?} around {n:?}"));
    }
    worst.assert_below(6e-7, "frames: there and back");
    let up = Frame::around(d, vec3(0.0, 0.0, 1.0));
    assert_eq!(ulp_diff(up.tangent.x, 1.0), 0);
}
