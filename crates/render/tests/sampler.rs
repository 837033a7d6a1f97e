//! Samplers (hard cases S-04 to S-06).

use residual_render::domain::{Buffers, Scalar, Uint};
use residual_render::sampler::{AnySampler, Independent, SampleKey, Sampler, Sobol, hash, unit};

use crate::support::random::Rng;
use crate::support::stats::{Family, Mean, chi_squared};

static NOTHING: Buffers<'static> = Buffers::EMPTY;

fn scalar() -> Scalar<'static> {
    Scalar::new(&NOTHING)
}

fn pair(
    sampler: &impl Sampler<Scalar<'static>>,
    [x, y]: [u32; 2],
    index: u32,
    seed: u32,
    dimension: u32,
) -> [f32; 2] {
    let d = scalar();
    let key = SampleKey::new(d, Uint(x), Uint(y), Uint(index), Uint(seed));
    sampler.pair(d, key, Uint(dimension))
}

#[test]
fn numbers_never_reach_one() {
    let d = scalar();
    let below = 1.0 - 1.0 / 16_777_216.0;
    assert_eq!(unit(d, Uint(u32::MAX)), below);
    assert_eq!(
        (unit(d, Uint(0)), unit(d, Uint(255)), unit(d, Uint(256))),
        (0.0, 0.0, 1.0 / 16_777_216.0)
    );
    let mut rng = Rng::new(30);
    for _ in 0..200_000 {
        let (pixel, index) = ([rng.bits(), rng.bits()], rng.bits());
        for numbers in [
            pair(&Sobol, pixel, index, 1, 3),
            pair(&Independent, pixel, index, 1, 3),
        ] {
            assert!(
                numbers.iter().all(|u| (0.0..=below).contains(u)),
                "{numbers:?}"
            );
        }
    }
}

#[test]
fn hash_is_a_bijection() {
    let d = scalar();
    // Newton's iteration for the inverse of an odd number modulo 2³².
    let inverse = |a: u32| {
        (0..5).fold(a, |x, _| {
            x.wrapping_mul(2_u32.wrapping_sub(a.wrapping_mul(x)))
        })
    };
    let undo = |x: u32| {
        let x = (x ^ (x >> 16)).wrapping_mul(inverse(0x846c_a68b));
        let x = (x ^ (x >> 15) ^ (x >> 30)).wrapping_mul(inverse(0x7feb_352d));
        x ^ (x >> 16)
    };
    let mut rng = Rng::new(32);
    for x in (0..1000).chain((0..1_000_000).map(|_| rng.bits())) {
        assert_eq!(undo(hash(d, Uint(x)).0), x);
    }
}

/// How many elementary intervals of the first 2^k points do not hold exactly one point.
fn crowded(points: &[[f32; 2]]) -> usize {
    let k = points.len().ilog2();
    (0..=k)
        .map(|columns| {
            let (across, down) = (1_usize << columns, 1_usize << (k - columns));
            let mut counts = vec![0; points.len()];
            for [x, y] in points {
                counts[(x * across as f32) as usize * down + (y * down as f32) as usize] += 1;
            }
            counts.iter().filter(|count| **count != 1).count()
        })
        .sum()
}

#[test]
fn sobol_pairs_fill_elementary_intervals() {
    for seed in [0, 1, 0xdead_beef] {
        for dimension in [0, 1, 2, 3, 7, 64, 1_000_003] {
            for pixel in [[0, 0], [17, 4000]] {
                let points: Vec<_> = (0..1 << 10)
                    .map(|index| pair(&Sobol, pixel, index, seed, dimension))
                    .collect();
                for k in 0..=10 {
                    assert_eq!(
                        crowded(&points[..1 << k]),
                        0,
                        "2^{k}, dimension {dimension}, seed {seed}"
                    );
                }
                // A (0, 2)-sequence: any aligned block of 2^k points is a net as well.
                for block in points.chunks_exact(64) {
                    assert_eq!(crowded(block), 0, "dimension {dimension}, seed {seed}");
                }
            }
        }
    }
}

