//! Emitting triangles.
//!
//! Points are sampled uniformly by area.

use super::{LightKind, LightSample};
use crate::domain::{Buffer, Domain};
use crate::math::{Vec3, warp};
use crate::record::record;
use crate::surface::{Attributes, PathRay, Surface, offset_point};
use crate::texture::ColorSource;

record! {
    /// An emitting triangle.
    pub struct AreaRecord {
        row {
            /// Index of its kind in the scene's list of kinds.
            kind: word,
            /// Index of the triangle.
            triangle: word,
            /// 1 if both sides emit, 0 if only the front does.
            double_sided: word,
        }
    }
}

/// Triangles whose emission comes from sources of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Area<E> {
    /// Emitted radiance.
    pub emission: E,
    /// What `emission` reads.
    pub attributes: Attributes,
}

/// What comes to the point `from` from a place on a triangle. `pdf` gives the place's density per steradian, from the place, its
/// distance and whether the triangle is not seen edge-on.
#[inline(always)]
pub(super) fn from_place<D: Domain, E: ColorSource<D>>(
    d: D,
    (emission, attributes): (&E, Attributes),
    [triangle, double_sided]: [D::U; 2],
    from: Vec3<D::F>,
    place: [D::F; 2],
    pdf: impl FnOnce(&Surface<D>, D::F, D::M) -> D::F,
) -> LightSample<D> {
    let there = Surface::seen_from(d, attributes, triangle, place, from);
    let towards = there.point - from;
    let distance = d.max(towards.length(d), d.lit(1e-18));
    let emits = there.front | d.eq_u(double_sided, d.uint(1));
    let faces = d.lt(d.lit(0.0), there.cos_geometric);
    LightSample {
        wi: towards.scale(d.lit(1.0) / distance),
        position: offset_point(
            d,
            there.point,
            there.error,
            there.geometric_normal,
            -towards,
        ),
        infinite: d.truth(false),
        radiance: emission.color(d, &there).only(d, emits & faces),
        pdf: pdf(&there, distance, faces),
        delta: d.truth(false),
    }
}

impl<D: Domain, E: ColorSource<D>> LightKind<D> for Area<E> {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D> {
        let record = AreaRecord::load_at(d, Buffer::Lights, record);
        let (b1, b2) = warp::triangle(d, [u[0], u[1]]);
        let of = [record.triangle, record.double_sided];
        let source = (&self.emission, self.attributes);
        from_place(d, source, of, from, [b1, b2], |there, distance, faces| {
            let solid_angle = there.cos_geometric * there.area;
            distance * distance / d.select(faces, solid_angle, d.lit(1.0))
        })
    }

    #[inline(always)]
    fn density(&self, d: D, _: D::U, ray: &PathRay<D>, seen: &Surface<D>) -> Option<D::F> {
        let distance = (seen.point - ray.org).length(d);
        Some(distance * distance / d.max(seen.cos_geometric * seen.area, d.lit(1e-37)))
    }
}
