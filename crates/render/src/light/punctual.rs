//! Point, spot and directional lights (KHR_lights_punctual).
//!
//! Records: kind, position (or, directional, the unit direction towards the light); intensity, scale; the unit axis,
//! offset. Axis, scale and offset are of spots alone: `clamp(cos·scale + offset)²` as the extension recommends.

use super::{LightKind, LightSample};
use crate::domain::{Buffer, Domain};
use crate::math::Vec3;

/// Shines everywhere from a point.
#[derive(Clone, Copy, Debug)]
pub struct Point;
/// Shines into a cone.
#[derive(Clone, Copy, Debug)]
pub struct Spot;
/// Shines along one direction from infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct Directional;

/// A record: position, intensity and scale, axis and offset.
struct Record<D: Domain> {
    position: Vec3<D::F>,
    intensity: Vec3<D::F>,
    scale: D::F,
    axis: Vec3<D::F>,
    offset: D::F,
}

impl<D: Domain> Record<D> {
    #[inline(always)]
    fn load(d: D, first: D::U) -> Self {
        let [[_, x, y, z], intensity, axis] = d.load_rows(Buffer::Lights, first);
        Self {
            position: Vec3::from_row(d, [x, y, z, first]),
            intensity: Vec3::from_row(d, intensity),
            scale: d.from_bits(intensity[3]),
            axis: Vec3::from_row(d, axis),
            offset: d.from_bits(axis[3]),
        }
    }

    /// The light of the record, shining everywhere from its position.
    #[inline(always)]
    fn arriving_at(&self, d: D, to: Vec3<D::F>) -> LightSample<D> {
        let towards = self.position - to;
        // Finite even where the point lies on the light (hard case L-11).
        let distance = d.max(towards.length(d), d.lit(1e-6));
        let one = d.lit(1.0);
        LightSample {
            wi: towards.scale(one / distance),
            position: self.position,
            infinite: d.truth(false),
            radiance: self.intensity.scale(one / (distance * distance)),
            pdf: one,
            delta: d.truth(true),
        }
    }
}

impl<D: Domain> LightKind<D> for Point {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, _: [D::F; 3]) -> LightSample<D> {
        Record::load(d, record).arriving_at(d, from)
    }
}

impl<D: Domain> LightKind<D> for Spot {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, _: [D::F; 3]) -> LightSample<D> {
        let record = Record::load(d, record);
        let everywhere = record.arriving_at(d, from);
        let cos = -record.axis.dot(d, everywhere.wi);
        let falloff = d.fma(cos, record.scale, record.offset);
        let falloff = d.min(d.max(falloff, d.lit(0.0)), d.lit(1.0));
        LightSample {
            radiance: everywhere.radiance.scale(falloff * falloff),
            ..everywhere
        }
    }
}

impl<D: Domain> LightKind<D> for Directional {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, _: Vec3<D::F>, _: [D::F; 3]) -> LightSample<D> {
        let record = Record::load(d, record);
        LightSample {
            wi: record.position,
            position: record.position,
            infinite: d.truth(true),
            radiance: record.intensity,
            pdf: d.lit(1.0),
            delta: d.truth(true),
        }
    }
}
