//! Point, spot and directional lights (KHR_lights_punctual).
//!
//! Records: kind, position (or, directional, the unit direction towards the light), intensity; and for spots the
//! unit axis, then scale and offset of the cosine: `clamp(cos·scale + offset)²` as the extension recommends.

use super::{LightKind, LightSample};
use crate::domain::{Buffer, Domain};
use crate::math::Vec3;
use crate::math::vec3::vec3;
use crate::surface::Surface;

/// Shines everywhere from a point.
#[derive(Clone, Copy, Debug)]
pub struct Point;
/// Shines into a cone.
#[derive(Clone, Copy, Debug)]
pub struct Spot;
/// Shines along one direction from infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct Directional;

#[inline(always)]
fn vector<D: Domain>(d: D, record: D::U, first: u32) -> Vec3<D::F> {
    let [x, y, z] = [0, 1, 2].map(|k| d.load_real(Buffer::Lights, record + d.uint(first + k)));
    vec3(x, y, z)
}

impl<D: Domain> LightKind<D> for Point {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: &Surface<D>, _: [D::F; 3]) -> LightSample<D> {
        let position = vector(d, record, 1);
        let towards = position - from.point;
        // Finite even where the point lies on the light (hard case L-11).
        let distance = d.max(towards.length(d), d.lit(1e-6));
        let one = d.lit(1.0);
        LightSample {
            wi: towards.scale(one / distance),
            position,
            infinite: d.truth(false),
            radiance: vector(d, record, 4).scale(one / (distance * distance)),
            pdf: one,
            delta: d.truth(true),
        }
    }
}

impl<D: Domain> LightKind<D> for Spot {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: &Surface<D>, u: [D::F; 3]) -> LightSample<D> {
        let everywhere = Point.sample(d, record, from, u);
        let cos = -vector(d, record, 7).dot(d, everywhere.wi);
        let scale = d.load_real(Buffer::Lights, record + d.uint(10));
        let offset = d.load_real(Buffer::Lights, record + d.uint(11));
        let falloff = d.min(d.max(d.fma(cos, scale, offset), d.lit(0.0)), d.lit(1.0));
        LightSample {
            radiance: everywhere.radiance.scale(falloff * falloff),
            ..everywhere
        }
    }
}

impl<D: Domain> LightKind<D> for Directional {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, _: &Surface<D>, _: [D::F; 3]) -> LightSample<D> {
        let towards = vector(d, record, 1);
        LightSample {
            wi: towards,
            position: towards,
            infinite: d.truth(true),
            radiance: vector(d, record, 4),
            pdf: d.lit(1.0),
            delta: d.truth(true),
        }
    }
}
