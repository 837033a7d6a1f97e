//! Lights: what next-event estimation samples, and what rays that miss everything see.
//!
//! A scene's kinds of lights are a type list, `(A, (B, ()))`, so that a renderer contains the kinds that its
//! scene has and no others. One light is picked, from an alias table by its power or from a [tree](LightTree) by what may arrive
//! at the point, then sampled by its kind.

mod area;
mod area_by_solid_angle;
mod by_tree;
mod emission;
mod environment;
mod pick;
mod punctual;
#[cfg(test)]
mod record_tests;
mod sized;
mod tree;

pub use area::{Area, AreaRecord};
pub use area_by_solid_angle::{AreaBySolidAngle, AreaBySolidAngleRecord};
pub use by_tree::ByTree;
pub use emission::{Emission, EmissionNumbers, NOT_FOUND, SceneSphereRecord, emit};
pub use environment::{Environment, EnvironmentHeader, set_environment};
pub use pick::{
    LIGHT_WORDS, LightRecord, Pick, PickHeader, pick, pick_probability, push_light, set_picks,
};
pub use punctual::{Directional, Point, PunctualRecord, Spot, versine};
pub use sized::{SphericalPoint, SphericalSpot, Sun};
pub use tree::{ClusterRecord, EVERYWHERE, LEAF, LightTree, LightTreeHeader, set_light_tree};

use crate::domain::{Bundle, Domain};
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::surface::{PathRay, Surface};
use crate::triangle::NO_LIGHT;

/// Light arriving at a point from one sampled direction.
#[derive(Clone, Copy, Debug)]
pub struct LightSample<D: Domain> {
    /// Unit direction towards the light.
    pub wi: Vec3<D::F>,
    /// The point it comes from; unused where `infinite`.
    pub position: Vec3<D::F>,
    /// It comes from infinitely far away.
    pub infinite: D::M,
    /// Arriving radiance; for delta lights, radiance over density, which is irradiance at normal incidence of a light without a size.
    pub radiance: Color<D::F>,
    /// Density per steradian; 1 for delta lights.
    pub pdf: D::F,
    /// No BSDF sample can find this light.
    pub delta: D::M,
    /// Density with which light that leaves its point has the direction back, per steradian; 0 where `infinite`.
    pub spread: D::F,
}

impl<D: Domain> Bundle<D> for LightSample<D> {
    #[inline(always)]
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self {
            wi: Vec3::choose(d, mask, a.wi, b.wi),
            position: Vec3::choose(d, mask, a.position, b.position),
            infinite: d.select_mask(mask, a.infinite, b.infinite),
            radiance: Vec3::choose(d, mask, a.radiance, b.radiance),
            pdf: d.select(mask, a.pdf, b.pdf),
            delta: d.select_mask(mask, a.delta, b.delta),
            spread: d.select(mask, a.spread, b.spread),
        }
    }
}

/// Radiance from infinitely far away, and the density with which sampling proposes its direction.
#[derive(Clone, Copy, Debug)]
pub struct Background<D: Domain> {
    /// Radiance.
    pub radiance: Color<D::F>,
    /// Density per steradian, without the pick of the light.
    pub pdf: D::F,
    /// Index of the light.
    pub light: D::U,
}

/// A kind of light.
pub trait LightKind<D: Domain> {
    /// Whether [`sample`](LightKind::sample) takes a third number.
    fn takes_three(&self) -> bool {
        false
    }

    /// Samples the light whose record starts at word `record` for the point `from`.
    fn sample(&self, d: D, record: D::U, from: Vec3<D::F>, u: [D::F; 3]) -> LightSample<D>;

    /// Samples the light whose record starts at word `record`: what leaves it.
    fn emit(&self, d: D, record: D::U, u: EmissionNumbers<D::F>) -> Emission<D>;

    /// What a ray in the unit direction `dir` that hits nothing sees of lights of this kind.
    fn background(&self, _: D, _dir: Vec3<D::F>) -> Option<Background<D>> {
        None
    }

    /// Density, per steradian, with which [`sample`](LightKind::sample) proposes to the origin of `ray` the direction
    /// of `ray`, which met the light with this record at `seen`. `None` for lights that no ray can meet.
    fn density(&self, _: D, _record: D::U, _ray: &PathRay<D>, _seen: &Surface<D>) -> Option<D::F> {
        None
    }

    /// Density, per steradian, with which light that leaves the light with this record at `seen` goes back along the ray that met
    /// it. `None` for lights that no ray can meet.
    fn spread(&self, _: D, _record: D::U, _seen: &Surface<D>) -> Option<D::F> {
        None
    }
}

