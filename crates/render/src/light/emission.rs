//! Light that leaves lights: where light paths begin.

use crate::camera::{CameraRecord, PixelConeRecord};
use crate::domain::{Buffer, Bundle, Domain};
use crate::math::warp::disc;
use crate::math::{Color, Frame, Vec3};
use crate::record::record;
use crate::surface::PathRay;

record! {
    /// A sphere around all surfaces, behind the camera's records. Only where paths begin at lights.
    pub struct SceneSphereRecord {
        row {
            /// Its centre.
            centre: vector,
            /// Its radius.
            radius: real,
        }
    }
}

impl<D: Domain> SceneSphereRecord<D> {
    /// The scene's.
    #[inline(always)]
    pub fn of_scene(d: D) -> Self {
        let first = CameraRecord::WORDS + PixelConeRecord::WORDS;
        Self::uniform_at(d, Buffer::Camera, first)
    }

    /// The area of a disc that covers the sphere.
    #[inline(always)]
    pub fn disc_area(&self, d: D) -> D::F {
        self.radius * self.radius * d.lit(std::f64::consts::PI)
    }
}

/// Light that leaves a light along a sampled ray.
#[derive(Clone, Copy, Debug)]
pub struct Emission<D: Domain> {
    /// The way of the light, whose direction is a unit vector. That of a light infinitely far away begins outside of the scene.
    pub ray: PathRay<D>,
    /// Flux: radiance · cosine ÷ density of place and direction.
    pub flux: Color<D::F>,
    /// Density of the direction, per steradian; of a light that is infinitely far away, of the place, per area across the ray.
    pub spread: D::F,
    /// Density of a light sample that leads back along the ray, per steradian; of a light that is not infinitely far away, at
    /// distance 1. [`NOT_FOUND`] for lights that no ray can meet.
    pub found: D::F,
    /// The light is infinitely far away.
    pub infinite: D::M,
}

/// The density of a light sample that no BSDF sample competes with.
pub const NOT_FOUND: f64 = 1e30;

impl<D: Domain> Bundle<D> for Emission<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            ray: PathRay::choose(d, mask, a.ray, b.ray),
            flux: Vec3::choose(d, mask, a.flux, b.flux),
            spread: d.select(mask, a.spread, b.spread),
            found: d.select(mask, a.found, b.found),
            infinite: d.select_mask(mask, a.infinite, b.infinite),
        }
    }
}

/// The numbers that emission is sampled with.
#[derive(Clone, Copy)]
pub struct EmissionNumbers<F> {
    /// The place on the light, or the direction of one that is infinitely far away.
    pub place: [F; 2],
    /// A third number for it, where a light [takes three](super::LightKind::takes_three).
    pub third: F,
    /// The direction, or the place across the ray of a light that is infinitely far away.
    pub direction: [F; 2],
}

impl<D: Domain> Emission<D> {
    /// What arrives along the unit direction `-wi` from infinitely far away, as much radiance over density as `weight`, somewhere
    /// in the scene. `found` is the density of the direction.
    #[inline(always)]
    pub(super) fn from_afar(
        d: D,
        wi: Vec3<D::F>,
        weight: Color<D::F>,
        found: D::F,
        u: [D::F; 2],
    ) -> Self {
        let sphere = SceneSphereRecord::of_scene(d);
        let [x, y] = disc(d, u).map(|c| c * sphere.radius);
        let frame = Frame::around(d, wi);
        let across = frame.tangent.scale(x) + frame.bitangent.scale(y);
        let area = sphere.disc_area(d);
        // Far enough away that rounding leaves it outside.
        let away = wi.scale(sphere.radius * d.lit(1.01));
        Self {
            ray: PathRay::unbounded(d, sphere.centre + across + away, -wi),
            flux: weight.scale(area),
            spread: d.lit(1.0) / area,
            found,
            infinite: d.truth(true),
        }
    }
}
