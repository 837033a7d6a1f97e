//! The surface of a body of a rough dielectric: frosted glass.

use fearless_simd::{Level, dispatch};

use super::albedo_table::{ALBEDO_TABLE_WORDS, albedo_table, tabulated_albedo};
use super::ggx::{Ggx, are_above, half_cosine, reflect};
use super::interface::{Interface, clear_albedo, radiance_scale, relative_ior};
use super::roughness::Roughness;
use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::{Buffers, Bundle, Domain, Lanes, Lanes8, MAX_LANES};
use crate::math::fresnel::fresnel;
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// A dielectric surface of microfacets that reflect and transmit (Walter, Marschner, Li and Torrance 2007, "Microfacet models
/// for refraction through rough surfaces"; PBRT 4, section 9.7). What facets throw at one another is added in proportion to the
/// rest: glass that absorbs nothing loses nothing (Turquin 2019, "Practical multiple scattering compensation for microfacet
/// models", section 4). The factor depends on where the light goes, so that the surface is not reciprocal.
#[derive(Clone, Copy, Debug)]
pub struct RoughDielectric<C, I, R, K> {
    /// Tint of the transmitted light.
    pub transmittance: C,
    /// Index of refraction of the inside relative to the outside, not within 1e-3 of 1.
    pub ior: I,
    /// How facets are turned.
    pub roughness: R,
    /// Whether the body may lie within others. Between two bodies nothing is added, since the table is of one in the open.
    pub interface: K,
    /// Offset in the parameter block of the [`rough_dielectric_albedos`] for about this index of refraction.
    pub albedos: u32,
}

/// What single events at facets of this index of refraction return and let through, of all light, over roughness and cosine:
/// seen from outside and from inside. What [`RoughDielectric::albedos`] stands for.
pub fn rough_dielectric_albedos(ior: f32) -> Vec<f32> {
    let eta = f64::from(ior);
    let from_a_side = |eta: f64| {
        dispatch!(Level::new(), simd => {
            let d = Lanes8::new(simd, &Buffers::EMPTY);
            albedo_table(
                #[inline(always)]
                |alpha, cos| single_events(d, eta, alpha, cos),
            )
        })
    };
    let mut tables = from_a_side(eta);
    tables.extend(from_a_side(1.0 / eta));
    tables
}

/// The integral over visible normals of what facets return and let through.
#[inline(always)]
fn single_events<D: Lanes>(d: D, eta: f64, alpha: f64, cos: f64) -> f32 {
    const ANGLES: usize = 96;
    const HEIGHTS: usize = 48;
    let facets = Facets {
        ggx: Ggx::from_roughness(d, d.lit(alpha.sqrt())),
        eta: d.lit(eta),
    };
    let wo = vec3(d.lit((1.0 - cos * cos).sqrt()), d.lit(0.0), d.lit(cos));
    let mut sum = d.lit(0.0);
    for height in 0..HEIGHTS {
        // Midpoints of an interval that is stretched at its ends, where the integrand has roots.
        let v = (height as f64 + 0.5) / HEIGHTS as f64;
        let (u, weight) = (v * v * (3.0 - 2.0 * v), 6.0 * v * (1.0 - v));
        let mut of_height = d.lit(0.0);
        for first in (0..ANGLES).step_by(D::LANES) {
            // Half of the angles: the other half mirrors it.
            let turn = |k| ((first + k) as f32 + 0.5) / (2 * ANGLES) as f32;
            let turns: [u32; MAX_LANES] = std::array::from_fn(|k| turn(k).to_bits());
            let turns = d.from_bits(d.word(&turns[..D::LANES]));
            of_height = of_height + facets.single_event(d, wo, [turns, d.lit(u)]);
        }
        sum = d.fma(of_height, d.lit(weight), sum);
    }
    let mut sums = [0; MAX_LANES];
    d.store_word(d.to_bits(sum), &mut sums[..D::LANES]);
    let total: f32 = sums[..D::LANES]
        .iter()
        .map(|&bits| f32::from_bits(bits))
        .sum();
    // Rounding may leave a little more than all.
    (total / (ANGLES * HEIGHTS) as f32).min(1.0)
}