/// The index of the kind wanted from a list, or from the rest of one that starts at position `first` of the whole.
#[derive(Clone, Copy, Debug)]
pub struct KindIndex<U> {
    kind: U,
    first: u32,
}

impl<U: crate::domain::Unsigned> KindIndex<U> {
    #[inline(always)]
    fn is_first<D: Domain<U = U>>(self, d: D) -> D::M {
        d.eq_u(self.kind, d.uint(self.first))
    }
    #[inline(always)]
    fn in_rest(self) -> Self {
        Self {
            first: self.first + 1,
            ..self
        }
    }
}

/// A list of kinds of lights.
pub trait LightKinds<D: Domain> {
    /// There are no lights at all.
    fn is_empty(&self) -> bool;
    /// Whether any kind takes a third number.
    fn takes_three(&self) -> bool;
    /// Picks a light for the point `from` with the first of two numbers, and makes of both two numbers for a place on it: from
    /// the table, unless the list says otherwise.
    #[inline(always)]
    fn pick(&self, d: D, _from: Vec3<D::F>, u: [D::F; 2]) -> Pick<D> {
        pick::pick(d, u)
    }
    /// The probability with which [`pick`](LightKinds::pick) picks a light for the point `from`.
    #[inline(always)]
    fn pick_probability(&self, d: D, _from: Vec3<D::F>, light: D::U) -> D::F {
        pick::pick_probability(d, light)
    }
    /// Samples a light of kind `kind`.
    fn sample(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        from: Vec3<D::F>,
        u: [D::F; 3],
    ) -> LightSample<D>;
    /// Samples what leaves a light of kind `kind`.
    fn emit(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        u: EmissionNumbers<D::F>,
    ) -> Emission<D>;
    /// The background of the first kind that has one.
    fn background(&self, d: D, dir: Vec3<D::F>) -> Option<Background<D>>;
    /// [`LightKind::density`] of a light of kind `kind`; `None` if no ray can meet any kind.
    fn density(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        ray: &PathRay<D>,
        seen: &Surface<D>,
    ) -> Option<D::F>;
    /// [`LightKind::spread`] of a light of kind `kind`; `None` if no ray can meet any kind.
    fn spread(&self, d: D, kind: KindIndex<D::U>, record: D::U, seen: &Surface<D>) -> Option<D::F>;
}

/// The density of a light that is of the first kind of a list, or of one of the rest.
#[inline(always)]
fn either_density<D: Domain>(
    d: D,
    kind: KindIndex<D::U>,
    first: Option<D::F>,
    rest: Option<D::F>,
) -> Option<D::F> {
    match (first, rest) {
        (Some(first), Some(rest)) => Some(d.select(kind.is_first(d), first, rest)),
        (first, rest) => first.or(rest),
    }
}

impl<D: Domain> LightKinds<D> for () {
    #[inline(always)]
    fn is_empty(&self) -> bool {
        true
    }
    #[inline(always)]
    fn takes_three(&self) -> bool {
        false
    }
    #[inline(always)]
    fn sample(
        &self,
        d: D,
        _: KindIndex<D::U>,
        _: D::U,
        _: Vec3<D::F>,
        _: [D::F; 3],
    ) -> LightSample<D> {
        let zero = Vec3::splat(d.lit(0.0));
        LightSample {
            wi: zero,
            position: zero,
            infinite: d.truth(true),
            radiance: zero,
            pdf: d.lit(1.0),
            delta: d.truth(true),
            spread: d.lit(0.0),
        }
    }
    #[inline(always)]
    fn emit(&self, d: D, _: KindIndex<D::U>, _: D::U, _: EmissionNumbers<D::F>) -> Emission<D> {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let nothing = Vec3::splat(zero);
        Emission {
            ray: PathRay::unbounded(d, nothing, vec3(zero, zero, one)),
            flux: nothing,
            spread: one,
            found: one,
            infinite: d.truth(true),
        }
    }
    #[inline(always)]
    fn background(&self, _: D, _: Vec3<D::F>) -> Option<Background<D>> {
        None
    }
    #[inline(always)]
    fn density(
        &self,
        _: D,
        _: KindIndex<D::U>,
        _: D::U,
        _: &PathRay<D>,
        _: &Surface<D>,
    ) -> Option<D::F> {
        None
    }
    #[inline(always)]
    fn spread(&self, _: D, _: KindIndex<D::U>, _: D::U, _: &Surface<D>) -> Option<D::F> {
        None
    }
}

