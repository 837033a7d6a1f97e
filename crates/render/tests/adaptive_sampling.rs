//! S-10: numbers of samples that follow from samples must not change what images are on average.

use residual_render::film::{Film, Pass, Sampling, TilePass};
use residual_render::layer::Layers;

const SIZE: [u32; 2] = [96, 64];
/// A sample is as bright as this, or black; its mean is 1.
const BRIGHT: f32 = 4000.0;

/// Random bits (Steele, Lea and Flood 2014, SplitMix64).
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (*state ^ (*state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The mean of an image of rare bright samples.
fn mean(state: &mut u64) -> f64 {
    let mut film = Film::sampled_by(Sampling::Adaptive, SIZE, 64, Layers::NONE);
    let least = (u64::MAX as f64 / f64::from(BRIGHT)) as u64;
    let mut numbers = Vec::new();
    for (first, count) in [(0, 16), (16, 16), (32, 32), (64, 64)] {
        for TilePass { tile, pass, .. } in film.tile_passes(Pass { first, count }) {
            let samples = tile.rect().area() * pass.count as usize;
            let mut sample = || if random(state) < least { BRIGHT } else { 0.0 };
            tile.add(&(0..samples).flat_map(|_| [sample(); 3]).collect::<Vec<_>>());
            numbers.push(pass.count);
        }
    }
    assert!(
        numbers.iter().max() > numbers.iter().min(),
        "an adaptive image"
    );
    film.mean()[0]
}

/// Tiles that a bright sample has hit early would get more samples, and be darker for it, if they decided for themselves.
#[test]
fn adaptive_images_are_right_on_average() {
    let mut state = 5;
    let means: Vec<f64> = (0..300).map(|_| mean(&mut state)).collect();
    let count = means.len() as f64;
    let middle = means.iter().sum::<f64>() / count;
    let squares: f64 = means.iter().map(|mean| (mean - middle).powi(2)).sum();
    let error = (squares / (count - 1.0) / count).sqrt();
    assert!(error < 0.01, "{error}");
    assert!((middle - 1.0).abs() < 3.0 * error, "{middle} ± {error}");
}
