//! Diffuse reflection by rough surfaces: clay, sand, the moon.

use super::azimuth::Azimuth;
use super::{Bsdf, BsdfKind, BsdfProposal, BsdfValue};
use crate::domain::{Bundle, Domain};
use crate::math::elementary::{pow, sincos_turns};
use crate::math::vec3::vec3;
use crate::math::warp::{FRAC_1_PI, disc};
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// Facets that are Lambertian each, with what they throw at one another: the energy-preserving Oren–Nayar model, and the
/// sampling of it by a clipped, linearly transformed cosine lobe (Portsmouth, Kutz and Hill 2025, "EON: A practical
/// energy-preserving rough diffuse BRDF", JCGT 14(1)). A roughness of 0 is Lambert's reflection.
#[derive(Clone, Copy, Debug)]
pub struct RoughDiffuse<C, R> {
    /// Albedo of a facet, in [0, 1].
    pub albedo: C,
    /// Roughness, in [0, 1].
    pub roughness: R,
}

/// By how much a facet's mean reflection falls with roughness: 1/2 − 2/(3π).
const FALL: f64 = 0.5 - 2.0 * FRAC_1_PI / 3.0;
/// By how much the mean of the albedos of all directions rises again: 2/3 − 28/(15π).
const RISE: f64 = 2.0 / 3.0 - 28.0 * FRAC_1_PI / 15.0;
/// The paper's fit to how the albedo grows towards grazing angles: the coefficients of the powers of 1 − cosine from 1 on.
const GRAZING: [f64; 4] = [
    0.057_108_528_9,
    0.491_881_867,
    -0.332_181_442,
    0.071_442_995_3,
];

/// The surface at a point.
struct Facets<D: Domain> {
    roughness: D::F,
    /// The Oren–Nayar model's A.
    scale: D::F,
}

impl<D: Domain> Facets<D> {
    #[inline(always)]
    fn new(d: D, roughness: D::F) -> Self {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let roughness = d.min(d.max(roughness, zero), one);
        let scale = one / d.fma(roughness, d.lit(FALL), one);
        Self { roughness, scale }
    }

    /// What single reflections return of white facets, towards a direction of this cosine.
    #[inline(always)]
    fn single(&self, d: D, cos: D::F) -> D::F {
        let m = d.lit(1.0) - d.min(d.max(cos, d.lit(0.0)), d.lit(1.0));
        let [a, b, c, e] = GRAZING.map(|coefficient| d.lit(coefficient));
        let rise = m * d.fma(d.fma(d.fma(e, m, c), m, b), m, a);
        d.min(
            self.scale * d.fma(self.roughness, rise, d.lit(1.0)),
            d.lit(1.0),
        )
    }

    /// The mean of [`single`](Self::single) over all directions, weighed by their cosines.
    #[inline(always)]
    fn mean(&self, d: D) -> D::F {
        self.scale * d.fma(self.roughness, d.lit(RISE), d.lit(1.0))
    }

    /// What is reflected more than once, of what single reflections of white facets lose.
    #[inline(always)]
    fn more(&self, d: D, albedo: Color<D::F>) -> Color<D::F> {
        let mean = self.mean(d);
        let lost = d.lit(1.0) - mean;
        albedo.map(|rho| rho * rho * mean / (d.lit(1.0) - rho * lost))
    }

    /// π times the reflectance.
    #[inline(always)]
    fn reflectance(
        &self,
        d: D,
        wo: Vec3<D::F>,
        wi: Vec3<D::F>,
        albedo: Color<D::F>,
    ) -> Color<D::F> {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let s = d.fma(wo.x, wi.x, wo.y * wi.y);
        let larger = d.max(d.max(wo.z, wi.z), d.lit(1e-9));
        let s = d.select(d.lt(zero, s), s / larger, s);
        let single = self.scale * d.max(d.fma(self.roughness, s, one), zero);
        let lost = one - self.mean(d);
        let both = (one - self.single(d, wo.z)) * (one - self.single(d, wi.z));
        let more = both / d.max(lost, d.lit(1e-7));
        albedo.scale(single) + self.more(d, albedo).scale(more)
    }
}

/// The lobe that directions are drawn from, seen from a direction: mostly a cosine lobe that is transformed linearly and of
/// which only what ends above the surface is drawn, and now and then all directions alike.
struct ClippedLobe<D: Domain> {
    azimuth: Azimuth<D::F>,
    /// The transformation x' = a·x + b·z, y' = c·y, z' = d·x + z.
    matrix: [D::F; 4],
    /// Its determinant.
    determinant: D::F,
    /// The part of the disc under the lobe that is drawn.
    part: D::F,
    /// Probability of drawing from all directions alike.
    uniform: D::F,
}

