//! What becomes of a path between two surfaces.

use crate::domain::Domain;
use crate::math::Color;

/// What a ray finds on its way to a surface.
#[derive(Clone, Copy)]
pub struct Passage<D: Domain> {
    /// What the path counts for at the end of its way, over what it counted for at its start.
    pub weight: Color<D::F>,
    /// Where it is scattered before it gets to the surface, if it may be.
    pub scattering: Option<Scattering<D>>,
}

/// A place where a ray is scattered by what is in a medium.
#[derive(Clone, Copy)]
pub struct Scattering<D: Domain> {
    /// The ray is scattered, and gets to no surface.
    pub happens: D::M,
    /// Distance from the ray's origin.
    pub distance: D::F,
    /// Mean cosine between the directions before and after.
    pub anisotropy: D::F,
}
