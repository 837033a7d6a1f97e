//! Alpha: whether a surface is there at all. Asked by traversal, one hit at a time, where a scene has alpha.

use residual_bvh::{Hit, Ray};

use crate::domain::{Buffers, Scalar};
use crate::math::vec3::vec3;
use crate::sampler::{hash, unit};
use crate::surface::{self, Attributes, Surface};
use crate::texture::ScalarSource;

/// What alpha is compared with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaTest<C> {
    /// There where alpha ≥ this cutoff.
    Mask(C),
    /// There with probability alpha. The decision is a hash of ray and triangle, so that every traversal of the
    /// same ray decides alike.
    Blend,
}

/// Whether the surface is there for this hit of this ray.
#[inline(always)]
pub fn is_there<'a, A: ScalarSource<Scalar<'a>>, C: ScalarSource<Scalar<'a>>>(
    buffers: &'a Buffers<'a>,
    attributes: Attributes,
    alpha: &A,
    test: &AlphaTest<C>,
    ray: &Ray,
    hit: &Hit,
) -> bool {
    let d = Scalar::new(buffers);
    let word = crate::domain::Uint;
    let place = surface::Hit { u: hit.u, v: hit.v, prim: word(hit.prim) };
    let [x, y, z] = ray.dir;
    let surface = Surface::new(d, attributes, &place, vec3(x, y, z));
    let alpha = alpha.scalar(d, &surface);
    match test {
        AlphaTest::Mask(cutoff) => alpha >= cutoff.scalar(d, &surface),
        AlphaTest::Blend => {
            let [o, p, q] = ray.org.map(f32::to_bits);
            let [x, y, z] = ray.dir.map(f32::to_bits);
            let key = [o, p, q, x, y, z, hit.prim]
                .into_iter()
                .fold(word(0), |key, bits| hash(d, key ^ word(bits)));
            unit(d, key) < alpha
        }
    }
}
