//! The tree of lights beside the lights themselves, one after the other.

use std::f64::consts::PI;

use glam::DVec3;
use residual_render::domain::{Buffer, Scalar, Uint};
use residual_render::light::{LIGHT_WORDS, LightRecord, LightTree, push_light};
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::scene_data::SceneData;

use super::light_tree::{LightBounds, Reach, build};

/// Numbers in [0, 1).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f64 / (1_u64 << 24) as f64
    }
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
    fn point(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| self.between(low[k], high[k])))
    }
    fn direction(&mut self) -> DVec3 {
        let (z, turn) = (self.between(-1.0, 1.0), self.between(0.0, 2.0 * PI));
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * turn.cos(), r * turn.sin(), z)
    }
}

/// A lamp that shines from a place, into the half-space before it or everywhere.
#[derive(Clone, Copy)]
struct Lamp {
    place: DVec3,
    axis: DVec3,
    is_flat: bool,
    intensity: f64,
}

impl Lamp {
    fn reach(&self, size: f64) -> Reach {
        let bounds = LightBounds::point(self.place, self.intensity);
        Reach::Bounded(match self.is_flat {
            true => LightBounds {
                corners: [self.place - size, self.place + size],
                axis: self.axis,
                half_angle: 0.0,
                ..bounds
            },
            false => bounds,
        })
    }

    /// What arrives at a point on a surface of this normal.
    fn arrives(&self, at: DVec3, normal: DVec3) -> f64 {
        let away = at - self.place;
        let dir = away.normalize();
        let cos = match self.is_flat {
            true => self.axis.dot(dir).max(0.0),
            false => 1.0,
        };
        self.intensity * cos * (-dir.dot(normal)).max(0.0) / away.length_squared()
    }
}

/// Lamps all over a box of 20 × 20 × 3, of intensities that differ by a hundred times.
fn scattered(count: usize, random: &mut Random) -> Vec<Lamp> {
    let lamp = |k: usize| Lamp {
        place: random.point(DVec3::new(-10.0, -10.0, 0.0), DVec3::new(10.0, 10.0, 3.0)),
        axis: random.direction(),
        is_flat: !k.is_multiple_of(3),
        intensity: 10_f64.powf(random.between(0.0, 2.0)),
    };
    (0..count).map(lamp).collect()
}

/// The tree over some lights, among lights that are all of kind 0.
fn tree_over(lights: &[(Reach, f64)]) -> (SceneData, LightTree) {
    let mut data = SceneData::default();
    for _ in lights {
        push_light(&mut data, LightRecord { kind: 0 });
    }
    let tree = build(lights, &mut data);
    (data, tree)
}

fn evenly(reaches: impl IntoIterator<Item = Reach>) -> Vec<(Reach, f64)> {
    let reaches: Vec<_> = reaches.into_iter().collect();
    let probability = 1.0 / reaches.len() as f64;
    reaches
        .into_iter()
        .map(|reach| (reach, probability))
        .collect()
}

fn single(point: DVec3) -> Vec3<f32> {
    let [x, y, z] = point.as_vec3().to_array();
    vec3(x, y, z)
}

fn probabilities(data: &SceneData, tree: LightTree, at: DVec3, count: usize) -> Vec<f64> {
    let buffers = data.buffers();
    let d = Scalar::new(&buffers);
    let of = |light| f64::from(tree.probability(d, single(at), Uint(light)));
    (0..count as u32).map(of).collect()
}

