//! Adaptive sampling: more samples where the error is, fewer where it is not.
//!
//! The relative mean squared error of an image is least, for so many samples in all, if each tile gets samples in proportion to
//! the root of its noise (Neyman's allocation; Cochran, *Sampling Techniques*, 5.5). Noise is only known from samples, and an
//! image is wrong on average if samples decide how many follow them: a tile that a bright path has hit early gets more samples,
//! which dilute it (Kirk and Arvo, *Unbiased sampling techniques for image synthesis*, 1991). So no tile decides for
//! itself: *its number of samples follows from the noise of its four neighbours*, and that from a number of their samples that is
//! the same for all tiles, however many they have. A tile's samples thus know nothing of how many they are; the one thing that
//! they share with it is the sum over all tiles, of which a tile is a small part.
//!
//! Numbers of samples are small multiples of powers of two wherever the image's is one, since well-distributed points are best
//! there.

use super::noise::FIRST;
use super::pass::Pass;
use super::tile::FilmTile;

/// Pixels along the side of a tile that has a number of samples of its own.
pub(super) const SIDE: u32 = 8;

/// A tile's samples ÷ the image's, at a power of two.
const SHARES: [f64; 9] = [0.25, 0.375, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 4.0];

/// What each tile gets in a pass; tiles are in rows of `columns`.
pub(super) fn passes(tiles: &[FilmTile], columns: usize, pass: Pass) -> Vec<Pass> {
    let (first, end) = (
        u64::from(pass.first),
        u64::from(pass.first) + u64::from(pass.count),
    );
    let known = tiles.iter().map(|tile| tile.noises().count()).min();
    let (Some(known @ 1..), 2..) = (known, tiles.len()) else {
        return vec![pass; tiles.len()];
    };
    // At the power of two before, every tile has at least an eighth of it.
    let until = end.next_power_of_two();
    let index = (until / 8 / FIRST).max(1).ilog2() as usize;
    let wishes = wishes(tiles, columns, index.min(known - 1));
    let goals = goals(tiles, &wishes, until);
    let of = |(tile, goal): (&FilmTile, u64)| {
        let missing = goal - tile.samples;
        Pass {
            first: tile.samples as u32,
            count: (missing * u64::from(pass.count) / (until - first)) as u32,
        }
    };
    tiles.iter().zip(goals).map(of).collect()
}

/// The root of the noise of each tile's neighbours.
fn wishes(tiles: &[FilmTile], columns: usize, index: usize) -> Vec<f64> {
    let noises: Vec<_> = tiles.iter().map(|tile| tile.noises().at(index)).collect();
    let sum: f64 = noises.iter().flat_map(|noise| noise.mean).sum();
    let mean = sum / (3 * tiles.len()) as f64;
    let floor = 1e-2 * mean * mean;
    let wish = |t: usize| {
        let (x, y) = (t % columns, t / columns);
        let neighbors = [
            (x > 0).then(|| t - 1),
            (x + 1 < columns).then(|| t + 1),
            (y > 0).then(|| t - columns),
            (t + columns < tiles.len()).then(|| t + columns),
        ];
        let count = neighbors.iter().flatten().count() as f64;
        let sum: f64 = neighbors
            .into_iter()
            .flatten()
            .map(|n| noises[n].relative(floor))
            .sum();
        (sum / count).sqrt()
    };
    (0..tiles.len()).map(wish).collect()
}

/// How many samples each tile shall have when the image has `until`, as its wish says, in all as many as that is.
fn goals(tiles: &[FilmTile], wishes: &[f64], until: u64) -> Vec<u64> {
    let all = |goals: &[u64]| -> u64 {
        let of = |(tile, goal): (&FilmTile, &u64)| tile.rect().area() as u64 * goal;
        tiles.iter().zip(goals).map(of).sum()
    };
    let even = vec![until; tiles.len()];
    if wishes.iter().all(|wish| *wish == 0.0) {
        return even;
    }
    let most = all(&even);
    let goals = |scale: f64| -> Vec<u64> {
        let goal = |(tile, wish): (&FilmTile, &f64)| {
            let goal = share(scale * wish) * until as f64;
            tile.samples.max(goal as u64)
        };
        tiles.iter().zip(wishes).map(goal).collect()
    };
    // Bisection between scales that give every tile the least and the most that it can wish.
    let positive = || wishes.iter().copied().filter(|wish| *wish > 0.0);
    let (mut low, mut high) = (
        SHARES[0] / positive().fold(f64::MIN_POSITIVE, f64::max),
        SHARES[8] / positive().fold(f64::MAX, f64::min),
    );
    for _ in 0..64 {
        let middle = (low * high).sqrt();
        if all(&goals(middle)) <= most {
            low = middle;
        } else {
            high = middle;
        }
    }
    goals(low)
}

