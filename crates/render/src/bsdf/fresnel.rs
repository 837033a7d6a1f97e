//! How much facets reflect: Schlick's approximation with a colour.

use crate::domain::Domain;
use crate::math::fresnel::schlick_weight;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// Gives the reflectance of the facets of a surface.
pub trait Fresnel<D: Domain> {
    /// The reflectance where light meets a facet at an angle of this cosine.
    fn reflectance(&self, d: D, surface: &Surface<D>, cos: D::F) -> Color<D::F>;
    /// The Schlick curve that stands for the reflectances in integrals over the facets that are seen at an angle of about
    /// this cosine.
    fn curve(&self, d: D, surface: &Surface<D>, cos: D::F) -> SchlickCurve<D>;
}

/// Schlick's approximation: from a reflectance at normal incidence to one at grazing incidence.
#[derive(Clone, Copy, Debug)]
pub struct Schlick<N, G> {
    /// Reflectance at normal incidence, F₀.
    pub normal: N,
    /// Reflectance at grazing incidence, F₉₀.
    pub grazing: G,
}

/// The values of [`Schlick`] at a point.
#[derive(Clone, Copy, Debug)]
pub struct SchlickCurve<D: Domain> {
    /// Reflectance at normal incidence.
    pub normal: Color<D::F>,
    /// Reflectance at grazing incidence.
    pub grazing: Color<D::F>,
}

impl<D: Domain> SchlickCurve<D> {
    /// The reflectance at an angle of this cosine.
    #[inline(always)]
    pub fn at(&self, d: D, cos: D::F) -> Color<D::F> {
        self.normal.lerp(self.grazing, schlick_weight(d, cos))
    }

    /// The mean over all directions, weighed by their cosines: ∫ 2cos(1 − cos)⁵ = 1/21.
    #[inline(always)]
    pub fn mean(&self, d: D) -> Color<D::F> {
        self.normal.lerp(self.grazing, d.lit(1.0 / 21.0))
    }
}

impl<N, G> Schlick<N, G> {
    #[inline(always)]
    fn values<D: Domain>(&self, d: D, surface: &Surface<D>) -> SchlickCurve<D>
    where
        N: ColorSource<D>,
        G: ScalarSource<D>,
    {
        SchlickCurve {
            normal: self.normal.color(d, surface),
            grazing: Vec3::splat(self.grazing.scalar(d, surface)),
        }
    }
}

impl<D: Domain, N: ColorSource<D>, G: ScalarSource<D>> Fresnel<D> for Schlick<N, G> {
    #[inline(always)]
    fn reflectance(&self, d: D, surface: &Surface<D>, cos: D::F) -> Color<D::F> {
        self.values(d, surface).at(d, cos)
    }

    #[inline(always)]
    fn curve(&self, d: D, surface: &Surface<D>, _: D::F) -> SchlickCurve<D> {
        self.values(d, surface)
    }
}
