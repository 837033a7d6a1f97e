//! How much a smooth interface reflects: the Fresnel equations of dielectrics, and Schlick's approximation with a colour.

use crate::domain::Domain;
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

/// (1 − cos)⁵, Schlick's weight.
#[inline(always)]
pub fn schlick_weight<D: Domain>(d: D, cos: D::F) -> D::F {
    let m = d.max(d.lit(1.0) - cos, d.lit(0.0));
    let m2 = m * m;
    m2 * m2 * m
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

/// Fresnel reflectance of unpolarised light and the quantity √(η² − 1 + cos²), η times the cosine of the
/// refracted ray; `cos` ≥ 0, `eta` = index beyond ÷ index here. On total reflection (1, 0).
///
/// Written without cancellation near η = 1 (hard case M-06).
#[inline(always)]
pub fn fresnel<D: Domain>(d: D, cos: D::F, eta: D::F) -> (D::F, D::F) {
    let one = d.lit(1.0);
    let q = (eta - one) * (eta + one);
    let c2 = cos * cos;
    let g2 = q + c2;
    let total = d.le(g2, d.lit(0.0));
    let g = d.sqrt(d.max(g2, d.lit(0.0)));
    let eta2 = eta * eta;
    let perpendicular = cos + g;
    let parallel = d.fma(eta2, cos, g);
    let rs = q / (perpendicular * perpendicular);
    let rp = q * d.fma(eta2 + one, c2, -one) / (parallel * parallel);
    let reflectance = d.lit(0.5) * d.fma(rs, rs, rp * rp);
    (
        d.select(total, one, d.min(reflectance, one)),
        d.select(total, d.lit(0.0), g),
    )
}
