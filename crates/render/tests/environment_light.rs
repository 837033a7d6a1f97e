//! Light of the environment against quadrature (hard case L-08).

use residual_render::alias_table::{AliasEntry, alias_entries};
use residual_render::domain::{Buffer, Scalar, Uint};
use residual_render::light::{self, Environment, EnvironmentHeader, LightKind};
use residual_render::math::vec3::vec3;
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;

use crate::support::irradiance::estimate;
use crate::support::random::Rng;
use crate::support::scenes::{FLOOR, floor, scene, set_environment, texel_weights};
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

/// A sun a billion times as bright as the sky, in one texel, also in the top row and at the seam.
#[test]
fn a_tiny_sun_leaves_no_texel_out() {
    let mut family = Family::default();
    for (width, height, column, row) in [
        (1024, 512, 513, 170),
        (1024, 512, 0, 400),
        (1024, 512, 300, 0),
        (64, 32, 63, 9),
    ] {
        let mut texels = vec![[1.0_f32; 3]; width * height];
        texels[row * width + column] = [1e9; 3];
        let mut data = scene(&[FLOOR]);
        set_environment(&mut data, width, &texels, 0.0);
        let weights = texel_weights(width, &texels);
        let total: f64 = weights.iter().sum();
        let mean = total / weights.len() as f64;
        let header = EnvironmentHeader::from_words(data.buffer(Buffer::Environment));
        light::set_environment(&mut data, header, alias_entries(&weights, mean));

        // The probability of each texel, enumerated from the table, and its density.
        let words = data.buffer(Buffer::Environment);
        let words = &words[EnvironmentHeader::WORDS as usize..];
        let mut probabilities = vec![0.0; weights.len()];
        for (slot, words) in words.chunks(AliasEntry::WORDS as usize).enumerate() {
            let entry = AliasEntry::from_words(words);
            let part = f64::from(entry.threshold) / weights.len() as f64;
            probabilities[slot] += part;
            probabilities[entry.alias as usize] += 1.0 / weights.len() as f64 - part;
            let density = weights[slot] / mean;
            assert!((f64::from(entry.density) - density).abs() <= 1e-6 * density);
            // Numbers that decide are multiples of 2⁻²⁴: below that, a texel has the number 0.
            assert!(entry.threshold > 0.0, "{slot}");
        }
        for (probability, weight) in probabilities.iter().zip(&weights) {
            let exact = weight / total;
            assert!(
                *probability > 0.0 && (probability - exact).abs() <= 1e-6 * exact + 1e-12,
                "{probability} {exact}"
            );
        }

        // The sky's irradiance is π; what the sun adds is integrated over the texels around it.
        let direction = |u: f64, v: f64| {
            let (sin, cos) = (PI * v).sin_cos();
            let (s, c) = (2.0 * PI * (u - 0.5)).sin_cos();
            ([sin * c, cos, sin * s], sin)
        };
        let at = |x: f64, y: f64| {
            let (x, y) = (column as f64 + x, row as f64 + y);
            direction(x / width as f64, y / height as f64)
        };
        let toward = at(0.5, 0.5).0;
        let tilted = [toward[0] + 0.5, toward[1] - 0.3, toward[2] + 0.4];
        let length = dot(tilted, tilted).sqrt();
        for normal in [toward, tilted.map(|x| x / length)] {
            let steps = 150;
            let mut sun = 0.0;
            for k in 0..steps * steps {
                let [x, y] = [k % steps, k / steps];
                let [x, y] = [x, y].map(|i| 3.0 * (f64::from(i) + 0.5) / f64::from(steps) - 1.0);
                if row as f64 + y > 0.0 {
                    let (dir, sin) = at(x, y);
                    sun += (seen(&data, dir).0 - 1.0) * dot(dir, normal).max(0.0) * sin;
                }
            }
            sun *= 2.0 * PI * PI / (width * height) as f64 * 9.0 / f64::from(steps * steps);
            let mean = estimate(&data, &(Environment, ()), normal, 40_000, 142);
            let z = mean.z(PI + sun, 1e-4);
            let what = format!("{column}, {row}, {normal:?}: {} {sun}", mean.value());
            assert!(z.abs() < 4.0, "{what}: {z}");
            family.add_z(z, what);
        }
    }
    family.assert_plausible();
}
