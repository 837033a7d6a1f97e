//! Point, spot and directional lights without a size (KHR_lights_punctual), and the record that those [with a size](super::sized) share.
//!
//! A spot's intensity falls off with `clamp((cos − cos outer) / (cos inner − cos outer))²`, as the extension recommends.
//! Cosines of small angles are 1 in 32 bits; so the formula is written in versines, 1 − cos θ = |a + b|²/2 of unit vectors
//! a and −b, which keep their digits in cones of any width.

use super::cone::in_cone;
use super::{Emission, EmissionNumbers, LightKind, LightSample, NOT_FOUND};
use crate::domain::{Buffer, Domain};
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::record::record;
use crate::surface::PathRay;

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
    /// A point, spot or directional light.
    pub struct PunctualRecord {
        row {
            /// Index of its kind in the scene's list of kinds.
            kind: word,
            /// World space. Of a directional light, the unit direction towards it.
            position: vector,
        }
        row {
            /// Radiant intensity; of a directional light, irradiance at normal incidence; of a sun, what a sample brings.
            intensity: vector,
            /// Of a spot: what a versine's difference to that of the edge is multiplied with.
            scale: real,
        }
        row {
            /// Of a spot: the direction in which it shines, a unit vector; of a sphere, as long as its radius.
            axis: vector,
            /// Of a spot: the versine of the half-angle at which it ends; of a sun: that of its angular radius.
            edge: real,
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
            edge: 0.0,
        }
    }

    /// A spot that shines along the unit vector `axis`, with its full intensity up to the half-angle `inner` and with
    /// none beyond `outer`, both in radians, `inner` ≤ `outer`. Where the two are the same, its edge is hard.
    pub fn spot(
        kind: u32,
        position: [f32; 3],
        intensity: [f32; 3],
        axis: [f32; 3],
        [inner, outer]: [f32; 2],
    ) -> Self {
        let (full, edge) = (versine(inner), versine(outer));
        Self {
            scale: (1.0 / (edge - full)).min(f64::from(f32::MAX)) as f32,
            axis: axis.into(),
            edge: edge as f32,
            ..Self::new(kind, position, intensity)
        }
    }

    /// A sphere of this radius, greater than zero, instead of a point or spot light.
    pub fn with_radius(self, radius: f32) -> Self {
        let axis = match self.axis.to_array() {
            [0.0, 0.0, 0.0] => [0.0, 0.0, 1.0],
            axis => axis,
        };
        Self {
            axis: axis.map(|component| component * radius).into(),
            ..self
        }
    }

    /// A disc of the sky around the unit vector `position`, of which `diameter` is seen, in radians, up to π. Whatever the
    /// diameter, a surface that faces the disc's middle gets the irradiance `intensity`.
    pub fn sun(kind: u32, position: [f32; 3], intensity: [f32; 3], diameter: f32) -> Self {
        let edge = versine(0.5 * diameter);
        // Radiance is irradiance over π·sin² α, and density 1 over 2π·(1 − cos α).
        let weight = (2.0 / (2.0 - edge)) as f32;
        Self {
            edge: edge as f32,
            ..Self::new(kind, position, intensity.map(|channel| channel * weight))
        }
    }
}

/// 1 − cos of an angle in radians, without cancellation.
pub fn versine(angle: f32) -> f64 {
    2.0 * (0.5 * f64::from(angle)).sin().powi(2)
}

impl<D: Domain> PunctualRecord<D> {
    #[inline(always)]
    pub(super) fn of_light(d: D, record: D::U) -> Self {
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
            spread: d.lit(EVERYWHERE),
        }
    }

    /// What leaves a light at `place` in a direction of a cone around the unit vector `axis` that shines everywhere, with the
    /// versine of the direction. `widest` is the versine of the cone's half-angle.
    #[inline(always)]
    pub(super) fn leaving(
        &self,
        d: D,
        (axis, widest): (Vec3<D::F>, D::F),
        u: [D::F; 2],
    ) -> (Emission<D>, D::F) {
        let (dir, versine) = in_cone(d, axis, widest, u);
        let solid_angle = widest * d.lit(TURN);
        let emission = Emission {
            ray: PathRay::unbounded(d, self.position, dir),
            flux: self.intensity.scale(solid_angle),
            spread: d.lit(1.0) / solid_angle,
            found: d.lit(NOT_FOUND),
            infinite: d.truth(false),
        };
        (emission, versine)
    }

    /// What leaves a spot around the unit vector `axis`.
    #[inline(always)]
    pub(super) fn leaving_spot(&self, d: D, axis: Vec3<D::F>, u: [D::F; 2]) -> Emission<D> {
        let (everywhere, versine) = self.leaving(d, (axis, self.edge), u);
        Emission {
            flux: self.fallen_off(d, versine, everywhere.flux),
            ..everywhere
        }
    }

    /// What is left of `color` at this versine to the axis of a spot.
    #[inline(always)]
    fn fallen_off(&self, d: D, versine: D::F, color: Color<D::F>) -> Color<D::F> {
        let falloff = (self.edge - versine) * self.scale;
        let falloff = d.min(d.max(falloff, d.lit(0.0)), d.lit(1.0));
        color.scale(falloff * falloff)
    }

    /// What is left of a sample of a light that shines everywhere, where it shines into the cone of the record around the unit
    /// vector `axis`.
    #[inline(always)]
    pub(super) fn within_cone(
        &self,
        d: D,
        axis: Vec3<D::F>,
        everywhere: LightSample<D>,
    ) -> LightSample<D> {
        let across = axis + everywhere.wi;
        let versine = across.dot(d, across) * d.lit(0.5);
        LightSample {
            radiance: self.fallen_off(d, versine, everywhere.radiance),
            spread: d.lit(1.0) / (self.edge * d.lit(TURN)),
            ..everywhere
        }
    }
}

/// 2π: the solid angle of a cone whose half-angle has a versine of 1.
const TURN: f64 = std::f64::consts::TAU;
/// Density of directions that are evenly spread over the sphere, per steradian.
pub(super) const EVERYWHERE: f64 = 0.5 / TURN;

/// The cone of all directions.
#[inline(always)]
pub(super) fn all_directions<D: Domain>(d: D) -> (Vec3<D::F>, D::F) {
    let zero = d.lit(0.0);
    (vec3(zero, zero, d.lit(1.0)), d.lit(2.0))
}

impl<D: Domain> LightKind<D> for Point {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, _: [D::F; 3]) -> LightSample<D> {
        PunctualRecord::of_light(d, record).arriving_at(d, from)
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = PunctualRecord::of_light(d, record);
        record.leaving(d, all_directions(d), u.direction).0
    }
}

impl<D: Domain> LightKind<D> for Spot {
    #[inline(always)]
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, _: [D::F; 3]) -> LightSample<D> {
        let record = PunctualRecord::of_light(d, record);
        record.within_cone(d, record.axis, record.arriving_at(d, from))
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = PunctualRecord::of_light(d, record);
        record.leaving_spot(d, record.axis, u.direction)
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
            spread: d.lit(0.0),
        }
    }

    #[inline(always)]
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D> {
        let record = PunctualRecord::of_light(d, record);
        let found = d.lit(NOT_FOUND);
        Emission::from_afar(d, record.position, record.intensity, found, u.direction)
    }
}
