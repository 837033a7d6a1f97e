//! Sheen of cloth: light that fibres scatter towards grazing angles.

use super::azimuth::Azimuth;
use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::elementary::exp2;
use crate::math::vec3::vec3;
use crate::math::warp::{FRAC_1_PI, cosine_hemisphere};
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// The sheen of a layer of fibres, with all orders of scattering (Zeltner, Burley and Chiang 2022, "Practical
/// multiple-scattering sheen using linearly transformed cosines"), by the rational fits that MaterialX has of the paper's
/// tables. It stands for KHR_materials_sheen, whose own lobe (Estevez and Kulla 2017) returns more light at grazing angles
/// than arrives, up to four times as much; other offline renderers (Cycles, OpenPBR) do likewise.
#[derive(Clone, Copy, Debug)]
pub struct Sheen<C, R> {
    /// Colour of the fibres, in [0, 1].
    pub color: C,
    /// Roughness, in [0, 1].
    pub roughness: R,
}

/// Below this roughness there is hardly any sheen, and the fits end.
const LEAST_ROUGHNESS: f64 = 0.01;

/// A cosine lobe, transformed linearly, towards the side of `wo`.
#[derive(Clone, Copy)]
struct Lobe<D: Domain> {
    /// The share of light that returns.
    albedo: D::F,
    /// The inverse of the transformation: x' = a·x + b·z, y' = a·y, z' = z, where `wo` has no y.
    a: D::F,
    b: D::F,
    azimuth: Azimuth<D::F>,
}

impl<D: Domain> Lobe<D> {
    #[inline(always)]
    fn new(d: D, wo: Vec3<D::F>, roughness: D::F) -> Self {
        let lit = |value| d.lit(value);
        let one = lit(1.0);
        let x = d.min(d.max(wo.z, lit(0.0)), one);
        let y = d.min(d.max(roughness, lit(LEAST_ROUGHNESS)), one);
        // A Gaussian over an offset.
        let width = y * d.fma(lit(1.584_91), y, lit(0.020_660_7))
            / d.fma(y, y + lit(1.322_27), lit(0.037_942_4));
        let mean = d.fma(y * y, lit(-0.959_43), lit(1.7932));
        let mean = d.fma(mean, y, lit(-1.148_85));
        let mean = y * d.fma(mean, y, lit(-0.193_854)) / (y + lit(0.046_391));
        let offset = d.fma(
            d.fma(lit(0.119_681), y, lit(-0.020_781_8)),
            y,
            lit(6.540_23e-4),
        );
        let offset = y * offset / d.fma(y, y - lit(1.920_21), lit(1.262_64));
        let deviation = (x - mean) / width;
        // exp(−½t²) as a power of 2.
        let bell = exp2(
            d,
            deviation * deviation * lit(-0.5 * std::f64::consts::LOG2_E),
        );
        let root = lit(1.0 / (2.0 * std::f64::consts::PI).sqrt());
        let albedo = d.fma(bell, root / width, offset);

        let xy = x * y;
        let a = d.fma(lit(2.581_26), x, lit(0.813_703) * y) * y
            / d.fma(lit(0.310_327) * x, x, d.fma(lit(2.609_94), xy, one));
        let b = d.fma(lit(1.712_28), x, lit(2.540_53e-5));
        let b = d.fma(lit(1.341_74) * y, y, d.fma(lit(-1.715_06), xy, b));
        let b = d.sqrt(one - x) * (y - one) * y * y * y / b;

        Self {
            albedo: d.min(d.max(albedo, lit(0.0)), one),
            a,
            b,
            azimuth: Azimuth::of(d, wo),
        }
    }

    /// Density per steradian, cosine included; its integral over the directions above is 1.
    #[inline(always)]
    fn density(&self, d: D, wi: Vec3<D::F>) -> D::F {
        let seen = self.azimuth.turned(d, wi);
        let original = vec3(d.fma(self.a, seen.x, self.b * wi.z), self.a * seen.y, wi.z);
        let ratio = self.a / original.dot(d, original);
        d.max(wi.z, d.lit(0.0)) * d.lit(FRAC_1_PI) * ratio * ratio
    }

    #[inline(always)]
    fn sample(&self, d: D, u: [D::F; 2]) -> Vec3<D::F> {
        let w = cosine_hemisphere(d, u);
        let along = d.fma(-w.z, self.b, w.x) / self.a;
        let local = vec3(along, w.y / self.a, w.z);
        self.azimuth.turned_back(d, local).normalize_any(d)
    }
}

impl<C, R> Sheen<C, R> {
    #[inline(always)]
    fn lobe<D: Domain>(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Lobe<D>
    where
        R: ScalarSource<D>,
    {
        Lobe::new(d, wo, self.roughness.scalar(d, surface))
    }
}

impl<D: Domain, C: ColorSource<D>, R: ScalarSource<D>> Bsdf<D> for Sheen<C, R> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let lobe = self.lobe(d, surface, wo);
        let pdf = lobe.density(d, wi);
        BsdfValue {
            value: self.color.color(d, surface).scale(lobe.albedo * pdf),
            pdf,
        }
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let wi = self.lobe(d, surface, wo).sample(d, [u[0], u[1]]);
        BsdfProposal::of_lobe(d, wi, d.lt(d.lit(0.0), wi.z))
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let lobe = self.lobe(d, surface, wo);
        let wi = lobe.sample(d, [u[0], u[1]]);
        BsdfSample {
            wi,
            weight: self.color.color(d, surface).scale(lobe.albedo),
            pdf: lobe.density(d, wi),
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let lobe = self.lobe(d, surface, wo);
        self.color.color(d, surface).scale(lobe.albedo)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
