//! Lights: what next-event estimation samples, and what rays that miss everything see.
//!
//! A scene's kinds of lights are a type list, `(A, (B, ()))`, so that a renderer contains the kinds that its
//! scene has and no others. One light is picked, from an alias table by its power or from a [tree](LightTree) by what may arrive
//! at the point, then sampled by its kind.

mod area;
mod area_by_solid_angle;
mod by_tree;
mod cone;
mod emission;
mod environment;
mod kinds;
mod pick;
mod punctual;
#[cfg(test)]
mod record_tests;
mod scene_lights;
mod sized;
mod tree;

pub use area::{Area, AreaRecord};
pub use area_by_solid_angle::{AreaBySolidAngle, AreaBySolidAngleRecord};
pub use by_tree::ByTree;
pub use emission::{Emission, EmissionNumbers, NOT_FOUND, SceneSphereRecord};
pub use environment::{Environment, EnvironmentHeader, set_environment};
pub(crate) use kinds::of_list;
pub use kinds::{KindIndex, LightKinds};
pub use pick::{
    LIGHT_WORDS, LightRecord, Pick, PickHeader, pick, pick_probability, push_light, set_picks,
};
pub use punctual::{Directional, Point, PunctualRecord, Spot, versine};
pub use scene_lights::{background, density, emit, sample, spread};
pub use sized::{SphericalPoint, SphericalSpot, Sun};
pub use tree::{ClusterRecord, EVERYWHERE, LEAF, LightTree, LightTreeHeader, set_light_tree};

use crate::domain::{Bundle, Domain};
use crate::math::{Color, Vec3};
use crate::surface::{PathRay, Surface};

/// Light arriving at a point from one sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct LightSample<D: Domain> {
    /// Unit direction towards the light.
    pub wi: Vec3<D::F>,
    /// The point it comes from; unused where `infinite`.
    pub position: Vec3<D::F>,
    /// It comes from infinitely far away.
    pub infinite: D::M,
    /// Arriving radiance; for delta lights, radiance over density, which is irradiance at normal incidence of a light without a size.
    pub radiance: Color<D::F>,
    /// Density per steradian; 1 for delta lights.
    pub pdf: D::F,
    /// No BSDF sample can find this light.
    pub delta: D::M,
    /// Density with which light that leaves its point has the direction back, per steradian; 0 where `infinite`.
    pub spread: D::F,
}

impl<D: Domain> Bundle<D> for LightSample<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            wi: Vec3::choose(d, mask, a.wi, b.wi),
            position: Vec3::choose(d, mask, a.position, b.position),
            infinite: d.select_mask(mask, a.infinite, b.infinite),
            radiance: Vec3::choose(d, mask, a.radiance, b.radiance),
            pdf: d.select(mask, a.pdf, b.pdf),
            delta: d.select_mask(mask, a.delta, b.delta),
            spread: d.select(mask, a.spread, b.spread),
        }
    }
}

/// Radiance from infinitely far away, and the density with which sampling proposes its direction.
#[derive(Clone, Copy, Debug)]
pub struct Background<D: Domain> {
    /// Radiance.
    pub radiance: Color<D::F>,
    /// Density per steradian, without the pick of the light.
    pub pdf: D::F,
    /// Index of the light.
    pub light: D::U,
}

/// A kind of light.
pub trait LightKind<D: Domain> {
    /// Whether [`sample`](LightKind::sample) takes a third number.
    fn takes_three(&self) -> bool {
        false
    }

    /// Samples the light whose record starts at word `record` for the point `from`.
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D>;

    /// Samples the light whose record starts at word `record`: what leaves it.
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D>;

    /// What a ray in the unit direction `dir` that hits nothing sees of lights of this kind.
    fn background(&self, _: D, _dir: Vec3<D::F>) -> Option<Background<D>> {
        None
    }

    /// Density, per steradian, with which [`sample`](LightKind::sample) proposes to the origin of `ray` the direction
    /// of `ray`, which met the light with this record at `seen`. `None` for lights that no ray can meet.
    fn density(&self, _: D, _record: D::U, _ray: &PathRay<D>, _seen: &Surface<D>) -> Option<D::F> {
        None
    }

    /// Density, per steradian, with which light that leaves the light with this record at `seen` goes back along the ray that met
    /// it. `None` for lights that no ray can meet.
    fn spread(&self, _: D, _record: D::U, _seen: &Surface<D>) -> Option<D::F> {
        None
    }
}

/// Multiple importance sampling's power heuristic, in the form that neither overflows nor divides 0 by 0
/// (hard case L-09): the weight of a sample of density `a` > 0 where the other strategy's density is `b`.
#[inline(always)]
pub fn power_heuristic<D: Domain>(d: D, a: D::F, b: D::F) -> D::F {
    let ratio = b / a;
    d.lit(1.0) / d.fma(ratio, ratio, d.lit(1.0))
}
