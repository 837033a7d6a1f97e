//! What the kernels read of a packet of `P` triangles, stored corner by corner ([`crate::TrianglePacket`]) or on
//! vertices that they share ([`crate::CompactPacket`]).

use std::fmt::Debug;

use crate::simd::Width;

/// A layout of packets that the kernels can test: [`TrianglePacket`](crate::TrianglePacket) and
/// [`CompactPacket`](crate::CompactPacket), and nothing else.
pub trait Packet<const P: usize>: sealed::Sealed + Copy + Debug + Send + Sync {
    /// Triangle indices, of which the high bit marks a triangle as single-sided; all bits of an unused lane are set.
    /// Those that are used come first.
    fn prim_ids(&self) -> &[u32; P];

    /// One coordinate of a corner of a triangle, which must be in a lane that is used.
    fn coordinate(&self, lane: usize, corner: usize, axis: usize) -> f32;

    /// The corners of that triangle.
    #[inline(always)]
    fn corners(&self, lane: usize) -> [[f32; 3]; 3] {
        [0, 1, 2].map(|corner| [0, 1, 2].map(|axis| self.coordinate(lane, corner, axis)))
    }

    /// The lanes that hold a triangle, as bits; more may be set where NaN coordinates alone keep rays out.
    fn used<S: Width<P>>(&self, simd: S) -> u32;

    /// The three corners, a triangle a lane, after `moved` was applied to points, which it gets `[axis][lane]`.
    fn in_lanes<S: Width<P>>(
        &self,
        simd: S,
        moved: impl Fn(&[[f32; P]; 3]) -> [S::Float; 3],
    ) -> [[S::Float; 3]; 3];
}

pub(crate) mod sealed {
    /// Keeps other layouts out.
    pub trait Sealed {}
}