/// Sets of lights of all shapes, each with a name.
fn sets(random: &mut Random) -> Vec<(&'static str, Vec<(Reach, f64)>)> {
    let lamps = scattered(1000, random);
    let of = |lamps: &[Lamp]| {
        lamps
            .iter()
            .map(|lamp| lamp.reach(0.01))
            .collect::<Vec<_>>()
    };
    let at = |place| Lamp { place, ..lamps[1] };
    let far = [Reach::Everywhere; 3];
    let apart = (0..40).map(|k| at(DVec3::X * 0.5_f64.powi(k)));
    let mut with_far = of(&lamps[..20]);
    with_far.extend(far);
    vec![
        ("one", evenly(of(&lamps[..1]))),
        ("two", evenly(of(&lamps[..2]))),
        ("scattered", evenly(of(&lamps))),
        ("at one place", evenly(of(&[at(DVec3::ONE); 100]))),
        (
            "in a row",
            evenly((0..100).map(|k| at(DVec3::X * f64::from(k)).reach(0.0))),
        ),
        (
            "each twice as far as the next",
            evenly(apart.map(|lamp| lamp.reach(0.0))),
        ),
        ("infinitely far away", evenly(far)),
        ("some infinitely far away", evenly(with_far)),
    ]
}

/// Points among the lights, far from them, and on them.
fn points(lights: &[(Reach, f64)], random: &mut Random) -> Vec<DVec3> {
    let mut points: Vec<_> = [0.5, 10.0, 1e4]
        .into_iter()
        .flat_map(|size| [0; 5].map(|_| random.point(DVec3::splat(-size), DVec3::splat(size))))
        .collect();
    for (reach, _) in lights.iter().take(3) {
        if let Reach::Bounded(bounds) = reach {
            points.extend([
                bounds.corners[0],
                0.5 * (bounds.corners[0] + bounds.corners[1]),
            ]);
        }
    }
    points
}

#[test]
fn probabilities_add_up_to_one() {
    let mut random = Random(1);
    for (name, lights) in sets(&mut random) {
        let (data, tree) = tree_over(&lights);
        for at in points(&lights, &mut random) {
            let probabilities = probabilities(&data, tree, at, lights.len());
            let sum: f64 = probabilities.iter().sum();
            assert!((sum - 1.0).abs() < 1e-5, "{name} at {at}: {sum}");
        }
    }
}

#[test]
fn lights_are_picked_with_their_probabilities() {
    let mut random = Random(2);
    for (name, lights) in sets(&mut random) {
        let (data, tree) = tree_over(&lights);
        let buffers = data.buffers();
        let d = Scalar::new(&buffers);
        for at in points(&lights, &mut random) {
            let expected = probabilities(&data, tree, at, lights.len());
            let n = 20_000;
            let (mut counts, mut places) = (vec![0; lights.len()], [0; 16]);
            for _ in 0..n {
                let u = [random.unit() as f32, random.unit() as f32];
                let pick = tree.pick(d, single(at), u);
                let light = (pick.record.0 / LIGHT_WORDS) as usize;
                counts[light] += 1;
                let probability = f64::from(pick.probability);
                assert!(
                    (probability - expected[light]).abs() <= 1e-5 * probability,
                    "{name} at {at}: {probability} {}",
                    expected[light]
                );
                assert!((0.0..1.0).contains(&pick.place[0]), "{name} at {at}");
                places[(pick.place[0] * 16.0) as usize] += 1;
            }
            let counts = counts.into_iter().zip(expected);
            let z = deviation(counts.map(|(count, p)| (f64::from(count), p * f64::from(n))));
            assert!(z < 6.0, "{name} at {at}: {z:.1} standard deviations");
            let places = places.map(|count| (f64::from(count), f64::from(n) / 16.0));
            let z = deviation(places.into_iter());
            assert!(
                z < 6.0,
                "{name} at {at}, places: {z:.1} standard deviations"
            );
        }
    }
}

/// By how many standard deviations χ² exceeds its mean; rare outcomes are counted together.
fn deviation(counts: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (mut rare, mut chi2, mut cells) = ((0.0, 0.0), 0.0, 0.0);
    for (count, expected) in counts {
        if expected < 10.0 {
            rare = (rare.0 + count, rare.1 + expected);
        } else {
            chi2 += (count - expected) * (count - expected) / expected;
            cells += 1.0;
        }
    }
    if rare.1 >= 10.0 {
        chi2 += (rare.0 - rare.1).powi(2) / rare.1;
        cells += 1.0;
    } else {
        assert!(rare.0 < 40.0, "{} of {}", rare.0, rare.1);
    }
    let freedom = f64::max(cells - 1.0, 1.0);
    (chi2 - freedom) / (2.0 * freedom).sqrt()
}

