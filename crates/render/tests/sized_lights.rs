//! Lights with a size against closed forms and integrals.

use residual_render::domain::{Scalar, Uint};
use residual_render::light::{
    LightKind, Point, PunctualRecord, SphericalPoint, SphericalSpot, Sun,
};

use crate::lights::{middle, punctual};
use crate::support::irradiance::estimate;
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, scene, set_lights};
use crate::support::stats::Family;
use crate::support::{array, cross, dot, unit};

/// A sphere of radius 1 and of radiance 1 seen from a surface: its irradiance (Howell, Siegel and Mengüç, "Thermal Radiation Heat
/// Transfer", configuration factor of a plane element to a sphere; h = distance / radius).
fn sphere_over_plane(h: f64, cos: f64) -> f64 {
    let angle = cos.acos();
    let horizon = (1.0 / h).asin();
    if angle + horizon <= std::f64::consts::FRAC_PI_2 {
        return std::f64::consts::PI * cos / (h * h);
    }
    if angle - horizon >= std::f64::consts::FRAC_PI_2 {
        return 0.0;
    }
    let (sin, x) = (angle.sin(), (h * h - 1.0).sqrt());
    let cot = cos / sin;
    let (y, root) = (-x * cot, sin * (1.0 - (x * cot).powi(2)).max(0.0).sqrt());
    (cos * y.acos() - x * root) / (h * h) + (root / x).atan()
}

/// Spheres of any size at any distance, above the horizon, half below it, and around the point.
#[test]
fn spheres_shine_as_their_configuration_factor_says() {
    let normal = [0.0, 0.0, 1.0];
    let mut data = scene(&[FLOOR]);
    let point = middle(&data);
    let mut rng = Rng::new(170);
    let mut family = Family::default();
    for k in 0..200 {
        let h = 1.0 + 10.0_f64.powf(rng.range(-2.0, 2.0));
        let distance = 10.0_f64.powf(rng.range(-2.0, 3.0));
        let radius = (distance / h) as f32;
        let horizon = (1.0 / h).asin();
        // As many half below the horizon as above it.
        let elevation = match k % 2 {
            0 => rng.range(-0.9, 0.9) * horizon,
            _ => rng.range(0.0, std::f64::consts::FRAC_PI_2),
        };
        let turn = rng.range(0.0, 6.3);
        let (flat, up) = (elevation.cos() * distance, elevation.sin() * distance);
        let place = [flat * turn.cos(), flat * turn.sin(), up];
        let place = [0, 1, 2].map(|k| (point[k] + place[k]) as f32);
        // The place is rounded.
        let away = [0, 1, 2].map(|k| f64::from(place[k]) - point[k]);
        let exact_h = dot(away, away).sqrt() / f64::from(radius);
        let exact_cos = dot(unit(away), normal);
        let intensity = 3.0 * f64::from(radius).powi(2) as f32;
        set_lights(
            &mut data,
            &[punctual(place, intensity).with_radius(radius)],
            &[1.0],
        );
        let exact = 3.0 / std::f64::consts::PI * sphere_over_plane(exact_h, exact_cos);
        let z = estimate(&data, &(SphericalPoint, ()), normal, 4000, 171 + k).z(exact, 1e-5);
        assert!(
            z.abs() < 4.5,
            "h {h}, distance {distance}, elevation {elevation}: z = {z}"
        );
        family.add_z(z, format!("{h} {elevation}"));
    }
    family.assert_plausible();
    // Within, the sphere is all around: π times its radiance, whatever the place.
    for offset in [0.0, 0.3, 0.999] {
        let place = [point[0] + offset, point[1], point[2]].map(|c| c as f32);
        set_lights(&mut data, &[punctual(place, 2.0).with_radius(1.0)], &[1.0]);
        let z = estimate(&data, &(SphericalPoint, ()), normal, 40_000, 390).z(2.0, 1e-5);
        assert!(z.abs() < 4.5, "{offset}: z = {z}");
    }
}

