//! What a coat lets through of the light that the surface under it emits.

use super::{ColorSource, ScalarSource};
use crate::domain::Domain;
use crate::math::Color;
use crate::math::fresnel::schlick;
use crate::surface::Surface;

/// A colour, times 1 − the Fresnel reflectance of the coat over it towards where the light goes, by Schlick's approximation
/// (KHR_materials_clearcoat, "Emission"). The angle is that to the triangle, not to the shading normal: light samples know no other,
/// and what they say of a lamp has to be what is seen of it.
#[derive(Clone, Copy, Debug)]
pub struct UnderCoat<C, N, G> {
    /// The colour under the coat.
    pub color: C,
    /// The coat's reflectance at normal incidence.
    pub normal: N,
    /// The coat's reflectance at grazing incidence.
    pub grazing: G,
}

impl<D, C, N, G> ColorSource<D> for UnderCoat<C, N, G>
where
    D: Domain,
    C: ColorSource<D>,
    N: ScalarSource<D>,
    G: ScalarSource<D>,
{
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        let normal = self.normal.scalar(d, surface);
        let grazing = self.grazing.scalar(d, surface);
        let reflected = schlick(d, normal, grazing, surface.cos_geometric);
        self.color.color(d, surface).scale(d.lit(1.0) - reflected)
    }
}
