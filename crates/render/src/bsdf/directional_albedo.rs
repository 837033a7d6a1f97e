//! How much light single reflections by GGX microfacets return towards a direction.
//!
//! The integral over the directions that light comes from has no closed form. The functions here are rational fits to it,
//! made by quadrature over visible normals. They are off by less than 2e-3 of the light for all angles and for roughness
//! from 0.01 to 1, which a test holds them to by integrating the lobes themselves.

use super::fresnel::{SchlickCurve, schlick_weight};
use super::ggx::Ggx;
use crate::domain::{Domain, Real};
use crate::math::{Color, Vec3};

/// What a GGX surface returns towards a direction, by a single reflection.
#[derive(Clone, Copy, Debug)]
pub struct DirectionalAlbedo<F> {
    /// Where all facets reflect everything; the rest would be reflected more than once.
    pub white: F,
    /// Where facets reflect (1 − cos)⁵ of it.
    pub grazing: F,
}

/// The fits' coefficients: `[j][i]` belongs to xⁱ·yʲ.
type Cubic = [&'static [f64]; 4];

/// What is missing of `white`, in (√x, α), over x(1 − x), where x = cos/(cos + α).
const MISSING: [Cubic; 2] = [
    [
        &[0.156_639_97, 0.148_058_6, -0.339_294_46, 0.026_913_088],
        &[0.711_077_42, -2.040_211_65, 1.423_076_17],
        &[2.283_558_26, -1.930_087_46],
        &[-0.161_884_61],
    ],
    [
        &[1.0, -0.146_760_54, -3.051_837_93, 2.435_778_26],
        &[-0.910_018_85, 2.828_574_49, -2.130_769_86],
        &[0.212_226_86, -0.314_642_54],
        &[0.055_785_664],
    ],
];

/// The cosine that stands for those of all facets in Schlick's curve, in (x, √α), over cos + α.
const COSINE: [Cubic; 2] = [
    [
        &[7.660_716_55, -2.198_743_15, -18.341_796_1, 18.272_752_2],
        &[13.347_092_5, -4.054_229_54, -0.635_789_32],
        &[-4.773_516_78, 9.321_362_97],
        &[2.165_844_53],
    ],
    [
        &[1.0, 1.476_314_2, -1.623_401_34, 4.544_053_13],
        &[15.373_354, 12.544_101_9, -19.096_136_6],
        &[2.390_647_97, -0.886_082_73],
        &[21.360_954],
    ],
];

impl<F: Real> DirectionalAlbedo<F> {
    /// Towards a direction of this cosine with the normal.
    #[inline(always)]
    pub fn new<D: Domain<F = F>>(d: D, ggx: &Ggx<F>, cos: F) -> Self {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let cos = d.min(d.max(cos, zero), one);
        let alpha = ggx.mean_alpha(d);
        let sum = cos + alpha;
        let x = cos / sum;
        let missing = x * (alpha / sum) * quotient(d, d.sqrt(x), alpha, &MISSING);
        let white = one - d.max(missing, zero);
        let cosine = sum * quotient(d, x, d.sqrt(alpha), &COSINE);
        Self {
            white,
            grazing: white * schlick_weight(d, cosine),
        }
    }

    /// Where facets reflect what a Schlick curve says.
    #[inline(always)]
    pub fn of<D: Domain<F = F>>(&self, curve: &SchlickCurve<D>) -> Color<F> {
        let normal = self.white - self.grazing;
        curve.normal.scale(normal) + curve.grazing.scale(self.grazing)
    }

    /// How much brighter all reflections together are than the first: light that facets throw at one another loses the
    /// mean reflectance of the curve once more (Turquin 2019, "Practical multiple scattering compensation for microfacet
    /// models", with the mean in the place of the reflectance at normal incidence, as in Cycles).
    #[inline(always)]
    pub fn compensation<D: Domain<F = F>>(&self, d: D, curve: &SchlickCurve<D>) -> Color<F> {
        let one = d.lit(1.0);
        let missing = (one - self.white) / self.white;
        let mean = curve.mean(d);
        mean.scale(missing) + Vec3::splat(one)
    }
}

#[inline(always)]
fn quotient<D: Domain>(d: D, x: D::F, y: D::F, [above, below]: &[Cubic; 2]) -> D::F {
    cubic(d, x, y, above) / cubic(d, x, y, below)
}

#[inline(always)]
fn cubic<D: Domain>(d: D, x: D::F, y: D::F, rows: &Cubic) -> D::F {
    let mut sum = horner(d, x, rows[3]);
    for row in rows[..3].iter().rev() {
        sum = d.fma(sum, y, horner(d, x, row));
    }
    sum
}

#[inline(always)]
fn horner<D: Domain>(d: D, x: D::F, coefficients: &[f64]) -> D::F {
    let (last, rest) = coefficients
        .split_last()
        .expect("rows have at least one coefficient");
    let mut sum = d.lit(*last);
    for coefficient in rest.iter().rev() {
        sum = d.fma(sum, x, d.lit(*coefficient));
    }
    sum
}
