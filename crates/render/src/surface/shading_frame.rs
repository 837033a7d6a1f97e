//! Shading frames: around interpolated and mapped normals, along tangents.

use crate::domain::{Bundle, Domain};
use crate::math::{Frame, Vec3};

/// A shading normal from which the way back `wo` can be seen: one that `wo` lies below is tilted until it does
/// not, so that interpolated and mapped normals make no black rims (hard cases M-09, O-07).
#[inline(always)]
pub(super) fn visible<D: Domain>(d: D, normal: Vec3<D::F>, wo: Vec3<D::F>) -> Vec3<D::F> {
    let lift = d.max(d.lit(1e-3) - normal.dot(d, wo), d.lit(0.0));
    (normal + wo.scale(lift)).normalize_any(d)
}

/// The frame around `normal` along `tangent`; the bitangent has the side of `sign`. Where the tangent vanishes the frame is
/// the one around the normal.
#[inline(always)]
pub(super) fn along_tangent<D: Domain>(
    d: D,
    normal: Vec3<D::F>,
    tangent: Vec3<D::F>,
    sign: D::F,
) -> Frame<D::F> {
    let around = Frame::around(d, normal);
    // Gram–Schmidt.
    let tangent = tangent - normal.scale(tangent.dot(d, normal));
    let length = tangent.length(d);
    let usable = d.lt(d.lit(1e-6), length);
    let tangent = tangent.scale(d.lit(1.0) / d.max(length, d.lit(1e-6)));
    let bitangent = normal.cross(tangent).scale(sign);
    Frame {
        tangent: Vec3::choose(d, usable, tangent, around.tangent),
        bitangent: Vec3::choose(d, usable, bitangent, around.bitangent),
        normal,
    }
}

/// A normal that is given in a frame (a normal map's value), world space.
#[inline(always)]
pub(super) fn mapped<D: Domain>(d: D, frame: &Frame<D::F>, local: Vec3<D::F>) -> Vec3<D::F> {
    frame.to_world(local).normalize_any(d)
}

/// The frame with another normal, as visible from `wo`.
#[inline(always)]
pub(super) fn with_normal<D: Domain>(
    d: D,
    frame: &Frame<D::F>,
    normal: Vec3<D::F>,
    wo: Vec3<D::F>,
) -> Frame<D::F> {
    let normal = visible(d, normal, wo);
    let tangent = frame.tangent - normal.scale(frame.tangent.dot(d, normal));
    let tangent = tangent.normalize_any(d);
    let handed = frame.normal.cross(frame.tangent).dot(d, frame.bitangent);
    Frame {
        tangent,
        bitangent: normal.cross(tangent).scale(d.copysign(d.lit(1.0), handed)),
        normal,
    }
}

/// The frame turned about its normal, until its tangent points along (x, y) of what it was; as it is where that vanishes.
#[inline(always)]
pub(super) fn turned<D: Domain>(d: D, frame: &Frame<D::F>, [x, y]: [D::F; 2]) -> Frame<D::F> {
    let length = d.sqrt(d.fma(x, x, y * y));
    let usable = d.lt(d.lit(1e-6), length);
    let inverse = d.lit(1.0) / d.select(usable, length, d.lit(1.0));
    let cos = d.select(usable, x * inverse, d.lit(1.0));
    let sin = d.select(usable, y * inverse, d.lit(0.0));
    Frame {
        tangent: frame.tangent.scale(cos) + frame.bitangent.scale(sin),
        bitangent: frame.bitangent.scale(cos) - frame.tangent.scale(sin),
        normal: frame.normal,
    }
}
