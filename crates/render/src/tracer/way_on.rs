//! A way on from a vertex: the direction that the BSDF proposes, and whether the path takes it.

use super::vertex_pairs::{BSDF_DIRECTION, LOBE_AND_ROULETTE, pair};
use super::{Path, Settings, Vertex};
use crate::bsdf::{Bsdf, BsdfSample};
use crate::domain::Domain;
use crate::math::Vec3;
use crate::sampler::Sampler;

/// What a path is to be worth on its way, of the 1 that it begins with. Less takes time for what hardly shows; with more, paths end that
/// light the darker parts of an image (measured from 1/4 to 1).
const LEAST_WORTH: f64 = 1.0 / 3.0;
/// The greatest probability of going on from the vertex [`MORTAL_FROM`] on: between surfaces that lose nothing a path would go on for
/// ever.
const MOST_LIKELY: f64 = 0.95;
/// Before this vertex, a path that is worth [`LEAST_WORTH`] goes on for certain: to end it would be noise, and save little time (measured
/// with 4, 6, 8 and 16).
const MORTAL_FROM: u32 = 8;

/// A sampled direction, and the number that roulette is played with.
pub(super) struct WayOn<D: Domain> {
    /// Where the path came from, in the shading frame.
    pub(super) wo: Vec3<D::F>,
    /// What the BSDF proposes.
    pub(super) sample: BsdfSample<D>,
    /// Its direction, world space.
    pub(super) dir: Vec3<D::F>,
    roulette: D::F,
}

impl<D: Domain> WayOn<D> {
    /// Samples the BSDF; nothing where it has no lobes.
    #[inline(always)]
    pub(super) fn new<B: Bsdf<D>>(
        d: D,
        sampler: &impl Sampler<D>,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Self> {
        let Vertex { surface, bsdf, .. } = *vertex;
        let kind = bsdf.kind();
        if !(kind.scatters || kind.delta) {
            return None;
        }
        let direction = pair(d, sampler, path, BSDF_DIRECTION);
        let [lobe, roulette] = pair(d, sampler, path, LOBE_AND_ROULETTE);
        let wo = surface.frame.to_local(d, vertex.wo);
        let sample = bsdf.sample(d, surface, wo, [direction[0], direction[1], lobe]);
        let dir = surface.frame.to_world(sample.wi).normalize(d);
        Some(Self {
            wo,
            sample,
            dir,
            roulette,
        })
    }

    /// Russian roulette: whether a path goes on that is worth so much, and what it then counts for: one that is worth less than
    /// [`LEAST_WORTH`] is kept so seldom that it counts for that.
    #[inline(always)]
    pub(super) fn survives<B>(
        &self,
        d: D,
        settings: &Settings<D>,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        worth: D::F,
    ) -> (D::M, D::F) {
        let early = d.lt_u(path.state.depth(d), settings.roulette_from);
        let one = d.lit(1.0);
        // Through a medium a path gets out, though after many vertices, each of which would make it more worth and less likely.
        let most = match vertex.is_in_medium {
            true => one,
            false => {
                let is_young = d.lt_u(path.state.depth(d), d.uint(MORTAL_FROM));
                d.select(is_young, one, d.lit(MOST_LIKELY))
            }
        };
        let survival = d.select(early, one, d.min(worth * d.lit(1.0 / LEAST_WORTH), most));
        let alive = d.lt(d.lit(0.0), worth) & (early | d.lt(self.roulette, survival));
        (alive, one / d.select(alive, survival, one))
    }
}
