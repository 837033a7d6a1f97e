//! What is known of the point where a ray met a surface, and how rays leave it again.

mod attributes;
mod footprint;
mod offset;
mod place;
mod ray;
mod shading_frame;
mod texels;

pub use attributes::{Attributes, ColorRecord, NormalRecord, TangentRecord, UvRecord};
pub use footprint::{Cone, Footprint};
pub use offset::offset_point;
pub use ray::{PathRay, SurfaceHit};
pub use texels::{decode_normal, decode_tangent};

use attributes::Corners;
use place::Place;

use crate::domain::Domain;
use crate::math::spectrum::D_LINE;
use crate::math::{Frame, Vec3};
use crate::triangle::vertices_of;

/// The most inputs that boxed programs keep per surface point.
pub const MAX_INPUTS: usize = 32;

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
    /// The shading frame of the mesh, without what maps change of it.
    pub mesh_frame: Frame<D::F>,
    /// The normals of both frames before they were tilted until the way back was above them.
    pub untilted: [Vec3<D::F>; 2],
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
    /// Index of refraction of what the body lies in whose surface it is; 1 unless bodies lie within each other.
    pub around: D::F,
    /// The wavelength that the material is evaluated for, in nanometres.
    pub wavelength: D::F,
    /// What textures are filtered over; a point, unless something [asks for it](Self::see_through).
    pub footprint: Footprint<D>,
    /// Inputs of a boxed program, evaluated once per point. Unused, and optimised away, in emitted programs.
    pub inputs: [Vec3<D::F>; MAX_INPUTS],
}

impl<D: Domain> Surface<D> {
    /// The surface at a hit of a ray with direction `dir`, with the attributes that its material reads.
    #[inline(always)]
    pub fn new(d: D, attributes: Attributes, hit: &SurfaceHit<D>, dir: Vec3<D::F>) -> Self {
        Self::at(d, attributes, &Place::new(d, hit), hit.prim, dir)
    }

    /// The surface at a place on triangle `prim`.
    #[inline(always)]
    fn at(d: D, attributes: Attributes, place: &Place<D>, prim: D::U, dir: Vec3<D::F>) -> Self {
        let (point, error, normal) = (place.point, place.error, place.normal);
        let vertices = if attributes == Attributes::NONE {
            // Of no use: nothing reads them.
            [prim; 3]
        } else {
            vertices_of(d, prim)
        };
        let outward = normal.normalize_any(d);
        let wo = -dir.normalize(d);
        let cos_outward = outward.dot(d, wo);
        let front = d.lt(d.lit(0.0), cos_outward);
        let zero = d.lit(0.0);
        let geometric_normal = outward.map(|c| d.select(front, c, -c));

        // Which side a stored normal is on is the file's affair, and files err: it is turned to the side of the
        // geometric normal, which follows the winding alone.
        let (untilted, shading_normal, turned) = if attributes.normals {
            let normals = vertices.map(|vertex| NormalRecord::load(d, vertex));
            let normals = Corners::new(normals, &place.weights);
            let stored = normals.vector(d, |corner| corner.normal).normalize_any(d);
            let turned = d.lt(stored.dot(d, geometric_normal), zero);
            let normal = stored.map(|c| d.select(turned, -c, c));
            (normal, shading_frame::visible(d, normal, wo), turned)
        } else {
            (geometric_normal, geometric_normal, !front)
        };
        let frame = if attributes.tangents {
            let tangents = vertices.map(|vertex| TangentRecord::load(d, vertex));
            let sign = tangents[0].sign;
            let sign = d.select(turned, -sign, sign);
            let tangents = Corners::new(tangents, &place.weights);
            let tangent = tangents.vector(d, |corner| corner.tangent);
            shading_frame::along_tangent(d, shading_normal, tangent, sign)
        } else {
            Frame::around(d, shading_normal)
        };
        let mut uv = [[zero; 2]; 2];
        if attributes.uv0 || attributes.uv1 {
            let uvs = vertices.map(|vertex| UvRecord::load(d, vertex));
            let uvs = Corners::new(uvs, &place.weights);
            if attributes.uv0 {
                uv[0] = [
                    uvs.real(d, |corner| corner.u0),
                    uvs.real(d, |corner| corner.v0),
                ];
            }
            if attributes.uv1 {
                uv[1] = [
                    uvs.real(d, |corner| corner.u1),
                    uvs.real(d, |corner| corner.v1),
                ];
            }
        }
        let one = d.lit(1.0);
        let (color, alpha) = if attributes.colors {
            let colors = vertices.map(|vertex| ColorRecord::load(d, vertex));
            let colors = Corners::new(colors, &place.weights);
            (
                colors.vector(d, |corner| corner.color),
                colors.real(d, |corner| corner.alpha),
            )
        } else {
            (Vec3::splat(one), one)
        };
        Self {
            point,
            error,
            area: normal.length(d) * d.lit(0.5),
            geometric_normal,
            frame,
            mesh_frame: frame,
            untilted: [untilted; 2],
            front,
            cos_geometric: d.abs(cos_outward),
            uv,
            color,
            alpha,
            params: place.triangle.params,
            light: place.triangle.light,
            object: place.triangle.object,
            around: one,
            wavelength: d.lit(D_LINE),
            footprint: Footprint::point(d),
            inputs: [Vec3::splat(zero); MAX_INPUTS],
        }
    }

