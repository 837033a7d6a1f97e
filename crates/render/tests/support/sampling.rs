//! Sampling of BSDFs against their densities: χ² in slopes of the normals of facets, so that every lobe is resolved (hard case
//! M-02), weights against value ÷ density (M-03), and the mass of the density.

use residual_render::bsdf::Bsdf;
use residual_render::domain::{Buffers, Domain, Precise, Scalar};
use residual_render::math::Vec3;
use residual_render::math::vec3::vec3;
use residual_render::scene_data::SceneData;
use residual_render::surface::Surface;

use super::random::Rng;
use super::scenes::{floor, surface_at};
use super::stats::{Family, chi_squared};
use super::{Worst, array, dot, unit};

/// Cells in the logarithm of the slope, and around.
const RINGS: usize = 40;
const SECTORS: usize = 16;
/// Midpoints of the quadrature along each side of a cell.
const STEPS: usize = 12;
/// The same, in cells where the density ends.
const EDGE_STEPS: usize = 32;
const SAMPLES: usize = 60_000;
const TAU: f64 = std::f64::consts::TAU;

fn vector([x, y, z]: [f64; 3]) -> Vec3<f64> {
    vec3(x, y, z)
}

/// What facets do with light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event {
    /// They reflect it.
    Reflection,
    /// They refract it into an index of refraction that is this many times that of this side.
    Refraction(f64),
    /// They let it through in the direction that mirrors the reflected one.
    Passage,
}

impl Event {
    /// The normal of the facet that has light come from `wi` and go to `wo`.
    fn normal(self, wo: [f64; 3], wi: [f64; 3]) -> [f64; 3] {
        let sum = |factor: [f64; 3]| unit([0, 1, 2].map(|k| wo[k] + factor[k] * wi[k]));
        match self {
            Self::Reflection => sum([1.0; 3]),
            Self::Refraction(eta) => {
                let h = sum([eta; 3]);
                h.map(|c| if h[2] < 0.0 { -c } else { c })
            }
            Self::Passage => sum([1.0, 1.0, -1.0]),
        }
    }

    /// Where light comes from that a facet sends to `wo`, and the solid angle per solid angle of normals.
    fn direction(self, wo: [f64; 3], h: [f64; 3]) -> Option<([f64; 3], f64)> {
        let co = dot(wo, h);
        if co <= 0.0 {
            return None;
        }
        let reflected = [0, 1, 2].map(|k| 2.0 * co * h[k] - wo[k]);
        match self {
            Self::Reflection => Some((reflected, 4.0 * co)),
            Self::Refraction(eta) => {
                let square = eta * eta - 1.0 + co * co;
                if square <= 0.0 {
                    return None;
                }
                let g = square.sqrt();
                let wi = [0, 1, 2].map(|k| ((co - g) * h[k] - wo[k]) / eta);
                Some((wi, (co - g).powi(2) / (eta * g)))
            }
            Self::Passage => {
                let [x, y, z] = reflected;
                Some(([x, y, -z], 4.0 * co))
            }
        }
    }
}

/// Coordinates of directions: the slope of the normal of facets that send light from there, in units of `scale`, logarithmic,
/// and its angle.
struct Chart {
    wo: [f64; 3],
    event: Event,
    scale: f64,
    range: f64,
}

impl Chart {
    fn new(wo: [f64; 3], event: Event, scale: f64) -> Self {
        // No half vector has a cosine below half that of `wo`. Facets that refract have, seldom: they are off the chart.
        Self {
            wo,
            event,
            scale,
            range: (4.0 / (wo[2] * scale).powi(2)).ln_1p(),
        }
    }

    /// The cell of a direction, if it is on the chart.
    fn cell(&self, wi: [f64; 3]) -> Option<usize> {
        let h = self.event.normal(self.wo, wi);
        let slope2 = (h[0] * h[0] + h[1] * h[1]) / (h[2] * h[2] * self.scale * self.scale);
        let ring = slope2.ln_1p() / self.range * RINGS as f64;
        let sector = (h[1].atan2(h[0]) / TAU).rem_euclid(1.0) * SECTORS as f64;
        let sector = (sector as usize).min(SECTORS - 1);
        (ring < RINGS as f64).then_some(ring as usize * SECTORS + sector)
    }

    /// The direction of a place in the unit square, and the solid angle per area of the square.
    fn direction(&self, ring: f64, sector: f64) -> Option<([f64; 3], f64)> {
        let slope2 = (ring * self.range).exp_m1();
        let slope = slope2.sqrt() * self.scale;
        let (sin, cos) = (sector * TAU).sin_cos();
        let h = unit([slope * cos, slope * sin, 1.0]);
        let slopes = 0.5 * self.scale * self.scale * self.range * (slope2 + 1.0) * TAU;
        let (wi, measure) = self.event.direction(self.wo, h)?;
        // Directions of another side are on another chart.
        let is_above = self.event == Event::Reflection;
        let is_here = (wi[2] > 0.0) == is_above;
        is_here.then_some((wi, slopes * h[2].powi(3) * measure))
    }