impl<D: Domain, A: LightKind<D>, B: LightKinds<D>> LightKinds<D> for (A, B) {
    #[inline(always)]
    fn is_empty(&self) -> bool {
        false
    }
    #[inline(always)]
    fn takes_three(&self) -> bool {
        self.0.takes_three() || self.1.takes_three()
    }
    #[inline(always)]
    fn sample(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        from: Vec3<D::F>,
        u: [D::F; 3],
    ) -> LightSample<D> {
        if self.1.is_empty() {
            // The last kind needs no test.
            return self.0.sample(d, record, from, u);
        }
        d.branch(
            kind.is_first(d),
            || self.0.sample(d, record, from, u),
            || self.1.sample(d, kind.in_rest(), record, from, u),
        )
    }
    #[inline(always)]
    fn emit(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        u: EmissionNumbers<D::F>,
    ) -> Emission<D> {
        if self.1.is_empty() {
            return self.0.emit(d, record, u);
        }
        d.branch(
            kind.is_first(d),
            || self.0.emit(d, record, u),
            || self.1.emit(d, kind.in_rest(), record, u),
        )
    }
    #[inline(always)]
    fn background(&self, d: D, dir: Vec3<D::F>) -> Option<Background<D>> {
        self.0
            .background(d, dir)
            .or_else(|| self.1.background(d, dir))
    }
    #[inline(always)]
    fn density(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        ray: &PathRay<D>,
        seen: &Surface<D>,
    ) -> Option<D::F> {
        let first = self.0.density(d, record, ray, seen);
        let rest = self.1.density(d, kind.in_rest(), record, ray, seen);
        either_density(d, kind, first, rest)
    }
    #[inline(always)]
    fn spread(&self, d: D, kind: KindIndex<D::U>, record: D::U, seen: &Surface<D>) -> Option<D::F> {
        let first = self.0.spread(d, record, seen);
        let rest = self.1.spread(d, kind.in_rest(), record, seen);
        either_density(d, kind, first, rest)
    }
}

/// Kinds in boxes: the interpreted renderer's list.
impl<D: Domain> LightKinds<D> for [Box<dyn LightKind<D> + Send + Sync + '_>] {
    fn is_empty(&self) -> bool {
        self.is_empty()
    }
    fn takes_three(&self) -> bool {
        self.iter().any(|kind| kind.takes_three())
    }
    fn sample(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        from: Vec3<D::F>,
        u: [D::F; 3],
    ) -> LightSample<D> {
        match self {
            [] => ().sample(d, kind, record, from, u),
            [last] => last.sample(d, record, from, u),
            [head, tail @ ..] => d.branch(
                kind.is_first(d),
                || head.sample(d, record, from, u),
                || tail.sample(d, kind.in_rest(), record, from, u),
            ),
        }
    }
    fn emit(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        u: EmissionNumbers<D::F>,
    ) -> Emission<D> {
        match self {
            [] => ().emit(d, kind, record, u),
            [last] => last.emit(d, record, u),
            [head, tail @ ..] => d.branch(
                kind.is_first(d),
                || head.emit(d, record, u),
                || tail.emit(d, kind.in_rest(), record, u),
            ),
        }
    }
    fn background(&self, d: D, dir: Vec3<D::F>) -> Option<Background<D>> {
        self.iter().find_map(|kind| kind.background(d, dir))
    }
    fn density(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        ray: &PathRay<D>,
        seen: &Surface<D>,
    ) -> Option<D::F> {
        let (head, tail) = self.split_first()?;
        let first = head.density(d, record, ray, seen);
        let rest = tail.density(d, kind.in_rest(), record, ray, seen);
        either_density(d, kind, first, rest)
    }
    fn spread(&self, d: D, kind: KindIndex<D::U>, record: D::U, seen: &Surface<D>) -> Option<D::F> {
        let (head, tail) = self.split_first()?;
        let first = head.spread(d, record, seen);
        let rest = tail.spread(d, kind.in_rest(), record, seen);
        either_density(d, kind, first, rest)
    }
}

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
            let kind = KindIndex { kind, first: 0 };
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
    let kind = KindIndex { kind, first: 0 };
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
    let kind = KindIndex { kind, first: 0 };
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

/// Multiple importance sampling's power heuristic, in the form that neither overflows nor divides 0 by 0
/// (hard case L-09): the weight of a sample of density `a` > 0 where the other strategy's density is `b`.
#[inline(always)]
pub fn power_heuristic<D: Domain>(d: D, a: D::F, b: D::F) -> D::F {
    let ratio = b / a;
    d.lit(1.0) / d.fma(ratio, ratio, d.lit(1.0))
}
