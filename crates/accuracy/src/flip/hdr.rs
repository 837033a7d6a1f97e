//! HDR-ꟻLIP: the largest ꟻLIP of each pixel over a range of exposures (Andersson, Nilsson, Shirley, Akenine-Möller 2021,
//! *Visualizing Errors in Rendered High Dynamic Range Images*, section 3).
//!
//! Images are exposed, tone-mapped by a curve that resembles that of ACES, clipped, and compared by ꟻLIP. The range follows
//! from the reference alone, so that all tests are seen alike: from the exposure that maps the largest luminance just below
//! white to the one that does so with the median luminance, with as many exposures as there are stops between them.

use std::thread;

use super::ldr::flip_map;
use super::map::FlipMap;
use crate::luminance::luminance;

/// The tone curve, (a·x² + b·x) / (c·x² + d·x + e): Narkowicz' fit of ACES without its exposure of 0.6.
const CURVE: [f64; 5] = [
    0.6 * 0.6 * 2.51,
    0.6 * 0.03,
    0.6 * 0.6 * 2.43,
    0.6 * 0.59,
    0.14,
];

/// What the luminance is mapped to that an end of the range of exposures is about.
const JUST_BELOW_WHITE: f64 = 0.85;

/// Exposures are compared in parallel; each needs about 150 bytes a pixel.
const MOST_THREADS: usize = 4;

/// Exposures at which images are compared, in stops: at exposure e, radiance is multiplied by 2^e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exposures {
    /// The darkest.
    pub start: f64,
    /// The brightest.
    pub stop: f64,
    /// How many there are, at equal steps: the stops from start to stop, rounded up, and at least two.
    pub count: usize,
}

impl Exposures {
    /// Those for a reference (sections 3.1 and 3.2 of the paper).
    ///
    /// Where most of the reference is black, the paper's brightest exposure would be infinite; the median is then that of the
    /// luminances above 0. A reference that is black throughout is compared as it is.
    pub fn of(reference: &[[f32; 3]]) -> Self {
        let mut luminances: Vec<f64> = reference.iter().map(|&rgb| luminance(rgb)).collect();
        luminances.sort_unstable_by(f64::total_cmp);
        let positive = &luminances[luminances.partition_point(|y| *y <= 0.0)..];
        let (Some(&largest), Some(&positive_median)) =
            (positive.last(), positive.get(positive.len() / 2))
        else {
            return Self {
                start: 0.0,
                stop: 0.0,
                count: 2,
            };
        };
        let median = match luminances[luminances.len() / 2] {
            median if median > 0.0 => median,
            _ => positive_median,
        };
        let white = radiance_shown_as(JUST_BELOW_WHITE);
        let (start, stop) = ((white / largest).log2(), (white / median).log2());
        Self {
            start,
            stop,
            count: ((stop - start).ceil() as usize).max(2),
        }
    }

    /// The exposures from `start` to `stop`.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        let step = (self.stop - self.start) / (self.count - 1) as f64;
        let start = self.start;
        (0..self.count).map(move |k| start + k as f64 * step)
    }
}

/// HDR-ꟻLIP of an image against a reference.
#[derive(Clone, Debug, PartialEq)]
pub struct HdrFlip {
    /// Of each pixel the largest error over the exposures.
    pub map: FlipMap,
    /// The exposures.
    pub exposures: Exposures,
}

impl HdrFlip {
    /// Compares linear images, row by row. Negative radiance is shown as black.
    ///
    /// # Panics
    /// If the images are not `width` wide and equally high.
    pub fn of(reference: &[[f32; 3]], test: &[[f32; 3]], width: usize) -> Self {
        let exposures = Exposures::of(reference);
        let all: Vec<f64> = exposures.iter().collect();
        let threads = thread::available_parallelism()
            .map_or(1, usize::from)
            .min(MOST_THREADS)
            .min(all.len());
        let maximum = |exposures: &mut dyn Iterator<Item = &f64>| -> FlipMap {
            let shown = |image: &[[f32; 3]], exposure: f64| -> Vec<[f32; 3]> {
                let factor = exposure.exp2();
                let tone = |c: f32| tone_mapped(f64::from(c) * factor) as f32;
                image.iter().map(|rgb| rgb.map(tone)).collect()
            };
            let mut maximum = FlipMap::new(vec![0.0; reference.len()]);
            for &exposure in exposures {
                let (reference, test) = (shown(reference, exposure), shown(test, exposure));
                maximum.raise_to(&flip_map(&reference, &test, width));
            }
            maximum
        };
        // Which thread compares at which exposure does not matter to the maximum.
        let maps = thread::scope(|scope| {
            let handles: Vec<_> = (0..threads)
                .map(|k| {
                    let (all, maximum) = (&all, &maximum);
                    scope.spawn(move || maximum(&mut all.iter().skip(k).step_by(threads)))
                })
                .collect();
            let joined = handles.into_iter().map(|handle| {
                handle
                    .join()
                    .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            });
            joined.collect::<Vec<_>>()
        });
        let mut map = FlipMap::new(vec![0.0; reference.len()]);
        for part in &maps {
            map.raise_to(part);
        }
        Self { map, exposures }
    }
}

fn tone_mapped(radiance: f64) -> f64 {
    let [a, b, c, d, e] = CURVE;
    let x = radiance.max(0.0);
    // Beyond the range of floating-point numbers is white.
    let mapped = x * (a * x + b) / (x * (c * x + d) + e);
    if mapped.is_nan() {
        1.0
    } else {
        mapped.min(1.0)
    }
}

