//! What goes into traversal and what comes out of it.

use crate::domain::{Bundle, Domain};
use crate::math::Vec3;

/// A ray with as many lanes as its domain. The interval is [0, tmax] in units of `dir`.
#[derive(Clone, Copy, Debug)]
pub struct PathRay<D: Domain> {
    /// Origin, world space.
    pub org: Vec3<D::F>,
    /// Direction; its length is the unit of t.
    pub dir: Vec3<D::F>,
    /// End of the interval.
    pub tmax: D::F,
}

impl<D: Domain> PathRay<D> {
    /// A ray without an end.
    #[inline(always)]
    pub fn unbounded(d: D, org: Vec3<D::F>, dir: Vec3<D::F>) -> Self {
        let tmax = d.lit(f64::from(f32::MAX));
        Self { org, dir, tmax }
    }
}

impl<D: Domain> Bundle<D> for PathRay<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            org: Vec3::choose(d, mask, a.org, b.org),
            dir: Vec3::choose(d, mask, a.dir, b.dir),
            tmax: d.select(mask, a.tmax, b.tmax),
        }
    }
}

/// What traversal found.
#[derive(Clone, Copy, Debug)]
pub struct SurfaceHit<D: Domain> {
    /// Barycentric weight of corner 1.
    pub u: D::F,
    /// Barycentric weight of corner 2.
    pub v: D::F,
    /// Index of the triangle.
    pub prim: D::U,
}
