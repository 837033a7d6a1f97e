//! Orthonormal frames.

use super::vec3::{Vec3, vec3};
use crate::domain::Domain;

/// A right-handed orthonormal frame. Local z is the normal.
#[derive(Clone, Copy, Debug)]
pub struct Frame<F> {
    /// Local x.
    pub tangent: Vec3<F>,
    /// Local y.
    pub bitangent: Vec3<F>,
    /// Local z.
    pub normal: Vec3<F>,
}

impl<F: crate::domain::Real> Frame<F> {
    /// A frame around a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[inline(always)]
    pub fn around<D: Domain<F = F>>(d: D, n: Vec3<F>) -> Self {
        let sign = d.copysign(d.lit(1.0), n.z);
        let a = d.lit(-1.0) / (sign + n.z);
        let b = n.x * n.y * a;
        Self {
            tangent: vec3(d.lit(1.0) + sign * n.x * n.x * a, sign * b, -(sign * n.x)),
            bitangent: vec3(b, sign + n.y * n.y * a, -n.y),
            normal: n,
        }
    }

    /// World to local.
    #[inline(always)]
    pub fn to_local<D: Domain<F = F>>(&self, d: D, v: Vec3<F>) -> Vec3<F> {
        vec3(
            v.dot(d, self.tangent),
            v.dot(d, self.bitangent),
            v.dot(d, self.normal),
        )
    }

    /// Local to world.
    #[inline(always)]
    pub fn to_world(&self, v: Vec3<F>) -> Vec3<F> {
        self.tangent.scale(v.x) + self.bitangent.scale(v.y) + self.normal.scale(v.z)
    }
}