/// Samples lie on the sphere, are seen along their directions, and bring what a point brings where the sphere is small.
#[test]
fn samples_of_spheres_lie_on_them() {
    let mut data = scene(&[FLOOR]);
    let mut rng = Rng::new(180);
    for _ in 0..20_000 {
        let distance = 10.0_f64.powf(rng.range(-3.0, 4.0));
        let radius = (distance * 10.0_f64.powf(rng.range(-6.0, 1.0))) as f32;
        let towards = rng.direction();
        let place = towards.map(|c| (c * distance) as f32);
        let light = PunctualRecord::spot(0, place, [7.0; 3], [0.0, 0.0, -1.0], [0.3, 1.5]);
        set_lights(&mut data, &[light.with_radius(radius)], &[1.0]);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        let u = [rng.unit(), rng.unit(), 0.0];
        let sample = SphericalPoint.sample(d, Uint(0), [0.0_f32; 3].into(), u);
        let [wi, position] = [sample.wi, sample.position].map(|v| array(v).map(f64::from));
        assert!((dot(wi, wi) - 1.0).abs() < 1e-6);
        let out = [0, 1, 2].map(|k| position[k] - f64::from(place[k]));
        let off = dot(out, out).sqrt() - f64::from(radius);
        assert!(
            off.abs() < 2e-3 * f64::from(radius) + 1e-6 * distance,
            "radius {radius}, distance {distance}: {off}"
        );
        let along = unit(position);
        let turned = cross(along, wi);
        assert!(dot(turned, turned).sqrt() < 1e-5);
        let point = Point.sample(d, Uint(0), [0.0_f32; 3].into(), u);
        if f64::from(radius) < 1e-4 * distance {
            assert!((sample.radiance.x / point.radiance.x - 1.0).abs() < 1e-5);
        }
        // A spot's sphere falls off by the direction of the sample.
        let spot = SphericalSpot.sample(d, Uint(0), [0.0_f32; 3].into(), u);
        let versine = |angle: f64| 1.0 - angle.cos();
        let falloff = (versine(1.5) - (1.0 - wi[2])) / (versine(1.5) - versine(0.3));
        let exact = f64::from(sample.radiance.x) * falloff.clamp(0.0, 1.0).powi(2);
        let found = f64::from(spot.radiance.x);
        assert!((found - exact).abs() <= 1e-4 * f64::from(sample.radiance.x));
    }
}

/// The irradiance of a sun that is above the horizon is that of a light without an angle, whatever its angle; of one half below
/// it, an integral.
#[test]
fn suns_of_any_angle_shine_alike() {
    let normal = [0.0, 0.0, 1.0];
    let mut data = scene(&[FLOOR]);
    let mut rng = Rng::new(190);
    let mut family = Family::default();
    for k in 0..100 {
        let diameter = [1e-6, 1e-4, 0.009, 0.3, 2.0, std::f64::consts::PI][k % 6];
        let horizon = 0.5 * diameter;
        let elevation = rng.range(-horizon.min(1.5), std::f64::consts::FRAC_PI_2);
        let turn = rng.range(0.0, 6.3);
        let flat = elevation.cos();
        let towards = [flat * turn.cos(), flat * turn.sin(), elevation.sin()].map(|c| c as f32);
        let sun = PunctualRecord::sun(0, towards, [5.0, 0.0, 0.0], diameter as f32);
        set_lights(&mut data, &[sun], &[1.0]);
        // ∫ over rings around the sun's middle of the part above the horizon, by the midpoint rule.
        let (rings, parts) = (400, 400);
        let radiance = 5.0 / (std::f64::consts::PI * horizon.sin().powi(2));
        let mut exact = 0.0;
        for ring in 0..rings {
            let angle = (f64::from(ring) + 0.5) / f64::from(rings) * horizon;
            let area = angle.sin() * horizon / f64::from(rings);
            for part in 0..parts {
                let around = (f64::from(part) + 0.5) / f64::from(parts) * std::f64::consts::TAU;
                let up =
                    angle.cos() * elevation.sin() + angle.sin() * around.cos() * elevation.cos();
                exact += radiance * area * up.max(0.0) * std::f64::consts::TAU / f64::from(parts);
            }
        }
        if elevation > horizon {
            assert!((exact / (5.0 * elevation.sin()) - 1.0).abs() < 1e-4);
        }
        let mean = estimate(&data, &(Sun, ()), normal, 4000, 191 + k as u64);
        let z = mean.z(exact, 2e-4);
        assert!(z.abs() < 4.5, "{diameter} {elevation}: z = {z}");
        family.add_z(z, format!("{diameter} {elevation}"));
    }
    family.assert_plausible();
}
