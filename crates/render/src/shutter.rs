//! An open shutter: the moments between its opening and its closing at which a scene is seen, and which sample sees which.
//!
//! Passes are spread over the moments, as an accumulation buffer's are (Haeberli and Akeley 1990, "The Accumulation Buffer:
//! Hardware Support for High-Quality Rendering"): all rays of a sample of every pixel are of one moment, so that formulas and
//! traversal know no time. Moments follow one another in the order of van der Corput, so that those of the first samples, however
//! many, are spread over the whole time; and they are turned by a random part of it (Cranley and Patterson 1976), so that the
//! mean over seeds is that over all times.

use crate::domain::{Buffers, Scalar, Uint};
use crate::sampler::hash;

/// The moments while a shutter is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    count: u32,
    /// The moment of the first sample.
    first: u32,
    /// Where in its share of the time each moment is, in [0, 1).
    within: f64,
}

impl Moments {
    /// More would be more hierarchies than are of use.
    pub const MOST: u32 = 1 << 10;

    /// So many moments, a power of two up to [`Moments::MOST`], for a render with this seed; `None` for another number.
    pub fn new(count: u32, seed: u32) -> Option<Self> {
        if !count.is_power_of_two() || count > Self::MOST {
            return None;
        }
        let d = Scalar::new(&Buffers::EMPTY);
        // Far from the seeds of samplers, which are hashed likewise.
        let Uint(turn) = hash(d, hash(d, Uint(seed ^ 0x7f4a_7c15)));
        // The upper bits choose the moment, those below them where in its share it is.
        let turned = f64::from(turn) / 4_294_967_296.0 * f64::from(count);
        Some(Self {
            count,
            first: turned as u32,
            within: turned.fract(),
        })
    }

    /// How many there are.
    pub fn count(&self) -> u32 {
        self.count
    }

    /// When they are, in order, as parts of the time from opening to closing.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        let (count, within) = (f64::from(self.count), self.within);
        (0..self.count).map(move |moment| (f64::from(moment) + within) / count)
    }

    /// The moment that a sample of a pixel sees. Any `count` samples in a row that begin with a multiple of it see all, and so
    /// do the even ones of twice as many, and the odd ones: an estimate that compares the two halves finds no difference in time.
    pub fn of_sample(&self, sample: u32) -> u32 {
        let bits = self.count.trailing_zeros();
        if bits == 0 {
            return 0;
        }
        let (round, place) = (sample >> bits, sample & (self.count - 1));
        // Two samples that follow each other see moments that are half of the time apart. Which of them comes first changes from
        // pair to pair (by the sequence of Thue and Morse) and from round to round.
        let place = place ^ (((place >> 1).count_ones() + round) & 1);
        let spread = place.reverse_bits() >> (u32::BITS - bits);
        (spread + self.first) & (self.count - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moments(count: u32, seed: u32) -> Moments {
        Moments::new(count, seed).expect("a power of two")
    }

    #[test]
    fn numbers_are_powers_of_two() {
        for count in [0, 3, 12, 2048] {
            assert_eq!(Moments::new(count, 0), None, "{count}");
        }
        assert_eq!(moments(1, 3).of_sample(7), 0);
    }

    #[test]
    fn all_moments_are_seen_as_often_by_both_halves() {
        for (count, seed) in [(2, 0), (4, 1), (16, 2), (64, 3)] {
            let moments = moments(count, seed);
            let seen = |samples: &mut dyn Iterator<Item = u32>| {
                let mut seen: Vec<u32> = samples.map(|s| moments.of_sample(s)).collect();
                seen.sort_unstable();
                seen
            };
            let all: Vec<u32> = (0..count).collect();
            for round in 0..4 {
                assert_eq!(seen(&mut (round * count..(round + 1) * count)), all);
            }
            for half in 0..2 {
                let both_rounds = (0..2 * count).filter(|s| s % 2 == half);
                assert_eq!(seen(&mut both_rounds.into_iter()), all);
            }
        }
    }

    #[test]
    fn every_prefix_covers_the_time_about_evenly() {
        let moments = moments(64, 5);
        let times: Vec<f64> = moments.times().collect();
        for samples in [2, 4, 8, 16, 32] {
            let mut seen: Vec<f64> = (0..samples)
                .map(|s| times[moments.of_sample(s) as usize])
                .collect();
            seen.sort_unstable_by(f64::total_cmp);
            let round = seen[0] + 1.0 - seen[seen.len() - 1];
            let gaps = seen.windows(2).map(|pair| pair[1] - pair[0]);
            for gap in gaps.chain([round]) {
                assert!((gap - 1.0 / f64::from(samples)).abs() < 1e-12, "{seen:?}");
            }
        }
    }

    /// The mean over seeds of a function of the time is its integral, for each sample alone.
    #[test]
    fn every_sample_is_right_on_average() {
        const SEEDS: u32 = 4096;
        for sample in [0, 1, 6] {
            let square = |seed| {
                let moments = moments(8, seed);
                let time = moments.times().nth(moments.of_sample(sample) as usize);
                let time = time.expect("a moment");
                assert!((0.0..1.0).contains(&time));
                time * time
            };
            let mean = (0..SEEDS).map(square).sum::<f64>() / f64::from(SEEDS);
            // The standard deviation of t² is 0.3.
            assert!((mean - 1.0 / 3.0).abs() < 4.0 * 0.3 / 64.0, "{mean}");
        }
    }
}
