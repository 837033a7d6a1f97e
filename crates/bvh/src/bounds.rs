//! Axis-aligned boxes, and the padded box that the builder and the triangle test must agree on.
//!
//! The triangle test (`precision/watertight.rs`) rounds vertices relative to the ray, so it may
//! accept a ray that passes the triangle's exact box at a distance of a few roundings, and place
//! the hit a little outside of it. If a node's box then turned the ray away, or was thought to lie
//! behind a farther hit, a closed mesh would have a hole, or the answer would depend on the tree.
//!
//! With `p - q` the three weights before division, `K = Σ(|p| + |q|) / |Σ(p - q)|` and `X` the
//! greatest distance from the ray to a corner across its direction, the weights' roundings move the
//! hit across the ray by at most `2 u K X`, `u = 2⁻²⁴`; and `X` is at most twice the triangle's
//! extent where the ray passes inside. All other roundings are relative to the distance and to the
//! coordinates. So:
//! - a triangle's box is padded by 2⁻¹⁶ of its extent, twice what `K = 32` needs, and by one unit in
//!   the last place of its coordinates; the slab test's own slack (`trace/slab.rs`) covers the distance;
//! - a hit with a greater `K`, on a triangle seen edge-on, is moved to where the ray passes through
//!   its padded box, computed with less slack than the nodes' boxes get.
//!
//! Hence every box containing the padded box is entered no later than `t` and left no earlier:
//! neither culling nor pruning can lose a hit, in whatever order the tree is walked. Split
//! references hold a part of the padded box only. A well-conditioned hit lies within the pad of
//! the part that it is in; for the ill-conditioned the argument fails, which takes another surface
//! at nearly the same distance to show.

use crate::ray::Ray;

/// An axis-aligned box; empty when `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub lo: [f32; 3],
    /// Greatest coordinates.
    pub hi: [f32; 3],
}

/// Padding relative to the triangle's greatest extent.
const PAD_EXTENT: f32 = 1.0 / (1 << 16) as f32;
/// Padding relative to the coordinate itself: at least one unit in the last place.
const PAD_COORDINATE: f32 = f32::EPSILON;

impl Bounds {
    /// Products of two sums of some such numbers are finite.
    pub(crate) const MODERATE: f32 = (1u64 << 60) as f32;

    /// The box that contains nothing.
    pub const EMPTY: Bounds = Bounds {
        lo: [f32::INFINITY; 3],
        hi: [f32::NEG_INFINITY; 3],
    };

    /// The smallest box around both.
    #[must_use]
    pub fn union(&self, other: &Bounds) -> Bounds {
        Bounds {
            lo: std::array::from_fn(|axis| self.lo[axis].min(other.lo[axis])),
            hi: std::array::from_fn(|axis| self.hi[axis].max(other.hi[axis])),
        }
    }

    /// Whether all coordinates are so far from overflow that products of two differences are finite. The empty box is.
    pub(crate) fn is_moderate(&self) -> bool {
        (0..3).all(|axis| self.lo[axis] > -Bounds::MODERATE && self.hi[axis] < Bounds::MODERATE)
    }

    /// Whether `other` lies inside; the empty box lies inside every box.
    pub fn contains(&self, other: &Bounds) -> bool {
        (0..3).all(|axis| self.lo[axis] <= other.lo[axis] && self.hi[axis] >= other.hi[axis])
    }

    /// Half the surface area, in `f64` so that finite boxes cannot overflow it.
    pub fn half_area(&self) -> f64 {
        let finite = |x: f32| x.clamp(f32::MIN, f32::MAX) as f64;
        let [x, y, z] =
            [0, 1, 2].map(|axis| (finite(self.hi[axis]) - finite(self.lo[axis])).max(0.0));
        x * y + y * z + z * x
    }

    /// The smallest box around the triangle.
    pub(crate) fn of_triangle(vertices: &[[f32; 3]; 3]) -> Bounds {
        let [a, b, c] = vertices;
        Bounds {
            lo: std::array::from_fn(|axis| a[axis].min(b[axis]).min(c[axis])),
            hi: std::array::from_fn(|axis| a[axis].max(b[axis]).max(c[axis])),
        }
    }

    /// This box, exact around a triangle or a part of one, padded as for a triangle whose greatest
    /// extent is `extent`.
    #[must_use]
    pub(crate) fn padded(&self, extent: f32) -> Bounds {
        let pad = |x: f32| extent * PAD_EXTENT + x.abs() * PAD_COORDINATE;
        Bounds {
            lo: self.lo.map(|x| x - pad(x)),
            hi: self.hi.map(|x| x + pad(x)),
        }
    }

    /// The padded box of a triangle.
    pub(crate) fn of_padded_triangle(vertices: &[[f32; 3]; 3]) -> Bounds {
        let bounds = Bounds::of_triangle(vertices);
        bounds.padded(bounds.extent())
    }

    /// Where the ray's line enters and leaves the box, with half the slab test's slack: no earlier
    /// and no later than the slab test finds for any box around this one. Behind the origin the
    /// slack points the wrong way, which nobody asks about.
    pub(crate) fn passage(&self, ray: &Ray) -> (f32, f32) {
        const SLACK: f32 = 1.0 / (1 << 21) as f32;
        let (mut entry, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
        for axis in 0..3 {
            let inv = 1.0 / ray.dir[axis];
            let planes = [self.lo[axis], self.hi[axis]];
            let [near, far] = if ray.dir[axis].is_sign_negative() {
                [planes[1], planes[0]]
            } else {
                planes
            };
            // In a plane of the box, 0 · ∞ is NaN, which `max` and `min` drop.
            entry = entry.max((near - ray.org[axis]) * inv * (1.0 - SLACK));
            exit = exit.min((far - ray.org[axis]) * inv * (1.0 + SLACK));
        }
        (entry, exit)
    }

    /// Greatest extent along an axis; may overflow to infinity, which pads to infinity.
    pub(crate) fn extent(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.hi[axis] - self.lo[axis]);
        x.max(y).max(z)
    }
}
