//! Where the answers to a stream of rays go.

use std::ops::Range;

use crate::ray::Hit;

/// Most rays that are answered together: so many are sorted into packets.
pub(crate) const WINDOW: usize = 256;

/// An answer for each ray of a stream, made of its hit.
pub(crate) trait Answers {
    /// The answer to one ray.
    fn one(&mut self, index: usize, hit: Hit);

    /// The answers to at most [`WINDOW`] rays that follow each other, whose hits `find` writes.
    fn together(&mut self, rays: Range<usize>, find: impl FnOnce(&mut [Hit]));
}

impl Answers for [Hit] {
    #[inline(always)]
    fn one(&mut self, index: usize, hit: Hit) {
        self[index] = hit;
    }

    #[inline(always)]
    fn together(&mut self, rays: Range<usize>, find: impl FnOnce(&mut [Hit])) {
        find(&mut self[rays]);
    }
}

/// Whether there is a hit.
impl Answers for [bool] {
    #[inline(always)]
    fn one(&mut self, index: usize, hit: Hit) {
        self[index] = hit.is_hit();
    }

    #[inline(always)]
    fn together(&mut self, rays: Range<usize>, find: impl FnOnce(&mut [Hit])) {
        let mut hits = [Hit::miss(0.0); WINDOW];
        let hits = &mut hits[..rays.len()];
        find(hits);
        for (occluded, hit) in self[rays].iter_mut().zip(hits) {
            *occluded = hit.is_hit();
        }
    }
}
