//! A packet of triangles: their corners in columns.

use std::mem::{align_of, offset_of, size_of};

use crate::layout::packet::Packet;
use crate::layout::packet::sealed::Sealed;
use crate::simd::Width;

/// Marks a triangle index as single-sided.
pub(crate) const SINGLE_SIDED: u32 = 1 << 31;

/// `P` triangles, or fewer: unused lanes have NaN vertices, which nothing hits.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub struct TrianglePacket<const P: usize> {
    /// Corners, `[vertex][axis][lane]`.
    pub vertices: [[[f32; P]; 3]; 3],
    /// Triangle indices; the high bit marks a triangle as single-sided.
    pub prim_ids: [u32; P],
}

/// Bytes: whole cache lines.
macro_rules! assert_layout {
    ($p:literal: $size:literal, prim_ids at $offset:literal) => {
        const _: () = assert!(
            size_of::<TrianglePacket<$p>>() == $size
                && align_of::<TrianglePacket<$p>>() == 64
                && offset_of!(TrianglePacket<$p>, prim_ids) == $offset
        );
    };
}
assert_layout!(1: 64, prim_ids at 36);
assert_layout!(4: 192, prim_ids at 144);
assert_layout!(8: 320, prim_ids at 288);
assert_layout!(16: 640, prim_ids at 576);

impl<const P: usize> TrianglePacket<P> {
    /// A packet without triangles. NaN fails every comparison, so that unused lanes do not defeat
    /// the kernel's early way out as degenerate zeros would.
    pub(crate) const VACANT: TrianglePacket<P> = TrianglePacket {
        vertices: [[[f32::NAN; P]; 3]; 3],
        prim_ids: [u32::MAX; P],
    };

    /// Writes the corners of one lane.
    pub(crate) fn set_corners(&mut self, lane: usize, corners: [[f32; 3]; 3]) {
        for (rows, corner) in self.vertices.iter_mut().zip(corners) {
            for (row, coordinate) in rows.iter_mut().zip(corner) {
                row[lane] = coordinate;
            }
        }
    }
}

impl<const P: usize> Sealed for TrianglePacket<P> {}

impl<const P: usize> Packet<P> for TrianglePacket<P> {
    #[inline(always)]
    fn prim_ids(&self) -> &[u32; P] {
        &self.prim_ids
    }

    #[inline(always)]
    fn coordinate(&self, lane: usize, corner: usize, axis: usize) -> f32 {
        self.vertices[corner % 3][axis % 3][lane % P]
    }

    #[inline(always)]
    fn used<S: Width<P>>(&self, _: S) -> u32 {
        u32::MAX
    }

    #[inline(always)]
    fn in_lanes<S: Width<P>>(
        &self,
        _: S,
        moved: impl Fn(&[[f32; P]; 3]) -> [S::Float; 3],
    ) -> [[S::Float; 3]; 3] {
        let [a, b, c] = &self.vertices;
        [moved(a), moved(b), moved(c)]
    }
}
