//! Light of the environment against quadrature (hard case L-08).

use residual_render::alias_table::AliasEntry;
use residual_render::domain::{Buffer, Scalar, Uint};
use residual_render::light::{Environment, EnvironmentHeader, LightKind};
use residual_render::math::vec3::vec3;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;

use crate::support::irradiance::estimate;
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene, set_environment};
use crate::support::stats::{Family, chi_squared};
use crate::support::{Worst, array, dot};

const PI: f64 = std::f64::consts::PI;

/// A map with a faint gradient and one bright texel.
fn sunny(width: usize, height: usize) -> Vec<[f32; 3]> {
    let mut texels: Vec<_> = (0..width * height)
        .map(|k| [0.5 + 0.1 * (k % 5) as f32; 3])
        .collect();
    texels[width * (height / 3) + width / 2 + 1] = [1000.0; 3];
    texels
}

fn seen(data: &SceneData, dir: [f64; 3]) -> (f64, f64) {
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let [x, y, z] = dir.map(|c| c as f32);
    let background = LightKind::background(&Environment, d, vec3(x, y, z)).expect("an environment");
    (f64::from(background.radiance.x), f64::from(background.pdf))
}

/// Integral over the sphere by midpoints in latitude and longitude; `f(direction)`.
fn over_sphere(rotation: f64, columns: usize, rows: usize, f: impl Fn([f64; 3]) -> f64) -> f64 {
    let mut sum = 0.0;
    for row in 0..rows {
        let (sin, cos) = (PI * (row as f64 + 0.5) / rows as f64).sin_cos();
        for column in 0..columns {
            let (s, c) = (2.0 * PI * (column as f64 + 0.5) / columns as f64 + rotation).sin_cos();
            sum += f([sin * c, cos, sin * s]) * sin;
        }
    }
    sum * 2.0 * PI * PI / (columns * rows) as f64
}

#[test]
fn environments_shine_as_their_quadrature_says() {
    let mut family = Family::default();
    let mut rng = Rng::new(140);
    for (k, (width, texels, rotation)) in [
        (8, vec![[1.0; 3]; 32], 0.0),
        (16, sunny(16, 8), 0.0),
        (7, sunny(7, 5), 1.1),
        (1, vec![[2.0; 3]], 0.4),
    ]
    .into_iter()
    .enumerate()
    {
        let mut data = scene(&[FLOOR]);
        set_environment(&mut data, width, &texels, rotation);
        for plane in 0..6 {
            let normal = if plane == 0 {
                [0.0, 0.0, 1.0]
            } else {
                rng.direction()
            };
            let exact = over_sphere(0.0, 900, 450, |dir| {
                seen(&data, dir).0 * dot(dir, normal).max(0.0)
            });
            if k == 0 {
                assert!((exact - PI).abs() < 1e-3, "{exact}");
            }
            let mean = estimate(&data, &(Environment, ()), normal, 40_000, 141 + plane);
            family.add_z(
                mean.z(exact, 1e-4),
                format!("map {k}, {normal:?}: {} {exact}", mean.value()),
            );
        }
    }
    family.assert_plausible();
}

#[test]
fn environment_densities_integrate_to_one() {
    for (width, height, rotation) in [(16, 8, 0.0), (7, 5, 0.0), (1, 1, 0.0)] {
        let mut data = scene(&[FLOOR]);
        set_environment(
            &mut data,
            width,
            &if width == 1 {
                vec![[1.0; 3]]
            } else {
                sunny(width, height)
            },
            rotation,
        );
        // Steps that divide texels, so that none lies in two.
        let total = over_sphere(rotation, width * 60, height * 60, |dir| seen(&data, dir).1);
        assert!((total - 1.0).abs() < 1e-4, "{width} × {height}: {total}");
    }
}

#[test]
fn environment_samples_see_what_they_were_drawn_with() {
    let mut data = scene(&[FLOOR]);
    let (width, height) = (16, 8);
    set_environment(&mut data, width, &sunny(width, height), 0.8);
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let surface = floor(d);
    let mut rng = Rng::new(150);
    let (mut worst, mut unit_length, mut elsewhere) = (Worst::default(), Worst::default(), 0);
    let mut counts = vec![0.0; width * height];
    let n = 200_000;
    for _ in 0..n {
        let u = rng.unit3();
        let sample = LightKind::sample(&Environment, d, Uint(0), surface.point, u);
        let wi = array(sample.wi).map(f64::from);
        unit_length.add((dot(wi, wi) - 1.0).abs(), || format!("{u:?}"));
        let (radiance, pdf) = seen(&data, wi);
        let error = (pdf / f64::from(sample.pdf) - 1.0).abs();
        if error > 1e-2 {
            // Rounding put the direction across the border of its texel.
            elsewhere += 1;
        } else {
            worst.add(error, || format!("{u:?}"));
            worst.add(
                (radiance / f64::from(sample.radiance.x) - 1.0).abs() / 10.0,
                || format!("radiance {u:?}"),
            );
        }
        let angle = (wi[2].atan2(wi[0]) + 0.8).rem_euclid(2.0 * PI);
        let column = ((angle / (2.0 * PI) + 0.5).rem_euclid(1.0) * width as f64) as usize;
        let row = (wi[1].clamp(-1.0, 1.0).acos() / PI * height as f64) as usize;
        counts[row.min(height - 1) * width + column.min(width - 1)] += 1.0;
    }
    unit_length.assert_below(1e-6, "environment directions, |length² − 1|");
    worst.assert_below(1e-4, "environment, sampled against seen");
    assert!(
        elsewhere < n / 10_000,
        "{elsewhere} of {n} samples in the neighbouring texel"
    );
    // Frequencies of texels are those of the table.
    let words = data.buffer(Buffer::Environment);
    let table = &words[EnvironmentHeader::WORDS as usize..];
    let density = |k: usize| {
        let entry = AliasEntry::from_words(&table[k * AliasEntry::WORDS as usize..]);
        f64::from(entry.density)
    };
    let expected: Vec<_> = (0..width * height)
        .map(|k| density(k) / (width * height) as f64 * n as f64)
        .collect();
    assert!(
        chi_squared(&counts, &expected) > 0.001,
        "{counts:?} {expected:?}"
    );
}
