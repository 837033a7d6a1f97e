//! Where spawned rays start.

use crate::domain::Domain;
use crate::math::Vec3;
use crate::math::vec3::vec3;

/// `point`, moved along `normal` to the side of `dir` until it is certainly beyond the surface in spite of
/// `error` (after Pharr, Jakob, Humphreys 2023, section 6.8.6).
///
/// The move is as long as the largest component of the error, not as its part along the normal: that part is 0 on a
/// plane through the origin, where the intersection of the next ray with it is no more exact than elsewhere.
#[inline(always)]
pub fn offset_point<D: Domain>(
    d: D,
    point: Vec3<D::F>,
    error: Vec3<D::F>,
    normal: Vec3<D::F>,
    dir: Vec3<D::F>,
) -> Vec3<D::F> {
    let distance = error.max_component(d);
    let offset = normal.scale(d.copysign(distance, dir.dot(d, normal)));
    let ulp = d.lit(f64::from(f32::EPSILON));
    let outward = |p: D::F, o: D::F| {
        let moved = p + o;
        // One unit in the last place further, since the sum was rounded.
        let further = moved + d.copysign(d.abs(moved) * ulp, o);
        d.select(d.eq(o, d.lit(0.0)), p, further)
    };
    vec3(
        outward(point.x, offset.x),
        outward(point.y, offset.y),
        outward(point.z, offset.z),
    )
}
