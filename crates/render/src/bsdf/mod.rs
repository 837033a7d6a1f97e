//! Bidirectional scattering distribution functions, one a file.
//!
//! Directions are unit vectors in the shading frame; `wo` is where the light goes (towards the eye), `wi` where
//! it comes from, both pointing away from the surface. The frame lies on the side of `wo`: `wo.z` > 0. Whether
//! that is the front of the surface is said by [`Surface::front`].
//!
//! To add a BSDF: write one file with a struct generic over its sources, implement [`Bsdf`] (what it is worth, how it proposes
//! directions, its albedo, its kind), and give it a row in the node table (`program/nodes.rs`).

mod albedo_table;
mod azimuth;
mod coated;
mod combine;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod directional_albedo;
mod fresnel;
pub mod ggx;
mod glossy;
mod henyey_greenstein;
mod interface;
mod mirror;
mod own_normal;
mod phong;
mod rough_dielectric;
mod rough_diffuse;
mod rough_sheet;
mod roughness;
mod sheen;
mod thin_film;

pub use coated::Coated;
pub use combine::{Mix, Sum};
pub use dielectric::Dielectric;
pub use diffuse::{Black, Diffuse};
pub use diffuse_transmission::DiffuseTransmission;
pub use directional_albedo::DirectionalAlbedo;
pub use fresnel::{Fresnel, Schlick, SchlickCurve};
pub use glossy::Glossy;
pub use henyey_greenstein::HenyeyGreenstein;
pub use interface::{AnyInterface, Interface, Solid, SolidAmongSolids, Thin};
pub use mirror::Mirror;
pub use own_normal::{LayerFrame, MappedFrame, MeshFrame, OwnNormal};
pub use phong::Phong;
pub use rough_dielectric::{RoughDielectric, rough_dielectric_albedos};
pub use rough_diffuse::RoughDiffuse;
pub use rough_sheet::RoughSheet;
pub use roughness::{Anisotropic, Isotropic, Roughness};
pub use sheen::Sheen;
pub use thin_film::ThinFilm;

use crate::domain::{Bundle, Domain};
use crate::math::{Color, Vec3};
use crate::surface::Surface;

/// A BSDF's value for a pair of directions.
#[derive(Clone, Copy, Debug)]
pub struct BsdfValue<D: Domain> {
    /// f·|cos θᵢ|; 0 for delta lobes.
    pub value: Color<D::F>,
    /// Density, per steradian, with which [`propose`](Bsdf::propose) gives the direction; 0 for delta lobes.
    pub pdf: D::F,
}

/// A direction that a BSDF proposes, without what it is worth.
#[derive(Clone, Copy, Debug)]
pub struct BsdfProposal<D: Domain> {
    /// The direction.
    pub wi: Vec3<D::F>,
    /// f·|cos θᵢ| ÷ probability of a delta lobe; 0 of others, which are evaluated.
    pub weight: Color<D::F>,
    /// The direction came from a delta lobe.
    pub delta: D::M,
    /// Sampling succeeded: a reflected direction is above the surface, a transmitted one below.
    pub possible: D::M,
}

/// A sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample<D: Domain> {
    /// The direction.
    pub wi: Vec3<D::F>,
    /// f·|cos θᵢ| ÷ density; 0 where sampling failed.
    pub weight: Color<D::F>,
    /// Density per steradian; 0 where the direction came from a delta lobe, and where sampling failed.
    pub pdf: D::F,
    /// The direction came from a delta lobe.
    pub delta: D::M,
}

/// What lobes a BSDF has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BsdfKind {
    /// It has lobes that can be evaluated, so next-event estimation makes sense.
    pub scatters: bool,
    /// It has delta lobes.
    pub delta: bool,
}

impl BsdfKind {
    /// The lobes of both.
    #[inline(always)]
    pub fn union(self, other: Self) -> Self {
        Self {
            scatters: self.scatters | other.scatters,
            delta: self.delta | other.delta,
        }
    }
}

/// A BSDF.
pub trait Bsdf<D: Domain> {
    /// Value and density for a pair of directions.
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D>;
    /// Proposes a direction, from two numbers for the direction and one for the choice of a lobe.
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D>;
    /// The proposed direction with what it is worth: the quotient of what [`eval`](Bsdf::eval) says of it, unless the BSDF knows it
    /// in closed form; it then has the same direction, and no weight where that is not possible.
    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let BsdfProposal {
            wi,
            weight,
            delta,
            possible,
        } = self.propose(d, surface, wo, u);
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        if !self.kind().scatters {
            return BsdfSample {
                wi,
                weight,
                pdf: zero,
                delta,
            };
        }
        let BsdfValue { value, pdf } = self.eval(d, surface, wo, wi);
        let possible = d.lt(zero, pdf) & possible & !delta;
        let inverse = one / d.select(possible, pdf, one);
        let quotient = value.scale(inverse).only(d, possible);
        BsdfSample {
            wi,
            weight: Vec3::choose(d, delta, weight, quotient),
            pdf: d.select(possible, pdf, zero),
            delta,
        }
    }
    /// The share of light that returns towards `wo`: what is left for layers below ([`Coated`]), and what Open Image Denoise
    /// wants as the albedo of a first hit. Between 0 and 1 where the sources are. Where the true share has no closed form it
    /// is a fit, or, of lobes that are no coats, an estimate. It may go with what is seen through a surface: a window's is its
    /// tint.
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F>;
    /// The squared index of refraction of what `wi` leads into, relative to the outside; `None` if that is one on both sides.
    /// Radiance is that much larger in there, for a reason of measure and not of light: a path takes the inverse along, and
    /// gives it back on the way out.
    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        let _ = (d, surface, wi);
        None
    }
    /// What lobes there are. Folds to a constant in concrete types, so that code for the rest disappears.
    /// (A method, not an associated constant: boxed nodes need a dyn-compatible trait.)
    fn kind(&self) -> BsdfKind;
}

impl<D: Domain> BsdfValue<D> {
    /// Nothing.
    #[inline(always)]
    pub fn zero(d: D) -> Self {
        Self {
            value: Vec3::splat(d.lit(0.0)),
            pdf: d.lit(0.0),
        }
    }

    /// This value where the mask holds, else nothing.
    #[inline(always)]
    pub fn only(self, d: D, mask: D::M) -> Self {
        Self {
            value: self.value.only(d, mask),
            pdf: d.select(mask, self.pdf, d.lit(0.0)),
        }
    }
}

impl<D: Domain> BsdfProposal<D> {
    /// From a lobe that can be evaluated.
    #[inline(always)]
    pub fn of_lobe(d: D, wi: Vec3<D::F>, possible: D::M) -> Self {
        Self {
            wi,
            weight: Vec3::splat(d.lit(0.0)),
            delta: d.truth(false),
            possible,
        }
    }

    /// From a delta lobe.
    #[inline(always)]
    pub fn of_delta(d: D, wi: Vec3<D::F>, weight: Color<D::F>) -> Self {
        Self {
            wi,
            weight,
            delta: d.truth(true),
            possible: d.truth(true),
        }
    }
}

impl<D: Domain> Bundle<D> for BsdfProposal<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            wi: Vec3::choose(d, mask, a.wi, b.wi),
            weight: Vec3::choose(d, mask, a.weight, b.weight),
            delta: d.select_mask(mask, a.delta, b.delta),
            possible: d.select_mask(mask, a.possible, b.possible),
        }
    }
}