/// The inverse of the curve: the larger root of (a − t·c)·x² + (b − t·d)·x − t·e.
fn radiance_shown_as(t: f64) -> f64 {
    let [a, b, c, d, e] = CURVE;
    let (square, half, constant) = (a - t * c, 0.5 * (b - t * d), -t * e);
    (-half + (half * half - square * constant).sqrt()) / square
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(f: impl Fn(f64, f64) -> [f64; 3]) -> Vec<[f32; 3]> {
        let pixel = |k: usize| f((k % 61) as f64, (k / 61) as f64).map(|c| c as f32);
        (0..61 * 47).map(pixel).collect()
    }

    /// A light in a dim room.
    fn glow(x: f64, y: f64) -> [f64; 3] {
        let wave = |f: f64| 0.5 + 0.5 * (f * x + 0.3 * y).sin();
        let light = 200.0 / (1.0 + (x - 20.0).powi(2) + (y - 30.0).powi(2));
        let room = [0.31, 0.17, 0.07].map(|f| 0.02 + 0.3 * wave(f));
        [
            room[0] + light,
            room[1] + 0.6 * light,
            room[2] + 0.2 * light,
        ]
    }

    /// Numbers of the authors' own program (flip-evaluator 1.7, HDR).
    #[test]
    fn the_authors_numbers() {
        let reference = image(glow);
        let exposures = Exposures::of(&reference);
        assert!((exposures.start - -5.954_422_95).abs() < 1e-5);
        assert!((exposures.stop - 2.250_751_26).abs() < 1e-5);
        assert_eq!(exposures.count, 9);
        let brighter = image(|x, y| glow(x, y).map(|c| 1.1 * c + 0.01));
        let moved = image(|x, y| glow(x + 0.5, y));
        let dotted = image(|x, y| {
            let dot = x % 9.0 == 4.0 && y % 7.0 == 3.0;
            if dot { [30.0, 1.0, 0.1] } else { glow(x, y) }
        });
        for (test, mean, largest) in [
            (&brighter, 0.176_170_8, 0.261_005_5),
            (&moved, 0.102_259_0, 0.310_157_4),
            (&dotted, 0.127_685_2, 0.610_818_3),
        ] {
            let ours = HdrFlip::of(&reference, test, 61).map;
            assert!((ours.mean() - mean).abs() < 2e-4, "{} {mean}", ours.mean());
            let most = ours.values().iter().copied().fold(0.0, f64::max);
            assert!((most - largest).abs() < 1e-3, "{most} {largest}");
        }
    }

    #[test]
    fn the_range_of_exposures_shows_the_largest_and_the_median_luminance_just_below_white() {
        let reference = image(glow);
        let mut luminances: Vec<_> = reference.iter().map(|&rgb| luminance(rgb)).collect();
        luminances.sort_by(f64::total_cmp);
        let (median, largest) = (luminances[61 * 47 / 2], luminances[61 * 47 - 1]);
        let exposures = Exposures::of(&reference);
        let shown = |luminance: f64, exposure: f64| tone_mapped(luminance * exposure.exp2());
        assert!((shown(largest, exposures.start) - 0.85).abs() < 1e-9);
        assert!((shown(median, exposures.stop) - 0.85).abs() < 1e-9);
        let all: Vec<_> = exposures.iter().collect();
        assert_eq!(all.len(), 9);
        assert!((all[1] - all[0] - (exposures.stop - exposures.start) / 8.0).abs() < 1e-12);
        assert!((all[8] - exposures.stop).abs() < 1e-9);
    }

    /// Images that are both so much brighter are exposed so much less; a test that alone is brighter is not.
    #[test]
    fn the_unit_of_radiance_does_not_matter() {
        let (reference, test) = (image(glow), image(|x, y| glow(x + 0.5, y)));
        let brighter = |image: &[[f32; 3]]| -> Vec<_> {
            image.iter().map(|rgb| rgb.map(|c| 64.0 * c)).collect()
        };
        let a = HdrFlip::of(&reference, &test, 61).map.mean();
        let b = HdrFlip::of(&brighter(&reference), &brighter(&test), 61);
        assert!((a - b.map.mean()).abs() < 1e-6, "{a} {}", b.map.mean());
        assert!(HdrFlip::of(&reference, &brighter(&test), 61).map.mean() > 2.0 * a);
    }

    #[test]
    fn black_references_have_exposures() {
        let mut reference = vec![[0.0; 3]; 12];
        let of = |reference: &[[f32; 3]]| Exposures::of(reference);
        assert_eq!(of(&reference).iter().collect::<Vec<_>>(), [0.0, 0.0]);
        reference[3] = [2.0; 3];
        let exposures = of(&reference);
        assert!(exposures.stop.is_finite() && exposures.start == exposures.stop);
        assert_eq!(HdrFlip::of(&reference, &reference, 4).map.mean(), 0.0);
        assert_eq!([f64::MAX, -1.0].map(tone_mapped), [1.0, 0.0]);
    }

    #[test]
    fn hdr_flip_sees_what_a_screen_clips() {
        let reference = vec![[3.0; 3]; 100];
        let test = vec![[6.0; 3]; 100];
        assert!(flip_map(&reference, &test, 10).mean() < 1e-6);
        assert!(HdrFlip::of(&reference, &test, 10).map.mean() > 0.1);
    }
}
