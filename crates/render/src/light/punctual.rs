//! Point, spot and directional lights (KHR_lights_punctual).
//!
//! A spot's intensity falls off with `clamp(cos·scale + offset)²`, as the extension recommends.

use super::{LightKind, LightSample};
use crate::domain::{Buffer, Domain};
use crate::math::Vec3;
use crate::record::record;

/// Shines everywhere from a point.
#[derive(Clone, Copy, Debug)]
pub struct Point;
/// Shines into a cone.
#[derive(Clone, Copy, Debug)]
pub struct Spot;
/// Shines along one direction from infinitely far away.
#[derive(Clone, Copy, Debug)]
pub struct Directional;

record! {
    /// A light without extent.
    pub struct PunctualRecord {
        row {
            /// Index of its kind in the scene's list of kinds.
            kind: word,
            /// World space. Of a directional light, the unit direction towards it.
            position: vector,
        }
        row {
            /// Radiant intensity; of a directional light, irradiance at normal incidence.
            intensity: vector,
            /// Of a spot: what the cosine of the angle to the axis is multiplied with.
            scale: real,
        }
        row {
            /// Of a spot: the unit direction in which it shines.
            axis: vector,
            /// Of a spot: what is added to the scaled cosine.
            offset: real,
        }
    }
}

const _: () = assert!(PunctualRecord::WORDS == 12);

impl PunctualRecord {
    /// A light that is no spot.
    pub fn new(kind: u32, position: [f32; 3], intensity: [f32; 3]) -> Self {
        Self {
            kind,
            position: position.into(),
            intensity: intensity.into(),
            scale: 0.0,
            axis: [0.0; 3].into(),
            offset: 0.0,
        }
    }
}

impl<D: Domain> PunctualRecord<D> {
    #[inline(always)]
    fn of_light(d: D, record: D::U) -> Self {
        Self::load_at(d, Buffer::Lights, record)
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
        PunctualRecord::of_light(d, record).arriving_at(d, from)
    }
}

impl<D: Domain> LightKind<D> for Spot {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, _: [D::F; 3]) -> LightSample<D> {
        let record = PunctualRecord::of_light(d, record);
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
        let record = PunctualRecord::of_light(d, record);
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
