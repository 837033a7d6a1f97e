//! Traversal of any precision.

use residual_bvh::{Exact, Fast};
use residual_device_cpu::{AnyBvh, Traversal};

/// The tests of triangles that `residual_bvh` has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraversalPrecision {
    /// Plain Möller and Trumbore in `f32`.
    Fast,
    /// Edges belong to both triangles.
    Watertight,
    /// Decisions as in exact arithmetic.
    Exact,
}

impl TraversalPrecision {
    /// Traces rays through a hierarchy with it.
    pub fn of<'a>(self, bvh: &'a AnyBvh) -> Box<dyn Traversal + Sync + 'a> {
        match self {
            Self::Fast => Box::new(bvh.with_precision(Fast)),
            // The device's own, which is compiled already.
            Self::Watertight => Box::new(bvh),
            Self::Exact => Box::new(bvh.with_precision(Exact)),
        }
    }
}