#[test]
fn sobol_holds_beyond_2_to_the_24() {
    for first in [
        (1_u32 << 24) - 256,
        1 << 24,
        (1 << 31) - 256,
        u32::MAX - 255,
    ] {
        let points: Vec<_> = (0..256)
            .map(|k| pair(&Sobol, [3, 5], first + k, 9, 6))
            .collect();
        assert_eq!(crowded(&points), 0, "from {first}");
    }
}

#[test]
fn independent_numbers_do_not_fill_elementary_intervals() {
    let points: Vec<_> = (0..256)
        .map(|index| pair(&Independent, [0, 0], index, 1, 2))
        .collect();
    assert!(crowded(&points) > 500);
}

/// χ² of pairs of numbers over 16 × 16 cells.
fn joint(numbers: impl Iterator<Item = [f32; 2]>) -> f64 {
    let mut counts = vec![0.0; 256];
    let mut n = 0.0;
    for [a, b] in numbers {
        counts[(a * 16.0) as usize * 16 + (b * 16.0) as usize] += 1.0;
        n += 1.0;
    }
    chi_squared(&counts, &vec![n / 256.0; 256])
}

/// Pearson's correlation times √n: standard normal for independent numbers.
fn correlation(numbers: impl Iterator<Item = [f32; 2]>) -> f64 {
    let (mut sum, mut n) = (0.0, 0.0_f64);
    for [a, b] in numbers {
        sum += (f64::from(a) - 0.5) * (f64::from(b) - 0.5);
        n += 1.0;
    }
    sum * 12.0 / n.sqrt()
}

