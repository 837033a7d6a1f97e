//! Texels that are directions.

use crate::domain::Domain;
use crate::math::{Color, Vec3};

/// A normal map's texel as a normal in the shading frame: 2·rgb − 1, x and y scaled (glTF 2.0, section 3.9.3).
#[inline(always)]
pub fn decode_normal<D: Domain>(d: D, rgb: Color<D::F>, scale: D::F) -> Vec3<D::F> {
    let [x, y, z] = [rgb.x, rgb.y, rgb.z].map(|c| d.fma(c, d.lit(2.0), d.lit(-1.0)));
    Vec3 {
        x: x * scale,
        y: y * scale,
        z,
    }
}

/// An anisotropy map's texel as a direction in the shading frame: 2·rg − 1, turned by an angle of this cosine and sine
/// (KHR_materials_anisotropy).
#[inline(always)]
pub fn decode_tangent<D: Domain>(d: D, rgb: Color<D::F>, [cos, sin]: [D::F; 2]) -> [D::F; 2] {
    let [x, y] = [rgb.x, rgb.y].map(|c| d.fma(c, d.lit(2.0), d.lit(-1.0)));
    [d.fma(x, cos, -(y * sin)), d.fma(x, sin, y * cos)]
}
