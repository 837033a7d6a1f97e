//! Emitting triangles.
//!
//! Points are sampled uniformly by area.

use super::{Emission, EmissionNumbers, LightKind, LightSample};
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
        spread: spread(d, double_sided, there.cos_geometric),
    }
}

/// What leaves a triangle, from places that are evenly distributed over it.
#[inline(always)]
pub(super) fn off_triangle<D: Domain, E: ColorSource<D>>(
    d: D,
    (emission, attributes): (&E, Attributes),
    [triangle, double_sided]: [D::U; 2],
    u: EmissionNumbers<D::F>,
) -> Emission<D> {
    let (b1, b2) = warp::triangle(d, u.place);
    let (zero, one, two) = (d.lit(0.0), d.lit(1.0), d.lit(2.0));
    // Of a triangle that emits on both sides, the first number also says on which.
    let is_double_sided = d.eq_u(double_sided, d.uint(1));
    let doubled = u.direction[0] * two;
    let is_back = is_double_sided & d.le(one, doubled);
    let halved = doubled - d.select(is_back, one, zero);
    let first = d.select(is_double_sided, halved, u.direction[0]);
    let local = warp::cosine_hemisphere(d, [first, u.direction[1]]);
    let (there, dir) = Surface::left(d, attributes, triangle, [b1, b2], (local, is_back));
    let sides = d.select(is_double_sided, two, one);
    let cos = d.max(there.cos_geometric, d.lit(1e-9));
    let radiance = emission.color(d, &there);
    Emission {
        ray: PathRay::unbounded(d, there.spawn(d, dir), dir),
        flux: radiance.scale(d.lit(std::f64::consts::PI) * there.area * sides),
        spread: spread(d, double_sided, cos),
        found: one / d.max(there.area * cos, d.lit(1e-37)),
        infinite: d.truth(false),
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
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = AreaRecord::load_at(d, Buffer::Lights, record);
        let of = [record.triangle, record.double_sided];
        off_triangle(d, (&self.emission, self.attributes), of, u)
    }

    #[inline(always)]
    fn density(&self, d: D, _: D::U, ray: &PathRay<D>, seen: &Surface<D>) -> Option<D::F> {
        let distance = (seen.point - ray.org).length(d);
        Some(distance * distance / d.max(seen.cos_geometric * seen.area, d.lit(1e-37)))
    }

    #[inline(always)]
    fn spread(&self, d: D, record: D::U, seen: &Surface<D>) -> Option<D::F> {
        let record = AreaRecord::load_at(d, Buffer::Lights, record);
        Some(spread(d, record.double_sided, seen.cos_geometric))
    }
}

/// Density of a direction of this cosine in which light leaves the triangle, per steradian: in proportion to the cosine, on
/// either side that emits.
#[inline(always)]
pub(super) fn spread<D: Domain>(d: D, double_sided: D::U, cos: D::F) -> D::F {
    let is_double_sided = d.eq_u(double_sided, d.uint(1));
    let share = d.select(is_double_sided, d.lit(0.5), d.lit(1.0));
    warp::cosine_hemisphere_pdf(d, cos) * share
}
