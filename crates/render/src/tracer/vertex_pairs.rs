//! Which pair of random numbers is for what at a vertex of a path. Those of vertex 0, the camera, come first
//! ([`camera_pairs`]).

use super::{MAX_DEPTH, Path, camera_pairs};
use crate::domain::Domain;
use crate::sampler::Sampler;

/// The light, and the place on it; of a light path, the place on the lens.
pub(super) const LIGHT: u32 = 0;
/// First: the texel of an environment. Second: how far a ray gets in a medium.
pub(super) const LIGHT_TEXEL_AND_MEDIUM: u32 = 1;
/// The direction in which the path goes on.
pub(super) const BSDF_DIRECTION: u32 = 2;
/// The lobe, and whether the path goes on at all.
pub(super) const LOBE_AND_ROULETTE: u32 = 3;
/// How many there are.
const COUNT: u32 = 4;
const _: () = assert!(camera_pairs::COUNT <= COUNT);

/// Behind the pairs of all vertices there is one more for each: its first number chooses levels of images. Scenes without levels
/// have the numbers of before.
#[inline(always)]
pub(super) fn pair_of_levels<D: Domain, S: Sampler<D>>(
    d: D,
    sampler: &S,
    path: &Path<D>,
) -> [D::F; 2] {
    let dimension = path.state.depth(d) + d.uint(COUNT * (MAX_DEPTH + 1));
    sampler.pair(d, path.key, dimension)
}

/// A pair of the vertex that a path is looking for.
#[inline(always)]
pub(super) fn pair<D: Domain, S: Sampler<D>>(
    d: D,
    sampler: &S,
    path: &Path<D>,
    pair: u32,
) -> [D::F; 2] {
    let dimension = path.state.depth(d) * d.uint(COUNT) + d.uint(pair);
    sampler.pair(d, path.key, dimension)
}
