//! Emitting triangles that are near: places on them are sampled uniformly by solid angle.
//!
//! Then what a sample brings differs by the surface's cosine alone, however near the triangle is; by area it also differs by distance and by the
//! triangle's own cosine. (By *projected* solid angle it would not differ at all. But a path keeps no normal of the vertex that it comes from, and the
//! density of a triangle that it meets must be that of light samples.)

use super::area::{from_place, off_triangle, spread};
use super::{Emission, EmissionNumbers, LightKind, LightSample};
use crate::domain::{Buffer, Domain};
use crate::math::{SphericalTriangle, Vec3, warp};
use crate::record::record;
use crate::surface::{Attributes, PathRay, Surface};
use crate::texture::ColorSource;
use crate::triangle::TriangleRecord;

record! {
    /// An emitting triangle that is sampled by solid angle.
    pub struct AreaBySolidAngleRecord {
        row {
            /// Index of its kind in the scene's list of kinds.
            kind: word,
            /// Index of the triangle.
            triangle: word,
            /// 1 if both sides emit, 0 if only the front does.
            double_sided: word,
        }
        row {
            /// The triangle's normal, whose length is twice the area. Of a needle it would not have three digits left if it were
            /// computed from the corners in `f32`.
            normal: vector,
        }
    }
}

/// Triangles whose emission comes from sources of one kind, sampled by solid angle.
#[derive(Clone, Copy, Debug)]
pub struct AreaBySolidAngle<E> {
    /// Emitted radiance.
    pub emission: E,
    /// What `emission` reads.
    pub attributes: Attributes,
}

/// The record of a light, and how a point sees its triangle.
#[inline(always)]
fn seen<D: Domain>(
    d: D,
    record: D::U,
    from: Vec3<D::F>,
) -> (AreaBySolidAngleRecord<D>, SphericalTriangle<D>) {
    let record = AreaBySolidAngleRecord::load_at(d, Buffer::Lights, record);
    let TriangleRecord { a, b, c, .. } = TriangleRecord::load(d, record.triangle);
    let triangle = SphericalTriangle::new(d, from, [a, b, c], record.normal);
    (record, triangle)
}

/// The density per steradian: one over the solid angle.
#[inline(always)]
fn density<D: Domain>(d: D, triangle: &SphericalTriangle<D>) -> D::F {
    d.lit(1.0) / d.max(triangle.solid_angle(d), d.lit(1e-37))
}

impl<D: Domain, E: ColorSource<D>> LightKind<D> for AreaBySolidAngle<E> {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D> {
        let (record, triangle) = seen(d, record, from);
        let (b1, b2) = warp::triangle(d, [u[0], u[1]]);
        let place = triangle.place(d, [b1, b2]);
        let of = [record.triangle, record.double_sided];
        let source = (&self.emission, self.attributes);
        from_place(d, source, of, from, place, |_, _, _| density(d, &triangle))
    }

    /// Tracers with light paths weigh places by area, and have lights that are sampled by it.
    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = AreaBySolidAngleRecord::load_at(d, Buffer::Lights, record);
        let of = [record.triangle, record.double_sided];
        off_triangle(d, (&self.emission, self.attributes), of, u)
    }

    #[inline(always)]
    fn density(&self, d: D, record: D::U, ray: &PathRay<D>, _: &Surface<D>) -> Option<D::F> {
        let (_, triangle) = seen(d, record, ray.org);
        Some(density(d, &triangle))
    }

    #[inline(always)]
    fn spread(&self, d: D, record: D::U, seen: &Surface<D>) -> Option<D::F> {
        let record = AreaBySolidAngleRecord::load_at(d, Buffer::Lights, record);
        Some(spread(d, record.double_sided, seen.cos_geometric))
    }
}
