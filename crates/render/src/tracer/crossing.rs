//! What a path meets where it crosses the surface of a body.

use super::PathState;
use crate::domain::Domain;
use crate::math::Vec3;
use crate::surface::Surface;

/// The surface of a body, as a path meets it.
#[derive(Clone, Copy)]
pub struct Crossing<D: Domain> {
    /// The media of a path that goes through the surface.
    pub beyond: D::U,
    /// Index of refraction of what the body lies in; `None` if nothing encloses bodies.
    pub around: Option<D::F>,
    /// The surface is not there, since it lies within a body that goes before its own; `None` if that never happens.
    pub hidden: Option<D::M>,
}

impl<D: Domain> Crossing<D> {
    /// The state of a path that goes on from the surface in direction `dir`.
    #[inline(always)]
    pub(super) fn towards(
        &self,
        d: D,
        state: PathState<D::U>,
        surface: &Surface<D>,
        dir: Vec3<D::F>,
    ) -> PathState<D::U> {
        let passes = d.lt(surface.geometric_normal.dot(d, dir), d.lit(0.0));
        state.in_media(d, d.select_u(passes, self.beyond, state.media(d)))
    }
}
