//! Directions in a cone.

use crate::domain::Domain;
use crate::math::vec3::vec3;
use crate::math::{Frame, Vec3, warp};

/// A unit direction in a cone around the unit vector `axis`, evenly distributed over the cone's solid angle, and the versine of
/// its angle to the axis. `widest` is the versine of the cone's half-angle: narrow cones keep their digits.
#[inline(always)]
pub(super) fn in_cone<D: Domain>(
    d: D,
    axis: Vec3<D::F>,
    widest: D::F,
    u: [D::F; 2],
) -> (Vec3<D::F>, D::F) {
    let versine = u[0] * widest;
    let [x, y] = warp::disc(d, u);
    // sin² θ = v·(2 − v), of which the disc has the share of u.
    let sine = d.sqrt(widest * (d.lit(2.0) - versine));
    let local = vec3(x * sine, y * sine, d.lit(1.0) - versine);
    (Frame::around(d, axis).to_world(local), versine)
}
