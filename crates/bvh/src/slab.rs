//! One ray against `N` boxes: the slab test, conservative under rounding.
//!
//! T. Ize, "Robust BVH Ray Traversal", JCGT 2(2), 2013. Three details matter:
//! - `(plane - org) * inverse` and not `plane * inverse - org * inverse`: the latter cancels.
//! - The slack is folded into the inverse. The product carries three roundings of 2⁻²⁴, four more
//!   if the inverse is subnormal; the rest of the 2⁻²⁰ covers the roundings of vertices relative to
//!   the origin in the triangle test.
//! - A ray lying in a plane of a box yields 0 · ∞ = NaN for it. Dropping NaN enters the boxes on
//!   both sides of the plane.

use crate::bvh::Node;
use crate::{Lanes, Ray};

const SLACK: f32 = 1.0 / (1 << 20) as f32;

/// A ray prepared for slab tests. Distances are in units of its direction.
pub(crate) struct SlabRay<S: Lanes<N>, const N: usize> {
    /// `[axis]`
    org: [S::Float; 3],
    /// Inverse direction towards the entry and exit planes, `[axis]`, slack included.
    inv_near: [S::Float; 3],
    inv_far: [S::Float; 3],
    /// Whether the direction is negative: then boxes are entered through their upper planes.
    negative: [bool; 3],
    tmin: S::Float,
}

impl<S: Lanes<N>, const N: usize> SlabRay<S, N> {
    /// `tmin` must not be negative: the slack would then point the wrong way.
    #[inline(always)]
    pub(crate) fn new(simd: S, ray: &Ray, tmin: f32) -> SlabRay<S, N> {
        let inv = [1.0 / ray.dir[0], 1.0 / ray.dir[1], 1.0 / ray.dir[2]];
        let splat = |x: [f32; 3]| [simd.splat(x[0]), simd.splat(x[1]), simd.splat(x[2])];
        let scaled = |s: f32| splat([inv[0] * s, inv[1] * s, inv[2] * s]);
        SlabRay {
            org: splat(ray.org),
            inv_near: scaled(1.0 - SLACK),
            inv_far: scaled(1.0 + SLACK),
            negative: [inv[0] < 0.0, inv[1] < 0.0, inv[2] < 0.0],
            tmin: simd.splat(tmin),
        }
    }

    /// Where the ray enters and leaves the node's boxes, within `[tmin, tmax]`; it touches those
    /// with `entry <= exit`.
    #[inline(always)]
    pub(crate) fn node_interval(
        &self,
        simd: S,
        node: &Node<N>,
        tmax: S::Float,
    ) -> (S::Float, S::Float) {
        let mut entry = self.tmin;
        let mut exit = tmax;
        for axis in 0..3 {
            let near = 2 * axis + self.negative[axis] as usize;
            // SAFETY: axis is at most 2 and a bool at most 1, so near is at most 5; flipping the
            // low bit of a number in 0..6 stays in 0..6.
            let (near, far) = unsafe {
                (
                    node.bounds.get_unchecked(near),
                    node.bounds.get_unchecked(near ^ 1),
                )
            };
            let near = simd.mul(
                simd.sub(simd.load(near), self.org[axis]),
                self.inv_near[axis],
            );
            let far = simd.mul(simd.sub(simd.load(far), self.org[axis]), self.inv_far[axis]);
            entry = simd.max_number(near, entry);
            exit = simd.min_number(far, exit);
        }
        (entry, exit)
    }

    /// Where the ray's line enters and leaves the boxes `[lo, hi]`, `[axis]` each, with the node
    /// test's roundings. Not clipped to the ray's interval; behind the origin the slack points the
    /// wrong way, which nobody asks about.
    #[inline(always)]
    pub(crate) fn box_interval(
        &self,
        simd: S,
        lo: [S::Float; 3],
        hi: [S::Float; 3],
    ) -> (S::Float, S::Float) {
        let mut entry = simd.splat(f32::NEG_INFINITY);
        let mut exit = simd.splat(f32::INFINITY);
        for axis in 0..3 {
            let (near, far) = if self.negative[axis] {
                (hi[axis], lo[axis])
            } else {
                (lo[axis], hi[axis])
            };
            let near = simd.mul(simd.sub(near, self.org[axis]), self.inv_near[axis]);
            let far = simd.mul(simd.sub(far, self.org[axis]), self.inv_far[axis]);
            entry = simd.max_number(near, entry);
            exit = simd.min_number(far, exit);
        }
        (entry, exit)
    }
}

#[cfg(test)]
mod tests;
