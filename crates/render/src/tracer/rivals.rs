//! Multiple importance sampling of paths that begin at the camera and of paths that begin at lights (Veach 1997, sections 8.3.2 and
//! 10.2; the recurrence is that of Georgiev 2012, "Implementing vertex connection and merging").
//!
//! The same path from a light to the camera may be found by a BSDF sample that meets the light, by a light sample, or by a light
//! path whose last vertex is seen by the camera. The power heuristic weighs what one of them found by the densities that all of
//! them have for it. A path carries what it knows of that from vertex to vertex: with x the vertex, `in` and `out` the cosines
//! at its surface of the ways it was reached and is left by, and `back` the density with which a path the other way round would
//! have turned from `out` to `in`,
//!
//! `onward` = `carried` · `back` · `out` / `in`, and carried on is `onward` / density of the direction.
//!
//! It is what the rivals' density is in proportion to ours up to here, but for the squared distances, which cancel between
//! neighbours. At the first vertex, where a rival path would end, there is no `back`: its term is 1 over the density, per area
//! across the ray, with which our path gets there. At the other end `onward` is multiplied with the same of the rival's. Delta
//! lobes have density 1 both ways. Roulette, and how far paths get in media, are left out on both sides.

use super::{Vertex, consistent};
use crate::bsdf::{Bsdf, BsdfValue};
use crate::domain::Domain;
use crate::math::Vec3;

/// Larger ratios are as good as this one; its square is finite.
const LARGEST: f64 = 1e18;

/// The cosine between a direction and the surface, 1 at a place within a medium.
#[inline(always)]
pub(super) fn cosine<D: Domain, B>(d: D, vertex: &Vertex<'_, D, B>, dir: Vec3<D::F>) -> D::F {
    if vertex.is_in_medium {
        return d.lit(1.0);
    }
    let cos = d.abs(vertex.surface.geometric_normal.dot(d, dir));
    d.max(cos, d.lit(1e-6))
}

/// The BSDF the other way round.
pub(super) struct Reversed<D: Domain> {
    /// Its value, with the cosine of the way along which the path came, for light that comes from there and goes to `out`, and the
    /// density of that way for a path from `out`.
    pub(super) value: BsdfValue<D>,
    /// A path from `out` could go that way: it is on the same side of the geometric and of the shading surface.
    pub(super) is_consistent: D::M,
}

/// The BSDF for light that comes the way of the path and goes to `out`.
#[inline(always)]
pub(super) fn reversed<D: Domain, B: Bsdf<D>>(
    d: D,
    vertex: &Vertex<'_, D, B>,
    out: Vec3<D::F>,
) -> Reversed<D> {
    let Vertex { surface, bsdf, .. } = *vertex;
    if vertex.is_in_medium {
        let [from, to] = [vertex.wo, out].map(|dir| surface.frame.to_local(d, dir));
        return Reversed {
            value: bsdf.eval(d, surface, to, from),
            is_consistent: d.truth(true),
        };
    }
    // Coats, rough glass and shading normals are not the same from both ends.
    let surface = surface.seen_along(d, out);
    let [from, to] = [vertex.wo, out].map(|dir| surface.frame.to_local(d, dir));
    Reversed {
        value: bsdf.eval(d, &surface, to, from),
        is_consistent: consistent(d, &surface, vertex.wo, from),
    }
}

/// A way through a vertex, as rivals see it.
pub(super) struct Turn<D: Domain> {
    /// 1 over our density at the path's first vertex, if this is one and a rival can turn here.
    pub(super) first: D::F,
    /// It is the path's first vertex.
    pub(super) is_first: D::M,
    /// What the path has carried here.
    pub(super) carried: D::F,
    /// The density of the turn the other way round.
    pub(super) back: D::F,
    /// Cosines of the way it was reached and is left by.
    pub(super) cosines: [D::F; 2],
}

impl<D: Domain> Turn<D> {
    /// `onward`, as above.
    #[inline(always)]
    pub(super) fn onward(self, d: D) -> D::F {
        let [reached, left] = self.cosines;
        let ratio = d.select(self.is_first, self.first, self.carried * self.back);
        d.min(ratio * (left / reached), d.lit(LARGEST))
    }
}

/// What is carried on, in a direction of this density; 0 is that of a delta lobe.
#[inline(always)]
pub(super) fn carried_on<D: Domain>(d: D, onward: D::F, density: D::F) -> D::F {
    let is_delta = d.eq(density, d.lit(0.0));
    d.min(
        onward / d.select(is_delta, d.lit(1.0), density),
        d.lit(LARGEST),
    )
}

/// The weight of what has weight `own` among strategies of its own end, where the rival at the other end has `ratio` times its
/// density.
#[inline(always)]
pub(super) fn shared<D: Domain>(d: D, own: D::F, ratio: D::F) -> D::F {
    let one = d.lit(1.0);
    let ratio = d.min(ratio, d.lit(LARGEST));
    one / d.fma(ratio, ratio, one / own)
}
