//! What is known of the place where a ray met a surface, and how rays leave it again.

use crate::domain::{Buffer, Domain};
use crate::math::vec3::vec3;
use crate::math::{Frame, Vec3};
use crate::triangle::TriangleRecord;

/// A ray with as many lanes as its domain. The interval is [0, tmax] in units of `dir`.
#[derive(Clone, Copy, Debug)]
pub struct Ray<D: Domain> {
    /// Origin, world space.
    pub org: Vec3<D::F>,
    /// Direction; its length is the unit of t.
    pub dir: Vec3<D::F>,
    /// End of the interval.
    pub tmax: D::F,
}

impl<D: Domain> Ray<D> {
    /// A ray without an end.
    #[inline(always)]
    pub fn unbounded(d: D, org: Vec3<D::F>, dir: Vec3<D::F>) -> Self {
        let tmax = d.lit(f64::from(f32::MAX));
        Self { org, dir, tmax }
    }
}

/// What traversal found.
#[derive(Clone, Copy, Debug)]
pub struct Hit<D: Domain> {
    /// Barycentric weight of corner 1.
    pub u: D::F,
    /// Barycentric weight of corner 2.
    pub v: D::F,
    /// Number of the triangle.
    pub prim: D::U,
}

/// Vertex attributes that a material reads. What is not read is not loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct Attributes {
    /// Interpolated normals; without them the surface is flat.
    pub normals: bool,
    /// Tangents.
    pub tangents: bool,
    /// First set of texture coordinates.
    pub uv0: bool,
    /// Second set of texture coordinates.
    pub uv1: bool,
    /// Vertex colours.
    pub colors: bool,
}

impl Attributes {
    /// None at all.
    pub const NONE: Self = Self {
        normals: false,
        tangents: false,
        uv0: false,
        uv1: false,
        colors: false,
    };

    /// What either reads.
    pub fn union(self, other: Self) -> Self {
        Self {
            normals: self.normals | other.normals,
            tangents: self.tangents | other.tangents,
            uv0: self.uv0 | other.uv0,
            uv1: self.uv1 | other.uv1,
            colors: self.colors | other.colors,
        }
    }
}

/// The numbers of inputs that boxed programs keep per surface point.
pub const MAX_INPUTS: usize = 16;

/// A point of a surface and the way it was reached.
#[derive(Clone, Copy, Debug)]
pub struct Surface<D: Domain> {
    /// The point, world space, computed from the corners.
    pub point: Vec3<D::F>,
    /// Bound on the rounding error of each component of `point`.
    pub error: Vec3<D::F>,
    /// Area of the triangle.
    pub area: D::F,
    /// Unit normal of the triangle, on the side from which the ray came.
    pub geometric_normal: Vec3<D::F>,
    /// Shading frame; its normal is on the side from which the ray came.
    pub frame: Frame<D::F>,
    /// The ray came from the front (counter-clockwise) side.
    pub front: D::M,
    /// Cosine between the geometric normal and the way back, ≥ 0.
    pub cos_geometric: D::F,
    /// Two sets of texture coordinates.
    pub uv: [[D::F; 2]; 2],
    /// Vertex colour.
    pub color: Vec3<D::F>,
    /// Vertex alpha.
    pub alpha: D::F,
    /// First word of the material's parameters.
    pub params: D::U,
    /// Index of the light that the triangle is, or [`NO_LIGHT`](crate::triangle::NO_LIGHT).
    pub light: D::U,
    /// Index of the object that the triangle belongs to.
    pub object: D::U,
    /// Inputs of a boxed program, evaluated once per point. Unused, and optimised away, in emitted programs.
    pub inputs: [Vec3<D::F>; MAX_INPUTS],
}

/// The place of a hit on its triangle.
struct Place<D: Domain> {
    /// Weights of the corners.
    weights: [D::F; 3],
    point: Vec3<D::F>,
    /// Bound on the rounding error of each component of `point`.
    error: Vec3<D::F>,
    /// The triangle's normal; its length is twice the area.
    normal: Vec3<D::F>,
    triangle: TriangleRecord<D>,
}

