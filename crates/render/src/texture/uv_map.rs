//! Texture coordinates as a texture reads them.

use super::params::TransformParam;
use crate::domain::{Buffer, Domain};
use crate::math::Vec3;
use crate::surface::Surface;

/// Which texture coordinates are read, and through which affine map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvMap {
    /// 0 or 1.
    pub set: usize,
    /// Offset of a [`TransformParam`] in the parameter block. `None` is the identity.
    pub transform: Option<u32>,
}

impl UvMap {
    #[inline(always)]
    pub(super) fn apply<D: Domain>(&self, d: D, surface: &Surface<D>) -> [D::F; 2] {
        let [u, v] = surface.uv[self.set];
        match self.transform {
            None => [u, v],
            Some(offset) => {
                let first = surface.params + d.uint(offset);
                let transform = TransformParam::load_at(d, Buffer::Params, first);
                let apply = |row: Vec3<D::F>| d.fma(row.x, u, d.fma(row.y, v, row.z));
                [apply(transform.u), apply(transform.v)]
            }
        }
    }

    /// The area of the coordinates that are read over the area in the world.
    #[inline(always)]
    pub(super) fn area<D: Domain>(&self, d: D, surface: &Surface<D>) -> D::F {
        let area = surface.footprint.uv_areas[self.set];
        match self.transform {
            None => area,
            Some(offset) => {
                let first = surface.params + d.uint(offset);
                let TransformParam { u, v } = TransformParam::load_at(d, Buffer::Params, first);
                area * d.abs(u.x * v.y - u.y * v.x)
            }
        }
    }
}