/// Facets, seen from a side.
struct Facets<D: Domain> {
    ggx: Ggx<D::F>,
    /// Index of refraction beyond ÷ here.
    eta: D::F,
}

/// A facet whose normal was drawn, and where light that goes to `wo` may come from.
struct Event<D: Domain> {
    normal: Vec3<D::F>,
    reflectance: D::F,
    reflected: Vec3<D::F>,
    transmitted: Vec3<D::F>,
}

impl<D: Domain> Event<D> {
    /// Whether a number has the facet reflect, and where light then comes from.
    #[inline(always)]
    fn outcome(&self, d: D, u: D::F) -> (D::M, Vec3<D::F>) {
        let is_mirrored = d.lt(u, self.reflectance);
        let wi = Vec3::choose(d, is_mirrored, self.reflected, self.transmitted);
        (is_mirrored, wi)
    }
}

impl<D: Domain> Facets<D> {
    /// What facets transmit, over the density of their normals and all that depends on the tint; and the same over masking, as
    /// a density: the second number needs no masking of `wi`. `h` is the facet's normal.
    #[inline(always)]
    fn transmission(&self, d: D, wo: Vec3<D::F>, wi: Vec3<D::F>, h: Vec3<D::F>) -> (D::F, D::F) {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let (co, ci) = (wo.dot(d, h), wi.dot(d, h));
        let possible = d.lt(zero, co) & d.lt(ci, zero) & d.lt(wi.z, zero);
        let root = ci + co / self.eta;
        let measure = d.max(root * root, d.lit(1e-20));
        let common = self.ggx.distribution(d, h) * co * -ci / (measure * d.max(wo.z, d.lit(1e-9)));
        let (reflectance, _) = fresnel(d, d.max(co, zero), self.eta);
        let common = d.select(possible, common * (one - reflectance), zero);
        let out = one + self.ggx.lambda(d, wo);
        (common / (out + self.ggx.lambda(d, wi)), common / out)
    }

    /// A facet that is visible from `wo`, by two random numbers.
    #[inline(always)]
    fn event(&self, d: D, wo: Vec3<D::F>, u: [D::F; 2]) -> Event<D> {
        let h = self.ggx.sample_visible_normal(d, wo, u);
        let co = d.max(wo.dot(d, h), d.lit(0.0));
        let (reflectance, g) = fresnel(d, co, self.eta);
        let inverse = d.lit(1.0) / self.eta;
        Event {
            normal: h,
            reflectance,
            reflected: reflect(d, wo, h),
            transmitted: h.scale((co - g) * inverse) - wo.scale(inverse),
        }
    }

    /// G₂/G₁: how much of what a drawn facet transmits is not masked.
    #[inline(always)]
    fn passed(&self, d: D, wo: Vec3<D::F>, wi: Vec3<D::F>) -> D::F {
        self.ggx.sample_weight(d, wo, vec3(wi.x, wi.y, -wi.z))
    }

    /// What a facet that is visible from `wo` returns and lets through, of all light.
    #[inline(always)]
    fn single_event(&self, d: D, wo: Vec3<D::F>, u: [D::F; 2]) -> D::F {
        let event = self.event(d, wo, u);
        let returned = self.ggx.sample_weight(d, wo, event.reflected);
        let passed = self.passed(d, wo, event.transmitted);
        d.fma(event.reflectance, returned - passed, passed)
    }
}

impl<C, I, R, K: Interface> RoughDielectric<C, I, R, K> {
    #[inline(always)]
    fn facets<D: Domain>(&self, d: D, surface: &Surface<D>) -> Facets<D>
    where
        I: ScalarSource<D>,
        R: Roughness<D>,
    {
        Facets {
            ggx: self.roughness.microfacets(d, surface),
            eta: relative_ior(d, surface, &self.interface, self.ior.scalar(d, surface)),
        }
    }