    /// What the density holds in a cell, by midpoints, and at how many of them it is not 0.
    fn mass(&self, cell: usize, steps: usize, pdf: &impl Fn([f64; 3]) -> f64) -> (f64, usize) {
        let corner = [
            (cell / SECTORS) as f64 / RINGS as f64,
            (cell % SECTORS) as f64 / SECTORS as f64,
        ];
        let side = |k: usize| (k as f64 + 0.5) / steps as f64;
        let (mut sum, mut full) = (0.0, 0);
        for k in 0..steps * steps {
            let ring = corner[0] + side(k / steps) / RINGS as f64;
            let sector = corner[1] + side(k % steps) / SECTORS as f64;
            let direction = self.direction(ring, sector);
            let density = direction.map_or(0.0, |(wi, measure)| pdf(wi) * measure);
            sum += density;
            full += usize::from(density > 0.0);
        }
        (sum / (RINGS * SECTORS * steps * steps) as f64, full)
    }

    /// What the density holds in each cell; in finer steps where it ends in the cell or may do so.
    fn masses(&self, pdf: impl Fn([f64; 3]) -> f64) -> Vec<f64> {
        let coarse: Vec<_> = (0..RINGS * SECTORS)
            .map(|cell| self.mass(cell, STEPS, &pdf))
            .collect();
        let at =
            |ring: usize, sector: usize| coarse[ring.min(RINGS - 1) * SECTORS + sector % SECTORS].1;
        let uniform = |cell: usize| {
            let (ring, sector) = (cell / SECTORS, cell % SECTORS);
            let around = [
                at(ring.saturating_sub(1), sector),
                at(ring + 1, sector),
                at(ring, sector + 1),
            ];
            let all = [
                around[0],
                around[1],
                around[2],
                at(ring, sector + SECTORS - 1),
                coarse[cell].1,
            ];
            all == [STEPS * STEPS; 5] || all == [0; 5]
        };
        (0..coarse.len())
            .map(|cell| {
                if uniform(cell) {
                    coarse[cell].0
                } else {
                    self.mass(cell, EDGE_STEPS, &pdf).0
                }
            })
            .collect()
    }
}

/// A BSDF in two domains.
pub(crate) struct Case<'a, B> {
    pub(crate) name: String,
    pub(crate) bsdf: B,
    /// Width of its narrowest lobe, in slopes of the half vector.
    pub(crate) scale: f64,
    /// A scene with a floor.
    pub(crate) data: &'a SceneData,
    /// From where the floor is seen.
    pub(crate) side: Side,
    /// How light gets through it, if it does.
    pub(crate) through: Option<Event>,
}

/// A side of the floor.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Side {
    Front,
    Back,
}

impl Side {
    pub(crate) fn surface<D: Domain>(self, d: D) -> Surface<D> {
        match self {
            Self::Front => floor(d),
            Self::Back => surface_at(d, 0, [1.0 / 3.0, 1.0 / 3.0], [0.0, 0.0, 1.0]),
        }
    }
}

impl<'a, B> Case<'a, B> {
    /// An opaque floor, seen from its front.
    pub(crate) fn new(name: impl Into<String>, bsdf: B, scale: f64, data: &'a SceneData) -> Self {
        Self {
            name: name.into(),
            bsdf,
            scale,
            data,
            side: Side::Front,
            through: None,
        }
    }
}

/// What samples are computed in. Directions in 32 bits say nothing of lobes that are narrower than their last digits, which
/// grazing directions of the smoothest surfaces have.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Digits {
    Single,
    Double,
}

/// A sample as numbers.
#[derive(Debug)]
struct Drawn {
    wi: [f64; 3],
    weight: [f64; 3],
    pdf: f64,
    /// The density that evaluation gives.
    evaluated: f64,
}

/// Draws a sample; both domains are asked in the same way.
macro_rules! drawn {
    ($self:ident, $d:expr, $wo:expr, $u:expr, $number:ty) => {{
        let surface = $self.side.surface($d);
        let wo = vec3($wo[0] as $number, $wo[1] as $number, $wo[2] as $number);
        let sample = $self.bsdf.sample($d, &surface, wo, $u.map(<$number>::from));
        let evaluated = $self.bsdf.eval($d, &surface, wo, sample.wi).pdf;
        Drawn {
            wi: array(sample.wi).map(f64::from),
            weight: array(sample.weight).map(f64::from),
            pdf: f64::from(sample.pdf),
            evaluated: f64::from(evaluated),
        }
    }};
}

