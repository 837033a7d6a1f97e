//! What the leaves of the trees refer to.

use crate::bounds::Bounds;

/// A triangle's index and a padded box around the triangle, or around a part of it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reference {
    pub(crate) prim: u32,
    pub(crate) bounds: Bounds,
}
