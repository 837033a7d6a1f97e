//! A pass of samples, and what a tile gets of it.

use super::rect::TileRect;

/// The samples of one pass, for every pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Pass {
    /// Index of the first.
    pub first: u32,
    /// How many.
    pub count: u32,
}

impl Pass {
    /// The first of the samples, as long as they are of some kind, and the others.
    pub fn split_while(self, is_of_kind: impl Fn(u32) -> bool) -> (Self, Self) {
        let Self { first, count } = self;
        let samples = first..first + count;
        let now = samples.take_while(|&sample| is_of_kind(sample)).count() as u32;
        let later = Self {
            first: first + now,
            count: count - now,
        };
        (Self { first, count: now }, later)
    }
}

/// Which samples of which pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct TileSamples {
    /// The pixels.
    pub rect: TileRect,
    /// The samples of each.
    pub pass: Pass,
}

impl TileSamples {
    /// How many samples there are in all.
    pub fn count(&self) -> usize {
        self.rect.area() * self.pass.count as usize
    }
}
