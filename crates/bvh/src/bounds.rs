//! Axis-aligned boxes, and the padded box that the builder and the triangle test must agree on.
//!
//! The triangle test (`triangle.rs`) rounds vertices relative to the ray, so it may accept a ray
//! that passes the triangle's exact box at a distance of a few roundings. If a node's box then
//! turned the ray away, a closed mesh would have a hole, and the answer would depend on the tree.
//! Two measures prevent it:
//! - a triangle's box is padded by one unit in the last place of its coordinates and by 2⁻²² of its
//!   extent, which exceeds the rounding of the edge functions;
//! - the triangle test accepts a hit only inside this padded box and clamps `t` to the ray's
//!   passage through it, with the node test's own arithmetic. That arithmetic is monotone, so every
//!   box containing the padded box is entered no later than `t`: neither culling nor pruning can
//!   lose a hit, in whatever order the tree is walked.
//!
//! The second argument needs the whole padded box inside every ancestor. Split references
//! (`spatial.rs`) hold a part of it only; there it fails when rounding moves `t` out of the part,
//! which takes a triangle seen edge-on and another surface at the same distance.

/// An axis-aligned box; empty when `lo > hi`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub lo: [f32; 3],
    /// Greatest coordinates.
    pub hi: [f32; 3],
}

/// Padding relative to the triangle's greatest extent.
pub(crate) const PAD_EXTENT: f32 = 1.0 / (1 << 22) as f32;
/// Padding relative to the coordinate itself: at least one unit in the last place.
pub(crate) const PAD_COORDINATE: f32 = f32::EPSILON;

impl Bounds {
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
    /// extent is `extent`. `triangle.rs` computes the same in vector lanes, bit for bit.
    #[must_use]
    pub(crate) fn padded(&self, extent: f32) -> Bounds {
        let pad = |x: f32| extent * PAD_EXTENT + x.abs() * PAD_COORDINATE;
        Bounds {
            lo: self.lo.map(|x| x - pad(x)),
            hi: self.hi.map(|x| x + pad(x)),
        }
    }

    /// Greatest extent along an axis; may overflow to infinity, which pads to infinity.
    pub(crate) fn extent(&self) -> f32 {
        let [x, y, z] = [0, 1, 2].map(|axis| self.hi[axis] - self.lo[axis]);
        x.max(y).max(z)
    }
}
