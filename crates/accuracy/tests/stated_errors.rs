//! Stated errors beside true ones, for samples whose mean is known exactly.

use residual_accuracy::{Distrust, ErrorEstimate, PixelMoments, Replicate, SampleIndex, Sampled};

const WIDTH: usize = 48;
const HEIGHT: usize = 36;
/// One pixel in each block of so many by so many is sampled twice.
const BLOCK: usize = 4;

/// Random numbers (Steele, Lea and Flood 2014, SplitMix64).
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A way to sample pixels: sample `index` of `count` of a pixel whose mean is `mean`.
type Sample = fn(&mut Random, index: u64, count: u64, mean: f64) -> f64;

/// Independent, of a skewed distribution.
fn independent(random: &mut Random, _: u64, _: u64, mean: f64) -> f64 {
    let u = random.unit();
    mean * (0.4 + 1.8 * u * u)
}

/// The same integrand at one point of each of `count` equal strata.
fn stratified(random: &mut Random, index: u64, count: u64, mean: f64) -> f64 {
    let u = (index as f64 + random.unit()) / count as f64;
    mean * (0.4 + 1.8 * u * u)
}

/// An image of smooth and of sudden changes, with a dark half.
fn truth(pixel: usize) -> f64 {
    let (x, y) = (pixel % WIDTH, pixel / WIDTH);
    let base = if x < WIDTH / 2 { 0.05 } else { 1.0 };
    base * (1.0 + 0.5 * (0.3 * y as f64).sin())
}

fn sampled(random: &mut Random, sample: Sample, count: u64, mean: f64) -> PixelMoments {
    let mut moments = PixelMoments::default();
    for index in 0..count {
        let value = sample(random, index, count, mean);
        // Channels that shade the same path differently.
        moments.add(
            [value, 0.5 * value, 0.25 * value + 0.2],
            SampleIndex::new(index),
        );
    }
    moments
}

/// How samples are spread over an image that gets so many a pixel.
type Spread = fn(samples: u64, pixel: usize) -> u64;

/// What an image says of its error in red, green and blue, and what that is.
fn image(
    random: &mut Random,
    sample: Sample,
    samples: u64,
    is_replicated: bool,
) -> (ErrorEstimate, f64) {
    spread_image(
        random,
        sample,
        (samples, |samples, _| samples),
        is_replicated,
    )
}

fn spread_image(
    random: &mut Random,
    sample: Sample,
    (samples, spread): (u64, Spread),
    is_replicated: bool,
) -> (ErrorEstimate, f64) {
    let pixels: Vec<_> = (0..WIDTH * HEIGHT)
        .map(|pixel| sampled(random, sample, spread(samples, pixel), truth(pixel)))
        .collect();
    let blocks = (0..HEIGHT / BLOCK).flat_map(|y| (0..WIDTH / BLOCK).map(move |x| [x, y]));
    let second: Vec<_> = blocks
        .map(|[x, y]| {
            let within = (random.unit() * (BLOCK * BLOCK) as f64) as usize;
            let [x, y] = [x * BLOCK + within % BLOCK, y * BLOCK + within / BLOCK];
            let pixel = y * WIDTH + x;
            let samples = spread(samples, pixel);
            (pixel, sampled(random, sample, samples, truth(pixel)))
        })
        .collect();
    let of = |(pixel, moments)| Sampled {
        moments,
        samples: spread(samples, pixel),
    };
    let firsts: Vec<_> = pixels.iter().enumerate().map(of).collect();
    let replicates: Vec<_> = second
        .iter()
        .map(|(pixel, moments)| Replicate {
            pixel: *pixel,
            sampled: of((*pixel, moments)),
        })
        .collect();
    let stated = ErrorEstimate::of(WIDTH, &firsts, is_replicated.then_some(&replicates[..]));

    let count = (WIDTH * HEIGHT) as f64;
    let colors = |mean: f64| [mean, 0.5 * mean, 0.25 * mean + 0.2];
    let sum: f64 = (0..pixels.len())
        .flat_map(|pixel| colors(truth(pixel)))
        .sum();
    let floor = 1e-2 * (sum / count / 3.0).powi(2);
    let errors = pixels.iter().enumerate().flat_map(|(pixel, moments)| {
        let color = colors(truth(pixel));
        [0, 1, 2].map(|k| {
            let error = moments.mean(spread(samples, pixel))[k] - color[k];
            error * error / (color[k] * color[k] + floor)
        })
    });
    let true_error = errors.sum::<f64>() / count / 3.0;
    (stated.expect("enough samples"), true_error)
}

