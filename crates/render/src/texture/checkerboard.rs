//! A checkerboard, the simplest procedural texture (thesis, section 3.1).

use super::{ColorSource, UvMap};
use crate::domain::{Bundle, Domain};
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// Squares of side 1 in two colours; the one from the origin of the coordinates to (1, 1) is even.
#[derive(Clone, Copy, Debug)]
pub struct Checkerboard<A, B> {
    /// Where the sum of a square's coordinates is even.
    pub even: A,
    /// Where it is odd.
    pub odd: B,
    /// Coordinates.
    pub uv: UvMap,
}

impl<D: Domain, A: ColorSource<D>, B: ColorSource<D>> ColorSource<D> for Checkerboard<A, B> {
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        let [u, v] = self.uv.apply(d, surface);
        let half = (d.floor(u) + d.floor(v)) * d.lit(0.5);
        let is_odd = d.lt(d.floor(half), half);
        let (even, odd) = (self.even.color(d, surface), self.odd.color(d, surface));
        Vec3::choose(d, is_odd, odd, even)
    }
}