impl<D: Domain> Place<D> {
    /// The bound on the error is γ₇ times the weighted magnitudes of the corners (Pharr, Jakob, Humphreys 2023,
    /// section 6.8.4).
    #[inline(always)]
    fn new(d: D, hit: &Hit<D>) -> Self {
        let triangle = TriangleRecord::load(d, hit.prim);
        let weights = [d.lit(1.0) - hit.u - hit.v, hit.u, hit.v];
        let [a, b, c] = [triangle.a, triangle.b, triangle.c];
        let (wa, wb, wc) = (
            a.scale(weights[0]),
            b.scale(weights[1]),
            c.scale(weights[2]),
        );
        let magnitude = |v: Vec3<D::F>| v.map(|x| d.abs(x));
        let gamma = d.lit(7.0 * 5.960_464_5e-8 / (1.0 - 7.0 * 5.960_464_5e-8));
        Self {
            weights,
            point: wa + wb + wc,
            error: (magnitude(wa) + magnitude(wb) + magnitude(wc)).scale(gamma),
            normal: (b - a).cross(c - a),
            triangle,
        }
    }
}

/// The row of reals of a vertex.
#[inline(always)]
fn row_of<D: Domain>(d: D, buffer: Buffer, vertex: D::U) -> [D::F; 4] {
    let [[x, y, z, w]] = d.load_rows(buffer, vertex << 2);
    [
        d.from_bits(x),
        d.from_bits(y),
        d.from_bits(z),
        d.from_bits(w),
    ]
}

/// An attribute at the corners of a triangle: a row each.
struct Corners<'a, D: Domain> {
    rows: [[D::F; 4]; 3],
    weights: &'a [D::F; 3],
}

impl<'a, D: Domain> Corners<'a, D> {
    #[inline(always)]
    fn load(d: D, buffer: Buffer, vertices: [D::U; 4], weights: &'a [D::F; 3]) -> Self {
        let [a, b, c, _] = vertices;
        let rows = [
            row_of(d, buffer, a),
            row_of(d, buffer, b),
            row_of(d, buffer, c),
        ];
        Self { rows, weights }
    }

    /// Component `k`, interpolated.
    #[inline(always)]
    fn component(&self, d: D, k: usize) -> D::F {
        let ([a, b, c], w) = (&self.rows, self.weights);
        d.fma(a[k], w[0], d.fma(b[k], w[1], c[k] * w[2]))
    }

    /// The first three components, interpolated.
    #[inline(always)]
    fn vector(&self, d: D) -> Vec3<D::F> {
        vec3(
            self.component(d, 0),
            self.component(d, 1),
            self.component(d, 2),
        )
    }
}

impl<D: Domain> Surface<D> {
    /// The surface at a hit of a ray with direction `dir`, with the attributes that its material reads.
    #[inline(always)]
    pub fn new(d: D, attributes: Attributes, hit: &Hit<D>, dir: Vec3<D::F>) -> Self {
        Self::at(d, attributes, &Place::new(d, hit), hit.prim, dir)
    }

