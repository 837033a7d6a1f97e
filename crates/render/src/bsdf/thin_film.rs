//! Iridescence: the reflectance of facets under a thin film.

use super::fresnel::{Fresnel, SchlickCurve};
use crate::domain::Domain;
use crate::math::elementary::{exp2, sincos_turns};
use crate::math::fresnel::{schlick, schlick_weight};
use crate::math::spectrum::rgb_of_xyz;
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::{ColorSource, ScalarSource};

/// A film over a base whose reflectance is a Schlick curve (KHR_materials_iridescence, after Belcour and Barla 2017, "A
/// practical extension to microfacet theory for the modeling of varying iridescence").
#[derive(Clone, Copy, Debug)]
pub struct ThinFilm<N, G, W, I, T> {
    /// Reflectance of the base at normal incidence, F₀.
    pub normal: N,
    /// Reflectance of the base at grazing incidence, F₉₀, where there is no film.
    pub grazing: G,
    /// How much of the surface is under the film, in [0, 1].
    pub strength: W,
    /// Index of refraction of the film, at least 1.
    pub ior: I,
    /// Thickness of the film in nanometres.
    pub thickness: T,
}

/// Below this thickness, in nanometres, the film's index of refraction fades to that of the outside.
const FADING: f64 = 0.03;

/// Spectral sensitivities of the eye, X, Y, Z and the second lobe of X, as Gaussians in Fourier space: their weight, the
/// position of their peak in 1/m, and their variance (Belcour and Barla 2017, supplemental code).
const SENSITIVITIES: [[f64; 3]; 4] = [
    [5.4856e-13, 1.6810e6, 4.3278e9],
    [4.4201e-13, 1.7953e6, 9.3046e9],
    [5.2481e-13, 2.2084e6, 6.6121e9],
    [9.7470e-14, 2.2399e6, 4.5282e9],
];
/// What scales them to a white of 1.
const WHITE: f64 = 1.0685e-7;
/// Reflectance at normal incidence between two indices of refraction.
#[inline(always)]
fn at_normal<D: Domain>(_: D, beyond: D::F, here: D::F) -> D::F {
    let ratio = (beyond - here) / (beyond + here);
    ratio * ratio
}

/// What the eye makes of a phase: twice the cosine of the optical path difference (in nanometres) over the wavelength plus
/// half of `half_turns` for each channel, weighed by the spectral sensitivities; linear Rec. 709.
#[inline(always)]
fn sensitivity<D: Domain>(d: D, path: D::F, half_turns: Vec3<D::F>) -> Color<D::F> {
    let metres = path * d.lit(1e-9);
    let lobe = |[weight, peak, variance]: [f64; 3], half_turns: D::F| {
        let turns = d.fma(metres, d.lit(peak), half_turns * d.lit(0.5));
        let (_, cos) = sincos_turns(d, turns - d.floor(turns));
        let phase = metres * d.lit(std::f64::consts::TAU);
        let decay = exp2(
            d,
            phase * phase * d.lit(-variance * std::f64::consts::LOG2_E),
        );
        let scale = weight * (std::f64::consts::TAU * variance).sqrt() / WHITE;
        cos * decay * d.lit(2.0 * scale)
    };
    let [x, y, z, second] = SENSITIVITIES;
    let xyz = vec3(
        lobe(x, half_turns.x) + lobe(second, half_turns.x),
        lobe(y, half_turns.y),
        lobe(z, half_turns.z),
    );
    rgb_of_xyz(d, xyz)
}

/// The reflectance of a film of this thickness, in nanometres, and index of refraction over a base of this reflectance at normal
/// incidence.
#[inline(never)]
fn film<D: Domain>(d: D, thickness: D::F, ior: D::F, cos: D::F, base: Color<D::F>) -> Color<D::F> {
    d.vectorize(
        #[inline(always)]
        || {
            let (zero, one) = (d.lit(0.0), d.lit(1.0));
            let t = d.min(thickness * d.lit(1.0 / FADING), one);
            let fade = t * t * d.fma(d.lit(-2.0), t, d.lit(3.0));
            let ior = d.fma(fade, ior - one, one);
            // Snell's law: the cosine in the film.
            let sin2 = (one - cos * cos) / (ior * ior);
            let cos_film = d.sqrt(d.max(one - sin2, zero));
            let first = at_normal(d, ior, one);
            let first = schlick(d, first, one, cos);
            let passes = one - first;
            // The base's index of refraction, from its reflectance.
            let base_ior = base.map(|f| {
                let root = d.sqrt(d.min(d.max(f, zero), d.lit(0.9999)));
                (one + root) / (one - root)
            });
            let weight = schlick_weight(d, cos_film);
            let second = base_ior.map(|beyond| {
                let f = at_normal(d, beyond, ior);
                d.fma(one - f, weight, f)
            });
            // Light loses half a turn where it is reflected by what is denser: on the first interface from within, none.
            let half_turns = base_ior.map(|beyond| {
                let second = d.select(d.lt(beyond, ior), one, zero);
                second + one
            });
            let both = second.map(|f| d.min(d.max(first * f, d.lit(1e-5)), d.lit(0.9999)));
            let amplitude = both.map(|r| d.sqrt(r));
            let series = Vec3 {
                x: passes * passes * second.x / (one - both.x),
                y: passes * passes * second.y / (one - both.y),
                z: passes * passes * second.z / (one - both.z),
            };
            let path = d.lit(2.0) * ior * thickness * cos_film;
            let mut sum = series.map(|s| s + first);
            let mut order = series.map(|s| s - passes);
            for m in 1..=2 {
                let m = d.lit(f64::from(m));
                order = order * amplitude;
                sum = sum + order * sensitivity(d, path * m, half_turns.scale(m));
            }
            // Colours out of gamut are clipped.
            sum.map(|c| d.min(d.max(c, zero), one))
        },
    )
}

impl<D, N, G, W, I, T> Fresnel<D> for ThinFilm<N, G, W, I, T>
where
    D: Domain,
    N: ColorSource<D>,
    G: ScalarSource<D>,
    W: ScalarSource<D>,
    I: ScalarSource<D>,
    T: ScalarSource<D>,
{
    #[inline(always)]
    fn reflectance(&self, d: D, surface: &Surface<D>, cos: D::F) -> Color<D::F> {
        let base = SchlickCurve {
            normal: self.normal.color(d, surface),
            grazing: Vec3::splat(self.grazing.scalar(d, surface)),
        };
        let [thickness, ior] = [
            self.thickness.scalar(d, surface),
            self.ior.scalar(d, surface),
        ];
        let film = film(d, thickness, ior, cos, base.normal);
        base.at(d, cos).lerp(film, self.strength.scalar(d, surface))
    }

    /// A flat one: what is seen at this angle.
    #[inline(always)]
    fn curve(&self, d: D, surface: &Surface<D>, cos: D::F) -> SchlickCurve<D> {
        let seen = self.reflectance(d, surface, cos);
        SchlickCurve {
            normal: seen,
            grazing: seen,
        }
    }
}