    /// Sees the surface of a hit through a cone around a ray from `org`.
    #[inline(always)]
    pub fn see_through(
        &mut self,
        d: D,
        cone: Cone<D>,
        org: Vec3<D::F>,
        attributes: Attributes,
        prim: D::U,
    ) {
        let distance = (self.point - org).length(d);
        let shape = [self.area, self.cos_geometric];
        self.footprint = Footprint::new(d, cone, distance, shape, attributes, prim);
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
        let place = Place::new(d, &SurfaceHit { u, v, prim });
        Self::at(d, attributes, &place, prim, place.point - from)
    }

    /// The place at barycentric (u, v) of triangle `prim` as light leaves it: in a direction given around the triangle's normal, or,
    /// where the mask holds, around the opposite one. Also that direction.
    #[inline(always)]
    pub fn left(
        d: D,
        attributes: Attributes,
        prim: D::U,
        [u, v]: [D::F; 2],
        (local, back): (Vec3<D::F>, D::M),
    ) -> (Self, Vec3<D::F>) {
        let place = Place::new(d, &SurfaceHit { u, v, prim });
        let outward = place.normal.normalize_any(d);
        let normal = outward.map(|c| d.select(back, -c, c));
        let dir = Frame::around(d, normal).to_world(local).normalize(d);
        (Self::at(d, attributes, &place, prim, -dir), dir)
    }

    /// The surface as a ray sees it that comes from the unit direction `wo`, on whichever side that is.
    #[inline(always)]
    pub fn seen_along(&self, d: D, wo: Vec3<D::F>) -> Self {
        let is_beyond = d.lt(self.geometric_normal.dot(d, wo), d.lit(0.0));
        let turned = |v: Vec3<D::F>| v.map(|c| d.select(is_beyond, -c, c));
        let untilted = self.untilted.map(turned);
        let other = |frame: &Frame<D::F>, normal: Vec3<D::F>| {
            shading_frame::with_normal(d, frame, normal, wo)
        };
        Self {
            front: d.select_mask(is_beyond, !self.front, self.front),
            geometric_normal: turned(self.geometric_normal),
            frame: other(&self.frame, untilted[0]),
            mesh_frame: other(&self.mesh_frame, untilted[1]),
            untilted,
            ..*self
        }
    }

    /// Replaces the shading normal, given in the shading frame (a normal map's value).
    #[inline(always)]
    pub fn with_normal(mut self, d: D, local: Vec3<D::F>, wo: Vec3<D::F>) -> Self {
        self.untilted[0] = shading_frame::mapped(d, &self.frame, local);
        self.frame = shading_frame::with_normal(d, &self.frame, self.untilted[0], wo);
        self
    }

    /// The shading frame with a normal that is given in that of the mesh.
    #[inline(always)]
    pub fn mapped_frame(&self, d: D, local: Vec3<D::F>, wo: Vec3<D::F>) -> Frame<D::F> {
        let normal = shading_frame::mapped(d, &self.mesh_frame, local);
        shading_frame::with_normal(d, &self.mesh_frame, normal, wo)
    }

    /// Turns the tangent to a direction given along tangent and bitangent.
    #[inline(always)]
    pub fn with_tangent(mut self, d: D, local: [D::F; 2]) -> Self {
        self.frame = shading_frame::turned(d, &self.frame, local);
        self
    }

    /// Where a ray that leaves in direction `dir` starts.
    #[inline(always)]
    pub fn spawn(&self, d: D, dir: Vec3<D::F>) -> Vec3<D::F> {
        offset_point(d, self.point, self.error, self.geometric_normal, dir)
    }
}