    /// The surface at a place on triangle `prim`.
    #[inline(always)]
    fn at(d: D, attributes: Attributes, place: &Place<D>, prim: D::U, dir: Vec3<D::F>) -> Self {
        let (point, error, normal) = (place.point, place.error, place.normal);
        let vertices = if attributes == Attributes::NONE {
            // Of no use: nothing reads them.
            [prim; 4]
        } else {
            let [row] = d.load_rows(Buffer::Indices, prim << 2);
            row
        };
        let corners = |buffer: Buffer| Corners::load(d, buffer, vertices, &place.weights);
        let outward = normal.normalize_any(d);
        let wo = -dir.normalize(d);
        let cos_outward = outward.dot(d, wo);
        let front = d.lt(d.lit(0.0), cos_outward);
        let zero = d.lit(0.0);
        let geometric_normal = outward.map(|c| d.select(front, c, -c));

        // Which side a stored normal is on is the file's affair, and files err: it is turned to the side of the
        // geometric normal, which follows the winding alone.
        let (shading_normal, turned) = if attributes.normals {
            let stored = corners(Buffer::Normals).vector(d).normalize_any(d);
            let turned = d.lt(stored.dot(d, geometric_normal), zero);
            let normal = stored.map(|c| d.select(turned, -c, c));
            (visible(d, normal, wo), turned)
        } else {
            (geometric_normal, !front)
        };
        let mut frame = Frame::around(d, shading_normal);
        if attributes.tangents {
            let tangents = corners(Buffer::Tangents);
            let (raw, sign) = (tangents.vector(d), tangents.rows[0][3]);
            // Gram–Schmidt; where the tangent vanishes the frame around the normal stays.
            let tangent = raw - shading_normal.scale(raw.dot(d, shading_normal));
            let length = tangent.length(d);
            let usable = d.lt(d.lit(1e-6), length);
            let tangent = tangent.scale(d.lit(1.0) / d.max(length, d.lit(1e-6)));
            let sign = d.select(turned, -sign, sign);
            let bitangent = shading_normal.cross(tangent).scale(sign);
            let pick = |a: Vec3<D::F>, b: Vec3<D::F>| {
                vec3(
                    d.select(usable, a.x, b.x),
                    d.select(usable, a.y, b.y),
                    d.select(usable, a.z, b.z),
                )
            };
            frame.tangent = pick(tangent, frame.tangent);
            frame.bitangent = pick(bitangent, frame.bitangent);
        }
        let mut uv = [[zero; 2]; 2];
        if attributes.uv0 || attributes.uv1 {
            let uvs = corners(Buffer::Uvs);
            if attributes.uv0 {
                uv[0] = [uvs.component(d, 0), uvs.component(d, 1)];
            }
            if attributes.uv1 {
                uv[1] = [uvs.component(d, 2), uvs.component(d, 3)];
            }
        }
        let one = d.lit(1.0);
        let (color, alpha) = if attributes.colors {
            let colors = corners(Buffer::Colors);
            (colors.vector(d), colors.component(d, 3))
        } else {
            (Vec3::splat(one), one)
        };
        Self {
            point,
            error,
            area: normal.length(d) * d.lit(0.5),
            geometric_normal,
            frame,
            front,
            cos_geometric: d.abs(cos_outward),
            uv,
            color,
            alpha,
            params: place.triangle.params,
            light: place.triangle.light,
            object: place.triangle.object,
            inputs: [Vec3::splat(zero); MAX_INPUTS],
        }
    }

    /// Where the ray `from` → triangle `prim` at barycentric (u, v) would arrive: light sampling's view of a light.
    #[inline(always)]
    pub fn seen_from(
        d: D,
        attributes: Attributes,
        prim: D::U,
        [u, v]: [D::F; 2],
        from: Vec3<D::F>,
    ) -> Self {
        let place = Place::new(d, &Hit { u, v, prim });
        Self::at(d, attributes, &place, prim, place.point - from)
    }

    /// Replaces the shading normal, given in the shading frame (a normal map's value).
    #[inline(always)]
    pub fn with_normal(mut self, d: D, local: Vec3<D::F>, wo: Vec3<D::F>) -> Self {
        let normal = visible(d, self.frame.to_world(local).normalize_any(d), wo);
        let tangent = self.frame.tangent - normal.scale(self.frame.tangent.dot(d, normal));
        let tangent = tangent.normalize_any(d);
        let handed = self
            .frame
            .normal
            .cross(self.frame.tangent)
            .dot(d, self.frame.bitangent);
        self.frame = Frame {
            tangent,
            bitangent: normal.cross(tangent).scale(d.copysign(d.lit(1.0), handed)),
            normal,
        };
        self
    }

    /// Where a ray that leaves in direction `dir` starts.
    #[inline(always)]
    pub fn spawn(&self, d: D, dir: Vec3<D::F>) -> Vec3<D::F> {
        offset_point(d, self.point, self.error, self.geometric_normal, dir)
    }
}

/// A shading normal from which the way back `wo` can be seen: one that `wo` lies below is tilted until it does
/// not, so that interpolated and mapped normals make no black rims (hard cases M-09, O-07).
#[inline(always)]
fn visible<D: Domain>(d: D, normal: Vec3<D::F>, wo: Vec3<D::F>) -> Vec3<D::F> {
    let lift = d.max(d.lit(1e-3) - normal.dot(d, wo), d.lit(0.0));
    (normal + wo.scale(lift)).normalize_any(d)
}

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
