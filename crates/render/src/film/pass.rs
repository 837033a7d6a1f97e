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
