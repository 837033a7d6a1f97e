//! How rough a surface is: the distribution of its microfacets.

use super::ggx::Ggx;
use crate::domain::Domain;
use crate::surface::Surface;
use crate::texture::ScalarSource;

/// Gives the distribution of microfacets at a point of a surface.
pub trait Roughness<D: Domain> {
    /// The distribution.
    fn microfacets(&self, d: D, surface: &Surface<D>) -> Ggx<D::F>;
}

/// The same in all directions.
#[derive(Clone, Copy, Debug)]
pub struct Isotropic<R> {
    /// Perceptual roughness, in [0, 1].
    pub roughness: R,
}

/// Rougher along the tangent (KHR_materials_anisotropy).
#[derive(Clone, Copy, Debug)]
pub struct Anisotropic<R, A> {
    /// Perceptual roughness across the tangent, in [0, 1].
    pub roughness: R,
    /// How much rougher it is along the tangent, in [0, 1].
    pub anisotropy: A,
}

impl<D: Domain, R: ScalarSource<D>> Roughness<D> for Isotropic<R> {
    #[inline(always)]
    fn microfacets(&self, d: D, surface: &Surface<D>) -> Ggx<D::F> {
        Ggx::from_roughness(d, self.roughness.scalar(d, surface))
    }
}

impl<D: Domain, R: ScalarSource<D>, A: ScalarSource<D>> Roughness<D> for Anisotropic<R, A> {
    #[inline(always)]
    fn microfacets(&self, d: D, surface: &Surface<D>) -> Ggx<D::F> {
        let roughness = self.roughness.scalar(d, surface);
        Ggx::anisotropic(d, roughness, self.anisotropy.scalar(d, surface))
    }
}
