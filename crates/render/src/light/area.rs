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

impl<D: Domain, E: ColorSource<D>> LightKind<D> for Area<E> {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D> {
        let record = AreaRecord::load_at(d, Buffer::Lights, record);
        let (b1, b2) = warp::triangle(d, [u[0], u[1]]);
        let there = Surface::seen_from(d, self.attributes, record.triangle, [b1, b2], from);
        let towards = there.point - from;
        let distance = d.max(towards.length(d), d.lit(1e-18));
        let emits = there.front | d.eq_u(record.double_sided, d.uint(1));
        let faces = d.lt(d.lit(0.0), there.cos_geometric);
        let solid_angle = there.cos_geometric * there.area;
        let safe = d.select(faces, solid_angle, d.lit(1.0));
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
            radiance: self.emission.color(d, &there).only(d, emits & faces),
            pdf: distance * distance / safe,
            delta: d.truth(false),
            spread: spread(d, &record, there.cos_geometric),
        }
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = AreaRecord::load_at(d, Buffer::Lights, record);
        let (b1, b2) = warp::triangle(d, u.place);
        let (zero, one, two) = (d.lit(0.0), d.lit(1.0), d.lit(2.0));
        // Of a triangle that emits on both sides, the first number also says on which.
        let is_double_sided = d.eq_u(record.double_sided, d.uint(1));
        let doubled = u.direction[0] * two;
        let is_back = is_double_sided & d.le(one, doubled);
        let halved = doubled - d.select(is_back, one, zero);
        let first = d.select(is_double_sided, halved, u.direction[0]);
        let local = warp::cosine_hemisphere(d, [first, u.direction[1]]);
        let (there, dir) = Surface::left(
            d,
            self.attributes,
            record.triangle,
            [b1, b2],
            (local, is_back),
        );
        let sides = d.select(is_double_sided, two, one);
        let cos = d.max(there.cos_geometric, d.lit(1e-9));
        Emission {
            ray: PathRay::unbounded(d, there.spawn(d, dir), dir),
            flux: self
                .emission
                .color(d, &there)
                .scale(d.lit(std::f64::consts::PI) * there.area * sides),
            spread: spread(d, &record, cos),
            found: one / d.max(there.area * cos, d.lit(1e-37)),
            infinite: d.truth(false),
        }
    }

    #[inline(always)]
    fn density(&self, d: D, _: D::U, ray: &PathRay<D>, seen: &Surface<D>) -> Option<D::F> {
        let distance = (seen.point - ray.org).length(d);
        Some(distance * distance / d.max(seen.cos_geometric * seen.area, d.lit(1e-37)))
    }

    #[inline(always)]
    fn spread(&self, d: D, record: D::U, seen: &Surface<D>) -> Option<D::F> {
        let record = AreaRecord::load_at(d, Buffer::Lights, record);
        Some(spread(d, &record, seen.cos_geometric))
    }
}

/// Density of a direction of this cosine in which light leaves the triangle, per steradian: in proportion to the cosine, on
/// either side that emits.
#[inline(always)]
fn spread<D: Domain>(d: D, record: &AreaRecord<D>, cos: D::F) -> D::F {
    let is_double_sided = d.eq_u(record.double_sided, d.uint(1));
    let share = d.select(is_double_sided, d.lit(0.5), d.lit(1.0));
    warp::cosine_hemisphere_pdf(d, cos) * share
}
