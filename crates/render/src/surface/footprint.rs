//! How much of a surface a ray stands for: what textures are filtered over (Akenine-Möller et al. 2021, "Improved Shader and
//! Texture Level of Detail Using Ray Cones").

use super::attributes::{Attributes, UvRecord};
use crate::domain::Domain;
use crate::triangle::vertices_of;

/// The cone of rays that a ray stands for.
#[derive(Clone, Copy, Debug)]
pub struct Cone<D: Domain> {
    /// Its width where the ray begins.
    pub width: D::F,
    /// By how much it widens on a unit of length.
    pub angle: D::F,
    /// A random number in [0, 1), by which levels of images are chosen.
    pub random: D::F,
}

/// What a [`Cone`] covers of a surface.
#[derive(Clone, Copy, Debug)]
pub struct Footprint<D: Domain> {
    /// Its greatest width on the surface.
    pub width: D::F,
    /// The area of the triangle in either set of texture coordinates, over that in the world.
    pub uv_areas: [D::F; 2],
    /// The cone's random number.
    pub random: D::F,
}

impl<D: Domain> Footprint<D> {
    /// That of a ray without width.
    #[inline(always)]
    pub(super) fn point(d: D) -> Self {
        Self {
            width: d.lit(0.0),
            uv_areas: [d.lit(0.0); 2],
            random: d.lit(0.0),
        }
    }

    /// Of a cone that arrives after a distance, on triangle `prim` of this area, with this cosine of its angle to the normal.
    #[inline(always)]
    pub(super) fn new(
        d: D,
        cone: Cone<D>,
        distance: D::F,
        [area, cos]: [D::F; 2],
        attributes: Attributes,
        prim: D::U,
    ) -> Self {
        let mut uv_areas = [d.lit(0.0); 2];
        if attributes.uv0 || attributes.uv1 {
            let corners = vertices_of(d, prim).map(|vertex| UvRecord::load(d, vertex));
            let [a, b, c] = &corners;
            let twice = d.max(area * d.lit(2.0), d.lit(1e-37));
            let cross = |u: fn(&UvRecord<D>) -> D::F, v: fn(&UvRecord<D>) -> D::F| {
                let (bu, bv) = (u(b) - u(a), v(b) - v(a));
                let (cu, cv) = (u(c) - u(a), v(c) - v(a));
                d.abs(bu * cv - bv * cu) / twice
            };
            uv_areas = [
                cross(|corner| corner.u0, |corner| corner.v0),
                cross(|corner| corner.u1, |corner| corner.v1),
            ];
        }
        // At the horizon the ellipse is longer than what is left of the surface.
        let across = d.fma(cone.angle, distance, cone.width);
        Self {
            width: across / d.max(cos, d.lit(1e-3)),
            uv_areas,
            random: cone.random,
        }
    }
}
