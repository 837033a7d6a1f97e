//! Alpha: whether a surface is there at all. Asked by traversal, one hit at a time, where a scene has alpha.

use residual_bvh::{Hit, Ray};

use crate::domain::{Buffers, Domain, Scalar, Uint};
use crate::math::Vec3;
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

/// Whether the surface is there for this hit of the ray from `org` in direction `dir`.
#[inline(always)]
pub fn covers<D: Domain, A: ScalarSource<D>, C: ScalarSource<D>>(
    d: D,
    attributes: Attributes,
    alpha: &A,
    test: &AlphaTest<C>,
    [org, dir]: [Vec3<D::F>; 2],
    hit: &surface::Hit<D>,
) -> D::M {
    let surface = Surface::new(d, attributes, hit, dir);
    let alpha = alpha.scalar(d, &surface);
    match test {
        AlphaTest::Mask(cutoff) => d.le(cutoff.scalar(d, &surface), alpha),
        AlphaTest::Blend => {
            let [o, p, q] = [org.x, org.y, org.z].map(|c| d.to_bits(c));
            let [x, y, z] = [dir.x, dir.y, dir.z].map(|c| d.to_bits(c));
            let key = [o, p, q, x, y, z, hit.prim]
                .into_iter()
                .fold(d.uint(0), |key, bits| hash(d, key ^ bits));
            d.lt(unit(d, key), alpha)
        }
    }
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
    let place = surface::Hit {
        u: hit.u,
        v: hit.v,
        prim: Uint(hit.prim),
    };
    let ray = [ray.org, ray.dir].map(|[x, y, z]| vec3(x, y, z));
    covers(Scalar::new(buffers), attributes, alpha, test, ray, &place)
}
