//! Lists of kinds of lights.

use super::pick::{self, Pick};
use super::{Background, Emission, EmissionNumbers, LightKind, LightSample};
use crate::domain::Domain;
use crate::math::Vec3;
use crate::math::vec3::vec3;
use crate::surface::{PathRay, Surface};

/// The index of the kind wanted from a list, or from the rest of one that starts at position `first` of the whole.
#[derive(Clone, Copy, Debug)]
pub struct KindIndex<U> {
    kind: U,
    first: u32,
}

impl<U: crate::domain::Unsigned> KindIndex<U> {
    /// The index of a kind in a whole list.
    #[inline(always)]
    pub(super) fn new(kind: U) -> Self {
        Self { kind, first: 0 }
    }

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

/// Methods of [`LightKinds`] that are those of the list in a field, whatever picks from it.
macro_rules! of_list {
    ($($list:tt)*) => {
        #[inline(always)]
        fn is_empty(&self) -> bool {
            self.$($list)*.is_empty()
        }
        #[inline(always)]
        fn takes_three(&self) -> bool {
            self.$($list)*.takes_three()
        }
        #[inline(always)]
        fn sample(
            &self,
            d: D,
            kind: $crate::light::KindIndex<D::U>,
            record: D::U,
            from: Vec3<D::F>,
            u: [D::F; 3],
        ) -> $crate::light::LightSample<D> {
            self.$($list)*.sample(d, kind, record, from, u)
        }
        #[inline(always)]
        fn emit(
            &self,
            d: D,
            kind: $crate::light::KindIndex<D::U>,
            record: D::U,
            u: $crate::light::EmissionNumbers<D::F>,
        ) -> $crate::light::Emission<D> {
            self.$($list)*.emit(d, kind, record, u)
        }
        #[inline(always)]
        fn background(&self, d: D, dir: Vec3<D::F>) -> Option<$crate::light::Background<D>> {
            self.$($list)*.background(d, dir)
        }
        #[inline(always)]
        fn density(
            &self,
            d: D,
            kind: $crate::light::KindIndex<D::U>,
            record: D::U,
            ray: &$crate::surface::PathRay<D>,
            seen: &$crate::surface::Surface<D>,
        ) -> Option<D::F> {
            self.$($list)*.density(d, kind, record, ray, seen)
        }
        #[inline(always)]
        fn spread(
            &self,
            d: D,
            kind: $crate::light::KindIndex<D::U>,
            record: D::U,
            seen: &$crate::surface::Surface<D>,
        ) -> Option<D::F> {
            self.$($list)*.spread(d, kind, record, seen)
        }
    };
}

pub(crate) use of_list;