/// Pairs of dimensions: (first, component) against (second, component).
fn dimension_pairs() -> Vec<[(u32, usize); 2]> {
    let dimensions = [0, 4, 5, 6, 7, 8, 11, 40, 41];
    let mut pairs = Vec::new();
    for (k, &a) in dimensions.iter().enumerate() {
        for &b in &dimensions[k + 1..] {
            pairs.extend([(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| [(a, i), (b, j)]));
        }
    }
    pairs
}

fn assert_dimensions_independent(sampler: &impl Sampler<Scalar<'static>>) {
    // One number of each pixel: within one pixel low-discrepancy points are not independent, nor should they be.
    let mut family = Family::default();
    for [(a, i), (b, j)] in dimension_pairs() {
        let numbers = || {
            (0..16_384).map(|k| {
                let pixel = [k % 128, k / 128];
                [
                    pair(sampler, pixel, 5, 1, a)[i],
                    pair(sampler, pixel, 5, 1, b)[j],
                ]
            })
        };
        family.add(joint(numbers()), format!("χ² {a}.{i} {b}.{j}"));
        family.add_z(
            correlation(numbers()),
            format!("correlation {a}.{i} {b}.{j}"),
        );
    }
    family.assert_plausible();
}

#[test]
fn dimensions_are_independent() {
    assert_dimensions_independent(&Sobol);
    assert_dimensions_independent(&Independent);
}

/// Deviates of low-discrepancy points within a pixel: independently shuffled, but each stratified, so that their
/// correlation has mean 0 and a variance that is not that of independent numbers, if of the same size.
#[derive(Default)]
struct Deviates(Mean);

impl Deviates {
    fn judge(&self, family: &mut Family, name: &str) {
        println!(
            "{name}: mean {:.3}, variance {:.3}",
            self.0.value(),
            self.0.variance()
        );
        assert!(self.0.variance() < 3.0, "{name}");
        family.add_z(self.0.z(0.0, 0.0), name);
    }
}

#[test]
fn samples_of_one_pixel_are_uncorrelated_across_dimensions() {
    let mut family = Family::default();
    for (a, b) in [(4, 5), (5, 6), (6, 7), (7, 8), (4, 8)] {
        let mut deviates = Deviates::default();
        for pixel in 0..400 {
            let numbers = (0..1024).map(|k| {
                [
                    pair(&Sobol, [pixel, 0], k, 3, a)[0],
                    pair(&Sobol, [pixel, 0], k, 3, b)[0],
                ]
            });
            deviates.0.add(correlation(numbers));
        }
        deviates.judge(&mut family, &format!("dimensions {a} {b}"));
    }
    family.assert_plausible();
}

const STEPS: [[u32; 2]; 3] = [[1, 0], [0, 1], [1, 1]];

#[test]
fn neighbouring_pixels_are_uncorrelated_over_samples() {
    let mut family = Family::default();
    let mut deviates: [Deviates; 4] = Default::default();
    for pixel in 0..1500_u32 {
        let at = [pixel % 61, pixel / 61];
        for (step, deviates) in STEPS.iter().zip(&mut deviates) {
            let next = [at[0] + step[0], at[1] + step[1]];
            let numbers = |sampler: AnySampler| {
                correlation((0..512).map(|k| {
                    [
                        pair(&sampler, at, k, 7, 4)[0],
                        pair(&sampler, next, k, 7, 4)[0],
                    ]
                }))
            };
            family.add_z(numbers(AnySampler::Independent), format!("{at:?} {step:?}"));
            deviates.0.add(numbers(AnySampler::Sobol));
        }
        let lag = (0..512).map(|k| {
            [
                pair(&Independent, at, k, 7, 4)[0],
                pair(&Independent, at, k + 1, 7, 4)[0],
            ]
        });
        family.add_z(correlation(lag), format!("{at:?} lag 1"));
        let seeds = (0..512).map(|k| [pair(&Sobol, at, k, 7, 4)[1], pair(&Sobol, at, k, 8, 4)[1]]);
        deviates[3].0.add(correlation(seeds));
    }
    for (deviates, name) in deviates.iter().zip(["right", "below", "diagonal", "seeds"]) {
        deviates.judge(&mut family, name);
    }
    family.assert_plausible();
}

#[test]
fn neighbouring_pixels_are_uncorrelated_over_the_image() {
    let mut family = Family::default();
    for sampler in [AnySampler::Independent, AnySampler::Sobol] {
        for index in 0..20 {
            for step in STEPS {
                let numbers = || {
                    (0..16_384).map(|k| {
                        let at = [k % 128, k / 128];
                        let next = [at[0] + step[0], at[1] + step[1]];
                        [
                            pair(&sampler, at, index, 7, 4)[0],
                            pair(&sampler, next, index, 7, 4)[0],
                        ]
                    })
                };
                family.add_z(
                    correlation(numbers()),
                    format!("{sampler:?} {index} {step:?}"),
                );
                family.add(joint(numbers()), format!("χ² {sampler:?} {index} {step:?}"));
            }
        }
    }
    family.assert_plausible();
}

#[test]
fn independence_tests_have_power() {
    let mut rng = Rng::new(31);
    let mut family = Family::default();
    let numbers: Vec<_> = (0..16_384)
        .map(|_| {
            let (a, b) = (rng.unit(), rng.unit());
            [a, if rng.unit() < 0.1 { a } else { b }]
        })
        .collect();
    family.add(joint(numbers.iter().copied()), "χ²");
    assert!(family.rejects());
    let mut family = Family::default();
    family.add_z(correlation(numbers.into_iter()), "correlation");
    assert!(family.rejects());
}

#[test]
fn no_two_samples_share_their_numbers() {
    let mut seen = std::collections::HashSet::new();
    let mut repeats = 0;
    for pixel in 0..64 {
        for index in 0..256 {
            for dimension in 0..16 {
                let [a, b] = pair(&Sobol, [pixel % 8, pixel / 8], index, 2, dimension);
                repeats += u32::from(!seen.insert((a.to_bits(), b.to_bits())));
            }
        }
    }
    // 2^18 draws of 48 bits: 2^36/2^49 repeats expected.
    assert_eq!(repeats, 0);
}
