//! What is asked of a scene's lights as a whole: one of them is picked, and asked.

use super::kinds::{KindIndex, LightKinds};
use super::pick::{self, Pick};
use super::{Background, Emission, EmissionNumbers, LightSample};
use crate::domain::Domain;
use crate::math::Vec3;
use crate::surface::{PathRay, Surface};
use crate::triangle::NO_LIGHT;

/// Picks a light and samples it, both with the first two numbers; the third is for kinds that
/// [take three](LightKinds::takes_three). The density includes the pick.
///
/// It is never inlined: all programs of a scene share one copy, which halves what there is to compile and to keep in the
/// instruction cache. The values that enter and leave through memory cost less than the sampling by far.
#[inline(never)]
pub fn sample<D: Domain, L: LightKinds<D> + ?Sized>(
    d: D,
    lights: &L,
    from: Vec3<D::F>,
    u: [D::F; 3],
) -> LightSample<D> {
    d.vectorize(
        #[inline(always)]
        || {
            let Pick {
                kind,
                record,
                probability,
                place: [x, y],
            } = lights.pick(d, from, [u[0], u[1]]);
            let kind = KindIndex::new(kind);
            let sample = lights.sample(d, kind, record, from, [x, y, u[2]]);
            // A delta light's "density" of 1 turns into the probability of its pick; the estimator is the same.
            LightSample {
                pdf: sample.pdf * probability,
                ..sample
            }
        },
    )
}

/// Density, per steradian and the pick included, with which light sampling proposes to the origin of `ray` the
/// direction of `ray`, which met a surface at `seen`; 0 where that is no light.
#[inline(always)]
pub fn density<D: Domain, L: LightKinds<D> + ?Sized>(
    d: D,
    lights: &L,
    ray: &PathRay<D>,
    seen: &Surface<D>,
) -> D::F {
    let no_light = d.eq_u(seen.light, d.uint(NO_LIGHT));
    let light = d.select_u(no_light, d.uint(0), seen.light);
    let (kind, record) = pick::find(d, light);
    let kind = KindIndex::new(kind);
    match lights.density(d, kind, record, ray, seen) {
        Some(density) => {
            let density = density * lights.pick_probability(d, ray.org, light);
            d.select(no_light, d.lit(0.0), density)
        }
        None => d.lit(0.0),
    }
}

/// Density, per steradian, with which light that leaves the surface at `seen` goes back along the ray that met it; 0 where that is
/// no light.
#[inline(always)]
pub fn spread<D: Domain, L: LightKinds<D> + ?Sized>(d: D, lights: &L, seen: &Surface<D>) -> D::F {
    let no_light = d.eq_u(seen.light, d.uint(NO_LIGHT));
    let light = d.select_u(no_light, d.uint(0), seen.light);
    let (kind, record) = pick::find(d, light);
    let kind = KindIndex::new(kind);
    let spread = lights.spread(d, kind, record, seen);
    let spread = spread.unwrap_or_else(|| d.lit(0.0));
    d.select(no_light, d.lit(0.0), spread)
}

/// What a ray that hits nothing sees of the lights. The density is that with which light sampling proposes its direction to its
/// origin, the pick included.
#[inline(always)]
pub fn background<D: Domain, L: LightKinds<D> + ?Sized>(
    d: D,
    lights: &L,
    ray: &PathRay<D>,
) -> Option<Background<D>> {
    let seen = lights.background(d, ray.dir)?;
    Some(Background {
        pdf: seen.pdf * lights.pick_probability(d, ray.org, seen.light),
        ..seen
    })
}

/// Picks a light by its power and samples what leaves it: place, a number for lights that [take three](LightKinds::takes_three),
/// and direction. Flux and densities include the pick.
#[inline(always)]
pub fn emit<D: Domain, L: LightKinds<D> + ?Sized>(
    d: D,
    lights: &L,
    u: EmissionNumbers<D::F>,
) -> Emission<D> {
    // Lights are in a table where paths begin at them, whose picks ask for no place.
    let nowhere = Vec3::splat(d.lit(0.0));
    let Pick {
        kind,
        record,
        probability,
        place,
    } = lights.pick(d, nowhere, u.place);
    let kind = KindIndex::new(kind);
    let emission = lights.emit(d, kind, record, EmissionNumbers { place, ..u });
    Emission {
        flux: emission.flux.scale(d.lit(1.0) / probability),
        found: emission.found * probability,
        ..emission
    }
}
