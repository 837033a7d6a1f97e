//! Indices of refraction that depend on the wavelength.

use super::ScalarSource;
use crate::domain::Domain;
use crate::math::spectrum::D_LINE;
use crate::surface::Surface;

/// The index of refraction for the wavelength of a path, by Cauchy's formula n(λ) = A + B/λ² (KHR_materials_dispersion).
#[derive(Clone, Copy, Debug)]
pub struct Dispersive<I, S> {
    /// Index of refraction at the d line, 587.56 nm.
    pub ior: I,
    /// 20 over the Abbe number.
    pub dispersion: S,
}

/// 1/λ² at the F and at the C line, in 1/nm²: the Abbe number is (n_d − 1)/(n_F − n_C).
const F_LINE: f64 = 1.0 / (486.13 * 486.13);
const C_LINE: f64 = 1.0 / (656.27 * 656.27);

impl<D: Domain, I: ScalarSource<D>, S: ScalarSource<D>> ScalarSource<D> for Dispersive<I, S> {
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        let (ior, one) = (self.ior.scalar(d, surface), d.lit(1.0));
        let inverse_abbe = self.dispersion.scalar(d, surface) * d.lit(1.0 / 20.0);
        let slope = (ior - one) * inverse_abbe * d.lit(1.0 / (F_LINE - C_LINE));
        let inverse = one / surface.wavelength;
        let ior = d.fma(
            slope,
            d.fma(inverse, inverse, d.lit(-1.0 / (D_LINE * D_LINE))),
            ior,
        );
        d.max(ior, one)
    }
}
