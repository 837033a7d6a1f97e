//! The error of an image whose samples come from anywhere: here, how much of each pixel lies in a disc.
//!
//! `cargo run --release --package residual-accuracy --example any_samples`

use residual_accuracy::{ErrorEstimate, PixelMoments, SampleIndex, Sampled};

const SIDE: usize = 512;
const SAMPLES: u64 = 64;

fn main() {
    let mut random = 1_u64;
    let mut unit = || {
        random = random
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (random >> 40) as f64 / (1_u64 << 24) as f64
    };
    let mut pixels = vec![PixelMoments::default(); SIDE * SIDE];
    for index in 0..SAMPLES {
        let at = SampleIndex::new(index);
        for (place, pixel) in pixels.iter_mut().enumerate() {
            let [x, y] =
                [place % SIDE, place / SIDE].map(|p| (p as f64 + unit()) / SIDE as f64 - 0.5);
            let value = if x.hypot(y) < 0.4 { 1.0 } else { 0.1 };
            pixel.add([value; 3], at);
        }
    }
    let sampled: Vec<_> = pixels
        .iter()
        .map(|moments| Sampled {
            moments,
            samples: SAMPLES,
        })
        .collect();
    let start = std::time::Instant::now();
    // Samples are independent, so that no pixel needs a second set.
    let error = ErrorEstimate::of(SIDE, &sampled, None).expect("at least four samples a pixel");
    println!("estimated in {:.0} ms", 1e3 * start.elapsed().as_secs_f64());
    let [low, middle, high] = [error.relmse.low, error.relmse.value, error.relmse.high]
        .map(|relmse| 100.0 * relmse.sqrt());
    println!("relative error {middle:.3} % ({low:.3} to {high:.3} % with 95 % confidence)");
    match error.distrust {
        Some(reason) => println!("not to be trusted: {reason}"),
        None => println!("nothing speaks against it"),
    }
}