    /// How much brighter all events together are than the first.
    #[inline(always)]
    fn all<D: Domain>(&self, d: D, surface: &Surface<D>, ggx: &Ggx<D::F>, cos: D::F) -> D::F {
        let (entering, leaving) = (self.albedos, self.albedos + ALBEDO_TABLE_WORDS);
        let table = d.select_u(surface.front, d.uint(entering), d.uint(leaving));
        let first = tabulated_albedo(d, surface.params + table, ggx, cos);
        let one = d.lit(1.0);
        let all = one / d.max(first, d.lit(1e-3));
        match self.interface.may_be_within() {
            true => d.select(d.eq(surface.around, one), all, one),
            false => all,
        }
    }
}

impl<D, C, I, R, K> Bsdf<D> for RoughDielectric<C, I, R, K>
where
    D: Domain,
    C: ColorSource<D>,
    I: ScalarSource<D>,
    R: Roughness<D>,
    K: Interface,
{
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let facets = self.facets(d, surface);
        let all = self.all(d, surface, &facets.ggx, wo.z);
        let below = d.lt(wi.z, d.lit(0.0));
        let mirrored = vec3(wi.x, wi.y, d.abs(wi.z));
        let sum = wo + mirrored;
        let half = sum.normalize_any(d);
        let (value, pdf) = facets.ggx.reflection(d, wo, mirrored, half);
        let (reflectance, _) = fresnel(d, half_cosine(d, sum, half), facets.eta);
        let h = (wo + wi.scale(facets.eta)).normalize_any(d);
        let h = h.scale(d.copysign(d.lit(1.0), h.z));
        let (through, through_pdf) = facets.transmission(d, wo, wi, h);
        let through = through / (facets.eta * facets.eta);
        let tint = self.transmittance.color(d, surface);
        let returned = Vec3::splat(value * reflectance);
        BsdfValue {
            value: Vec3::choose(d, below, tint.scale(through), returned).scale(all),
            pdf: d.select(below, through_pdf, pdf * reflectance),
        }
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let event = self.facets(d, surface).event(d, wo, [u[0], u[1]]);
        let (is_mirrored, wi) = event.outcome(d, u[2]);
        let above = are_above(d, wo, event.reflected);
        let below = d.lt(event.transmitted.z, d.lit(0.0));
        BsdfProposal::of_lobe(d, wi, d.select_mask(is_mirrored, above, below))
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let facets = self.facets(d, surface);
        let all = self.all(d, surface, &facets.ggx, wo.z);
        let event = facets.event(d, wo, [u[0], u[1]]);
        let (is_mirrored, wi) = event.outcome(d, u[2]);
        let (_, pdf) = facets.ggx.reflection(d, wo, event.reflected, event.normal);
        let returned = facets.ggx.sample_weight(d, wo, event.reflected);
        let (_, through_pdf) = facets.transmission(d, wo, event.transmitted, event.normal);
        let passed = facets.passed(d, wo, event.transmitted);
        let possible = d.lt(d.lit(0.0), through_pdf);
        // Radiance is squeezed into a cone narrower by η² (Veach 1997, section 5.2).
        let passed = d.select(possible, passed, d.lit(0.0)) / (facets.eta * facets.eta);
        let tint = self.transmittance.color(d, surface).scale(passed);
        BsdfSample {
            wi,
            weight: Vec3::choose(d, is_mirrored, Vec3::splat(returned), tint).scale(all),
            pdf: d.select(is_mirrored, pdf * event.reflectance, through_pdf),
            delta: d.truth(false),
        }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let ior = self.ior.scalar(d, surface);
        let tint = self.transmittance.color(d, surface);
        clear_albedo(
            d,
            wo.z,
            relative_ior(d, surface, &self.interface, ior),
            tint,
        )
    }

    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        let ior = self.ior.scalar(d, surface);
        radiance_scale(d, surface, &self.interface, ior, wi.z)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        BsdfKind {
            scatters: true,
            delta: false,
        }
    }
}
