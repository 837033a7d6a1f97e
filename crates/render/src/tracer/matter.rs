//! What media do to light between two surfaces.

use super::vertex_pairs::{LIGHT_TEXEL_AND_MEDIUM, pair};
use super::{MediumRecord, Passage, Path, Scattering};
use crate::domain::Domain;
use crate::math::Color;
use crate::math::elementary::log2;
use crate::math::vec3::vec3;
use crate::sampler::Sampler;

/// What media do to light.
pub trait Matter<D: Domain> {
    /// The passage of a path's ray through `length` of a medium.
    fn passage(&self, d: D, path: &Path<D>, medium: &MediumRecord<D>, length: D::F) -> Passage<D>;
}

/// Media absorb light (KHR_materials_volume).
#[derive(Clone, Copy, Debug)]
pub struct Absorption;

impl<D: Domain> Matter<D> for Absorption {
    #[inline(always)]
    fn passage(&self, d: D, _: &Path<D>, medium: &MediumRecord<D>, length: D::F) -> Passage<D> {
        Passage {
            weight: medium.transmittance(d, length),
            scattering: None,
        }
    }
}

/// Media absorb and scatter light (KHR_materials_volume_scatter): how far a ray gets is a random number of one colour, and all
/// colours are weighed as if each had been drawn (Veach 1997, section 9.2.4; PBRT 4, section 14.2).
#[derive(Clone, Copy, Debug)]
pub struct AbsorptionAndScattering<S> {
    /// Where the random number comes from.
    pub sampler: S,
}

/// One of three by a random number in [0, 1), in proportion to what the path counts for in each colour; its probabilities, and
/// the number as if it had been drawn for the choice alone.
#[inline(always)]
fn pick<D: Domain>(d: D, weights: Color<D::F>, u: D::F) -> (Color<D::F>, [D::M; 2], D::F) {
    let one = d.lit(1.0);
    let sum = weights.x + weights.y + weights.z;
    let some = d.lt(d.lit(0.0), sum);
    let scale = one / d.select(some, sum, one);
    let third = d.lit(1.0 / 3.0);
    let share = weights.map(|w| d.select(some, w * scale, third));
    let before_blue = share.x + share.y;
    let (is_red, is_not_blue) = (d.lt(u, share.x), d.lt(u, before_blue));
    let start = d.select(
        is_red,
        d.lit(0.0),
        d.select(is_not_blue, share.x, before_blue),
    );
    let width = d.select(is_red, share.x, d.select(is_not_blue, share.y, share.z));
    let width = d.max(width, d.lit(1e-9));
    let rest = d.min((u - start) / width, d.lit(1.0 - f64::from(f32::EPSILON)));
    (share, [is_red, is_not_blue], rest)
}

impl<D: Domain, S: Sampler<D>> Matter<D> for AbsorptionAndScattering<S> {
    #[inline(always)]
    fn passage(&self, d: D, path: &Path<D>, medium: &MediumRecord<D>, length: D::F) -> Passage<D> {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let [_, u] = pair(d, &self.sampler, path, LIGHT_TEXEL_AND_MEDIUM);
        let (share, [is_red, is_not_blue], u) = pick(d, path.throughput, u);
        let h = medium.halvings;
        let chosen = d.select(is_red, h.x, d.select(is_not_blue, h.y, h.z));
        let distance = -log2(d, one - u) / d.max(chosen, d.lit(1e-30));
        let happens = d.lt(distance, length);

        let left = medium.transmittance(d, d.min(distance, length));
        let lost = vec3(h.x * left.x, h.y * left.y, h.z * left.z);
        let density = d.select(happens, share.dot(d, lost), share.dot(d, left));
        let is_possible = d.lt(zero, density);
        let inverse = one / d.select(is_possible, density, one);
        let scattered = medium.albedo * lost;
        let choose =
            |a: D::F, b: D::F| d.select(is_possible, d.select(happens, a, b) * inverse, zero);
        Passage {
            weight: vec3(
                choose(scattered.x, left.x),
                choose(scattered.y, left.y),
                choose(scattered.z, left.z),
            ),
            scattering: Some(Scattering {
                happens,
                distance,
                anisotropy: medium.anisotropy,
            }),
        }
    }
}

/// [`Matter`] chosen at run time.
#[derive(Clone, Copy, Debug)]
pub enum AnyMatter<S> {
    /// [`Absorption`].
    Absorption(Absorption),
    /// [`AbsorptionAndScattering`].
    AbsorptionAndScattering(AbsorptionAndScattering<S>),
}

impl<D: Domain, S: Sampler<D>> Matter<D> for AnyMatter<S> {
    #[inline(always)]
    fn passage(&self, d: D, path: &Path<D>, medium: &MediumRecord<D>, length: D::F) -> Passage<D> {
        match self {
            Self::Absorption(matter) => matter.passage(d, path, medium, length),
            Self::AbsorptionAndScattering(matter) => matter.passage(d, path, medium, length),
        }
    }
}