/// The parts of the images whose interval holds the truth, and the mean of what is stated over the mean of what is true.
fn coverage(sample: Sample, samples: u64, is_replicated: bool) -> (f64, f64) {
    spread_coverage(sample, (samples, |samples, _| samples), is_replicated)
}

fn spread_coverage(sample: Sample, spread: (u64, Spread), is_replicated: bool) -> (f64, f64) {
    let mut random = Random(spread.0);
    let images = 300;
    let (mut held, mut stated, mut truths) = (0, 0.0, 0.0);
    for _ in 0..images {
        let (error, truth) = spread_image(&mut random, sample, spread, is_replicated);
        assert_eq!(error.distrust, None);
        held += u32::from(error.relmse.low <= truth && truth <= error.relmse.high);
        stated += error.relmse.value;
        truths += truth;
    }
    (f64::from(held) / f64::from(images), stated / truths)
}

#[test]
fn intervals_of_independent_samples_hold_the_truth() {
    for samples in [16, 64] {
        let (held, ratio) = coverage(independent, samples, false);
        assert!((0.92..=0.98).contains(&held), "{samples} samples: {held}");
        assert!((ratio - 1.0).abs() < 0.03, "{samples} samples: {ratio}");
    }
}

#[test]
fn intervals_of_well_distributed_samples_hold_the_truth() {
    for samples in [16, 64] {
        let (held, ratio) = coverage(stratified, samples, true);
        assert!(held >= 0.92, "{samples} samples: {held}");
        assert!((ratio - 1.0).abs() < 0.03, "{samples} samples: {ratio}");
    }
}

/// The dark half gets four times the samples of the bright one.
#[test]
fn intervals_of_unequal_numbers_of_samples_hold_the_truth() {
    let spread: Spread = |samples, pixel| {
        let is_dark = pixel % WIDTH < WIDTH / 2;
        if is_dark { 2 * samples } else { samples / 2 }
    };
    for (sample, samples) in [(independent as Sample, 128), (stratified, 64)] {
        let (held, ratio) = spread_coverage(sample, (samples, spread), true);
        assert!((0.92..=0.99).contains(&held), "{samples} samples: {held}");
        assert!((ratio - 1.0).abs() < 0.03, "{samples} samples: {ratio}");
    }
}

#[test]
fn without_replicates_well_distributed_samples_seem_worse_than_they_are() {
    let mut random = Random(1);
    let (blind, truth) = image(&mut random, stratified, 64, false);
    assert!(blind.relmse.value > 5.0 * truth && blind.design_effect == 1.0);
    let (seeing, _) = image(&mut random, stratified, 64, true);
    assert!(seeing.design_effect < 0.05, "{}", seeing.design_effect);
}

/// One sample in a thousand is a thousand times as bright as the rest.
fn rare(random: &mut Random, _: u64, _: u64, mean: f64) -> f64 {
    if random.unit() < 1e-3 {
        500.0 * mean
    } else {
        mean * (0.25 + 0.5 * random.unit())
    }
}

#[test]
fn rare_bright_samples_are_not_trusted() {
    let mut random = Random(3);
    let (error, _) = image(&mut random, rare, 16, false);
    let Some(Distrust::HeavyTails { pixels }) = error.distrust else {
        panic!("{error:?}");
    };
    assert!(pixels < 60.0);
    assert!(
        error
            .distrust
            .unwrap()
            .to_string()
            .contains("no path has found")
    );
}

#[test]
fn equal_samples_have_no_error() {
    let mut random = Random(4);
    let (error, truth) = image(&mut random, |_, _, _, mean| mean, 4, true);
    assert!(truth < 1e-28 && error.relmse.high < 1e-28, "{error:?}");
    assert_eq!(error.distrust, None);
}

#[test]
fn three_samples_say_nothing() {
    let moments = sampled(&mut Random(5), independent, 3, 1.0);
    let pixels = [Sampled {
        moments: &moments,
        samples: 3,
    }; 4];
    assert_eq!(ErrorEstimate::of(2, &pixels, None), None);
    assert_eq!(ErrorEstimate::of(2, &[], None), None);
}
