//! Alpha tests: whether a surface is there at all. Traversal makes them, one hit at a time, where a scene has any.

use crate::domain::{Buffers, Domain, Scalar, Uint};
use crate::math::Vec3;
use crate::sampler::{hash, unit};
use crate::surface::{self, Attributes, Surface};
use crate::texture::ScalarSource;

/// A test of alpha.
pub trait AlphaTest<D: Domain> {
    /// Whether the surface is there for this hit of the ray, given by origin and direction. A pure function of both, so
    /// that every traversal of the same ray decides alike.
    fn passes(&self, d: D, ray: [Vec3<D::F>; 2], hit: &surface::SurfaceHit<D>) -> D::M;
}

/// There where alpha is at least a cutoff.
#[derive(Clone, Copy, Debug)]
pub struct AlphaMask<A, C> {
    /// Alpha.
    pub alpha: A,
    /// The cutoff.
    pub cutoff: C,
    /// What the two read.
    pub attributes: Attributes,
}

/// There with probability alpha. The decision is a hash of ray and triangle.
#[derive(Clone, Copy, Debug)]
pub struct AlphaBlend<A> {
    /// Alpha.
    pub alpha: A,
    /// What it reads.
    pub attributes: Attributes,
}

impl<D: Domain, A: ScalarSource<D>, C: ScalarSource<D>> AlphaTest<D> for AlphaMask<A, C> {
    #[inline(always)]
    fn passes(&self, d: D, [_, dir]: [Vec3<D::F>; 2], hit: &surface::SurfaceHit<D>) -> D::M {
        let surface = Surface::new(d, self.attributes, hit, dir);
        let alpha = self.alpha.scalar(d, &surface);
        d.le(self.cutoff.scalar(d, &surface), alpha)
    }
}

impl<D: Domain, A: ScalarSource<D>> AlphaTest<D> for AlphaBlend<A> {
    #[inline(always)]
    fn passes(&self, d: D, [org, dir]: [Vec3<D::F>; 2], hit: &surface::SurfaceHit<D>) -> D::M {
        let surface = Surface::new(d, self.attributes, hit, dir);
        let alpha = self.alpha.scalar(d, &surface);
        let [o, p, q] = [org.x, org.y, org.z].map(|c| d.to_bits(c));
        let [x, y, z] = [dir.x, dir.y, dir.z].map(|c| d.to_bits(c));
        let key = [o, p, q, x, y, z, hit.prim]
            .into_iter()
            .fold(d.uint(0), |key, bits| hash(d, key ^ bits));
        d.lt(unit(d, key), alpha)
    }
}

/// A hit that traversal asks about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// The ray's origin, world space.
    pub org: [f32; 3],
    /// Its direction.
    pub dir: [f32; 3],
    /// Barycentric weights of corners 1 and 2.
    pub uv: [f32; 2],
    /// Index of the triangle.
    pub triangle: u32,
}

/// Makes the test for this hit.
#[inline(always)]
pub fn alpha_test<'a, T: AlphaTest<Scalar<'a>>>(
    buffers: &'a Buffers<'a>,
    test: &T,
    candidate: &Candidate,
) -> bool {
    let [u, v] = candidate.uv;
    let prim = Uint(candidate.triangle);
    let ray = [candidate.org, candidate.dir].map(Vec3::from);
    test.passes(
        Scalar::new(buffers),
        ray,
        &surface::SurfaceHit { u, v, prim },
    )
}