impl<B: for<'b> Bsdf<Scalar<'b>> + for<'b> Bsdf<Precise<'b>>> Case<'_, B> {
    fn draw(&self, digits: Digits, buffers: &Buffers<'_>, wo: [f64; 3], u: [f32; 3]) -> Drawn {
        match digits {
            Digits::Single => drawn!(self, Scalar::new(buffers), wo, u, f32),
            Digits::Double => drawn!(self, Precise::new(buffers), wo, u, f64),
        }
    }

    /// Value and density of pairs of directions, in 64 bits.
    fn exact<'b>(&self, d: Precise<'b>) -> impl Fn([f64; 3], [f64; 3]) -> ([f64; 3], f64) {
        let surface = self.side.surface(d);
        move |wo, wi| {
            let value = self.bsdf.eval(d, &surface, vector(wo), vector(wi));
            (array(value.value), value.pdf)
        }
    }

    /// p-value of the sampled directions, `bias` being a perturbation of the density for the test of the test.
    pub(crate) fn run(
        &self,
        (cos, digits): (f64, Digits),
        seed: u64,
        bias: f64,
        weights: &mut Worst,
        pdfs: &mut Worst,
    ) -> f64 {
        let buffers = self.data.buffers();
        let sin = (1.0 - cos * cos).sqrt();
        let wo = [sin * 0.8, -sin * 0.6, cos];
        let wo = match digits {
            Digits::Single => wo.map(|c| f64::from(c as f32)),
            Digits::Double => wo,
        };
        let exact = unit(wo);
        let chart = |event| Chart::new(exact, event, self.scale);
        let above = chart(Event::Reflection);
        let below = self.through.map(chart);
        let evaluated = self.exact(Precise::new(&buffers));
        let mut masses = above.masses(|wi| evaluated(exact, wi).1);
        if let Some(below) = &below {
            masses.extend(below.masses(|wi| evaluated(exact, wi).1));
        }
        let failures = masses.len();
        let total: f64 = masses.iter().sum();
        assert!(
            total < 1.0 + 2e-3,
            "{} cos {cos}: density integrates to {total}",
            self.name
        );
        for mass in masses.iter_mut().step_by(2) {
            *mass *= 1.0 + bias;
        }
        // Failures, and what is off the chart.
        masses.push((1.0 - total).max(0.0));
        let mut counts = vec![0.0; masses.len()];
        let mut rng = Rng::new(seed);
        for _ in 0..SAMPLES {
            let u = rng.unit3();
            let sample = self.draw(digits, &buffers, wo, u);
            let place = || format!("{} cos {cos}, {u:?}: {sample:?}", self.name);
            assert!(
                sample
                    .wi
                    .iter()
                    .chain(&sample.weight)
                    .all(|c| c.is_finite()),
                "{}",
                place()
            );
            if sample.pdf <= 0.0 {
                assert_eq!(sample.weight, [0.0; 3], "{}", place());
                counts[failures] += 1.0;
                continue;
            }
            let wi = sample.wi;
            let cell = match &below {
                Some(below) if wi[2] < 0.0 => below.cell(wi).map(|cell| RINGS * SECTORS + cell),
                _ => above.cell(wi),
            };
            counts[cell.unwrap_or(failures)] += 1.0;
            let length2 = dot(wi, wi);
            assert!((length2 - 1.0).abs() < 2e-6, "{}", place());
            let (value, pdf) = evaluated(wo, wi);
            pdfs.add((sample.evaluated / sample.pdf - 1.0).abs(), place);
            if wi[2].abs() > 1e-3 {
                for (weight, value) in sample.weight.into_iter().zip(value) {
                    weights.add((weight - value / pdf).abs() / (value / pdf).max(0.1), place);
                }
            }
        }
        let sum: f64 = masses.iter().sum();
        // Never exactly 0: where the quadrature misses the rim of the density, samples are pooled, not forbidden.
        let expected: Vec<f64> = masses
            .iter()
            .map(|mass| (mass / sum * SAMPLES as f64).max(1e-3))
            .collect();
        chi_squared(&counts, &expected)
    }

    /// All views; the bounds are on weights and densities that two ways of computing them give.
    pub(crate) fn check(&self, family: &mut Family, weight_bound: f64, pdf_bound: f64) {
        let (mut weights, mut pdfs) = (Worst::default(), Worst::default());
        let views = [1.0, 0.9, 0.5, 0.2, 0.05, 0.01]
            .map(|cos| (cos, Digits::Single))
            .into_iter();
        // In 32 bits, half vectors of directions at this cosine are 6e-8 over it apart, which shows where lobes are as narrow.
        let views = views.filter(|(cos, _)| cos * self.scale > 2e-6);
        let grazing = [0.01, 1e-3, 1e-4].map(|cos| (cos, Digits::Double));
        for (k, view) in views.chain(grazing).enumerate() {
            let p = self.run(view, 70 + k as u64, 0.0, &mut weights, &mut pdfs);
            println!("{} cos {view:?}: p = {p:.4}", self.name);
            family.add(p, format!("{} cos {view:?}", self.name));
        }
        weights.assert_below(
            weight_bound,
            &format!("{}: weight against value ÷ density", self.name),
        );
        pdfs.assert_below(
            pdf_bound,
            &format!("{}: density sampled against evaluated", self.name),
        );
    }
}