/// The nearest share, by ratio.
fn share(wish: f64) -> f64 {
    let is_above = |pair: &&[f64]| wish * wish >= pair[0] * pair[1];
    let above = SHARES.windows(2).take_while(is_above).count();
    SHARES[above]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::TileRect;
    use crate::layer::Layers;

    /// Tiles in a row whose pixels are 1 ± `noise`.
    struct Row {
        tiles: Vec<FilmTile>,
        noise: Vec<f32>,
    }

    impl Row {
        fn new(noise: &[f32]) -> Self {
            let tile = |k: u32| {
                let rect = TileRect {
                    x: 2 * k,
                    y: 0,
                    width: 2,
                    height: 2,
                };
                FilmTile::new(rect, Layers::NONE).with_noises()
            };
            Self {
                tiles: (0..noise.len() as u32).map(tile).collect(),
                noise: noise.to_vec(),
            }
        }

        fn pass(&mut self, first: u32, count: u32) {
            let passes = passes(&self.tiles, self.tiles.len(), Pass { first, count });
            for ((tile, pass), noise) in self.tiles.iter_mut().zip(passes).zip(&self.noise) {
                assert_eq!(u64::from(pass.first), tile.samples);
                for s in 0..pass.count {
                    let value = if (pass.first + s) / 2 % 2 == 0 {
                        1.0 + noise
                    } else {
                        1.0 - noise
                    };
                    tile.add(&[value; 12]);
                }
            }
        }

        fn samples(&self) -> Vec<u64> {
            self.tiles.iter().map(|tile| tile.samples).collect()
        }
    }

    #[test]
    fn tiles_get_samples_as_their_neighbors_are_noisy() {
        let mut row = Row::new(&[0.1, 0.1, 0.1, 0.1, 0.9, 0.1, 0.1, 0.1]);
        row.pass(0, 16);
        assert_eq!(row.samples(), [16; 8]);
        row.pass(16, 16);
        row.pass(32, 32);
        let samples = row.samples();
        assert!(samples.iter().sum::<u64>() <= 8 * 64, "{samples:?}");
        // The noisy tile is not among those that get more for it: its neighbors are quiet.
        assert!(
            samples[3] > 2 * samples[4] && samples[5] == samples[3],
            "{samples:?}"
        );
        assert_eq!(samples[4], samples[0]);
    }

    #[test]
    fn no_number_follows_from_a_tile_itself() {
        // Whatever tile 2 sees, its own number stays, while its neighbors' change with it.
        let quiet = [0.3, 0.2, 0.1, 0.2, 0.3, 0.1];
        let mut loud = quiet;
        loud[2] = 0.12;
        let run = |noise: &[f32]| {
            let mut row = Row::new(noise);
            for (first, count) in [(0, 16), (16, 16), (32, 16), (48, 16), (64, 64)] {
                row.pass(first, count);
            }
            row.samples()
        };
        assert_eq!(run(&quiet)[2], run(&loud)[2]);
        let mut louder = quiet;
        louder[2] = 0.8;
        assert!(run(&louder)[1] > run(&quiet)[1]);
    }

    #[test]
    fn the_image_gets_no_more_than_asked_for() {
        let noise: Vec<f32> = (0..40)
            .map(|k| 0.02 + 0.9 * ((k * k % 17) as f32 / 17.0))
            .collect();
        let mut row = Row::new(&noise);
        let mut first = 0;
        for count in [1, 1, 2, 4, 8, 16, 16, 16, 64, 128] {
            row.pass(first, count);
            first += count;
        }
        let all = row.samples().iter().sum::<u64>();
        // One step of the noisiest tile more would be too much.
        assert!((37 * 256..=40 * 256).contains(&all), "{all}");
        assert!(row.samples().iter().all(|n| *n >= 64 && *n <= 1024));
    }

    #[test]
    fn without_noise_all_tiles_get_the_same() {
        let mut row = Row::new(&[0.0; 5]);
        row.pass(0, 16);
        row.pass(16, 16);
        let mut one = Row::new(&[0.5]);
        one.pass(0, 16);
        one.pass(16, 16);
        assert_eq!((row.samples(), one.samples()), (vec![32; 5], vec![32]));
    }

    #[test]
    fn shares_are_the_nearest() {
        for wish in [0.0, 0.1, 0.3, 0.7, 0.99, 1.2, 2.6, 3.4, 3.6, 100.0] {
            let nearest = SHARES.into_iter().min_by(|a, b| {
                let far = |s: &f64| (s / f64::max(wish, 1e-9)).ln().abs();
                far(a).total_cmp(&far(b))
            });
            assert_eq!(Some(share(wish)), nearest, "{wish}");
        }
    }
}