/// What shines at a point is picked there, however little it is.
#[test]
fn no_light_is_lost() {
    let mut random = Random(3);
    let lamps = scattered(2000, &mut random);
    let (data, tree) = tree_over(&evenly(lamps.iter().map(|lamp| lamp.reach(0.01))));
    for size in [0.5, 5.0, 100.0] {
        for _ in 0..30 {
            let at = random.point(DVec3::splat(-size), DVec3::splat(size));
            let normal = random.direction();
            let probabilities = probabilities(&data, tree, at, lamps.len());
            for (lamp, probability) in lamps.iter().zip(probabilities) {
                assert!(probability > 0.0 || lamp.arrives(at, normal) == 0.0, "{at}");
            }
        }
    }
}

/// The part of the picks that go to lights infinitely far away is as it was asked for, wherever the point is.
#[test]
fn a_sky_takes_its_share() {
    let mut random = Random(4);
    let lamps = scattered(50, &mut random);
    let mut lights: Vec<_> = lamps
        .iter()
        .map(|lamp| (lamp.reach(0.01), 0.7 / 50.0))
        .collect();
    lights.extend([(Reach::Everywhere, 0.1), (Reach::Everywhere, 0.2)]);
    let (data, tree) = tree_over(&lights);
    for at in points(&lights, &mut random) {
        let probabilities = probabilities(&data, tree, at, lights.len());
        for (found, asked) in probabilities[50..].iter().zip([0.1, 0.2]) {
            assert!((found - asked).abs() < 1e-6, "{at}: {found} {asked}");
        }
    }
}

/// The variance of an estimate with one light, without shadows, over the square of its mean, in the mean over points on surfaces.
fn variance(lamps: &[Lamp], probabilities: impl Fn(DVec3) -> Vec<f64>) -> f64 {
    let mut random = Random(6);
    let points = 100;
    let mut sum = 0.0;
    for _ in 0..points {
        let at = random.point(DVec3::new(-10.0, -10.0, 0.0), DVec3::new(10.0, 10.0, 3.0));
        let normal = random.direction();
        let (mut mean, mut square) = (0.0, 0.0);
        for (lamp, probability) in lamps.iter().zip(probabilities(at)) {
            let arrives = lamp.arrives(at, normal);
            if arrives > 0.0 {
                mean += arrives;
                square += arrives * arrives / probability;
            }
        }
        sum += square / (mean * mean) - 1.0;
    }
    sum / f64::from(points)
}

/// Measured: 5.6 from a tree, 248 by power, 662 evenly.
#[test]
fn a_tree_has_less_variance_than_a_table() {
    let mut random = Random(5);
    let lamps = scattered(20_000, &mut random);
    let (data, tree) = tree_over(&evenly(lamps.iter().map(|lamp| lamp.reach(0.01))));
    let by_tree = variance(&lamps, |at| probabilities(&data, tree, at, lamps.len()));
    let power = |lamp: &Lamp| lamp.intensity * if lamp.is_flat { 1.0 } else { 4.0 };
    let total: f64 = lamps.iter().map(power).sum();
    let powers: Vec<_> = lamps.iter().map(|lamp| power(lamp) / total).collect();
    let by_power = variance(&lamps, |_| powers.clone());
    let evenly = variance(&lamps, |_| vec![1.0 / lamps.len() as f64; lamps.len()]);
    assert!(
        20.0 * by_tree < by_power && 50.0 * by_tree < evenly,
        "{by_tree} {by_power} {evenly}"
    );
}

/// Lights that splits separate one at a time do not make the tree as deep as there are lights.
#[test]
fn trees_are_not_deep() {
    let mut random = Random(7);
    for (name, lights) in sets(&mut random) {
        let (data, tree) = tree_over(&lights);
        let balanced = lights.len().next_power_of_two().ilog2();
        assert!(tree.levels <= balanced + 5, "{name}: {}", tree.levels);
        assert!(!data.buffer(Buffer::LightTree).is_empty());
    }
}