impl<D: Domain> ClippedLobe<D> {
    #[inline(always)]
    fn new(d: D, wo: Vec3<D::F>, r: D::F) -> Self {
        let lit = |value| d.lit(value);
        let (zero, one) = (lit(0.0), lit(1.0));
        let x = d.min(d.max(wo.z, zero), one);
        let poly = |coefficients: &[f64]| {
            let (last, rest) = coefficients.split_last().expect("some coefficients");
            let step = |sum, coefficient: &f64| d.fma(sum, x, lit(*coefficient));
            rest.iter().rev().fold(lit(*last), step)
        };
        // The paper's fits, in the cosine and the roughness.
        let of_square = poly(&[-0.276_266, 0.335_918]);
        let a = d.fma(of_square, r, poly(&[0.303_392, -0.518_982, 0.111_709]));
        let a = d.fma(a, r, one);
        let b = d.fma(
            poly(&[0.150_815, -0.150_105]),
            r,
            poly(&[-1.164_07, 1.158_59]),
        );
        let b = b * r / poly(&[-1.435_45, 0.0, 0.0, 1.0]);
        let c = d.fma(poly(&[0.200_13, -0.506_373, 0.261_777]), r, one);
        let e = poly(&[0.540_852, -1.016_25, 0.475_392]) * r;
        let e = e / poly(&[-1.0743, 0.072_562_8, 1.0]);
        let uniform = poly(&[0.162_925, -0.372_058, 0.538_233, -0.290_822]);
        let half = lit(0.5);
        Self {
            azimuth: Azimuth::of(d, wo),
            matrix: [a, b, c, e],
            determinant: c * (a - b * e),
            part: half + half / d.sqrt(d.fma(e, e, one)),
            uniform: pow(d, r, lit(0.1)) * d.max(uniform, zero),
        }
    }

    /// Density per steradian.
    #[inline(always)]
    fn density(&self, d: D, wi: Vec3<D::F>) -> D::F {
        let zero = d.lit(0.0);
        let [a, b, c, e] = self.matrix;
        let w = self.azimuth.turned(d, wi);
        // The inverse of the transformation, times the determinant.
        let original = vec3(
            c * (w.x - b * w.z),
            (a - b * e) * w.y,
            c * d.fma(a, w.z, -(e * w.x)),
        );
        let ratio = self.determinant / d.max(original.dot(d, original), d.lit(1e-20));
        let lobe = ratio * ratio * d.max(original.z, zero) * d.lit(FRAC_1_PI) / self.part;
        let flat = d.lit(0.5 * FRAC_1_PI);
        let density = d.fma(self.uniform, flat - lobe, lobe);
        d.select(d.lt(zero, wi.z), density, zero)
    }

    #[inline(always)]
    fn sample(&self, d: D, u: [D::F; 3]) -> Vec3<D::F> {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let [a, b, c, e] = self.matrix;
        let [x, y] = disc(d, [u[0], u[1]]);
        // Points of the disc, squeezed into what is drawn of it.
        let edge = d.sqrt(d.max(one - y * y, zero));
        let x = -d.fma(self.part, x - edge, edge);
        let z = d.sqrt(d.max(one - d.fma(x, x, y * y), zero));
        let lobe = vec3(d.fma(a, x, b * z), c * y, d.fma(e, x, z));
        let lobe = self.azimuth.turned_back(d, lobe).normalize_any(d);
        let (sin, cos) = sincos_turns(d, u[1]);
        let r = d.sqrt(d.max(one - u[0] * u[0], zero));
        let flat = vec3(r * cos, r * sin, u[0]);
        Vec3::choose(d, d.lt(u[2], self.uniform), flat, lobe)
    }
}

impl<D: Domain, C: ColorSource<D>, R: ScalarSource<D>> Bsdf<D> for RoughDiffuse<C, R> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let facets = Facets::new(d, self.roughness.scalar(d, surface));
        let albedo = self.albedo.color(d, surface);
        let cos = d.max(wi.z, d.lit(0.0)) * d.lit(FRAC_1_PI);
        BsdfValue {
            value: facets.reflectance(d, wo, wi, albedo).scale(cos),
            pdf: ClippedLobe::new(d, wo, facets.roughness).density(d, wi),
        }
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let facets = Facets::new(d, self.roughness.scalar(d, surface));
        let wi = ClippedLobe::new(d, wo, facets.roughness).sample(d, u);
        BsdfProposal::of_lobe(d, wi, d.lt(d.lit(0.0), wi.z))
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let facets = Facets::new(d, self.roughness.scalar(d, surface));
        let albedo = self.albedo.color(d, surface);
        let single = facets.single(d, wo.z);
        albedo.scale(single) + facets.more(d, albedo).scale(d.lit(1.0) - single)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
