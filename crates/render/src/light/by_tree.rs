//! Kinds of lights that are picked from a tree.

use super::tree::LightTree;
use super::{Background, Emission, EmissionNumbers, KindIndex, LightKinds, LightSample, Pick};
use crate::domain::Domain;
use crate::math::Vec3;
use crate::surface::{PathRay, Surface};

/// Lights of the kinds of a list, picked from a [`LightTree`] instead of a table.
#[derive(Clone, Copy, Debug)]
pub struct ByTree<K> {
    /// The tree.
    pub tree: LightTree,
    /// The kinds.
    pub kinds: K,
}

impl<D: Domain, K: LightKinds<D>> LightKinds<D> for ByTree<K> {
    #[inline(always)]
    fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }
    #[inline(always)]
    fn takes_three(&self) -> bool {
        self.kinds.takes_three()
    }
    #[inline(always)]
    fn pick(&self, d: D, from: Vec3<D::F>, u: [D::F; 2]) -> Pick<D> {
        self.tree.pick(d, from, u)
    }
    #[inline(always)]
    fn pick_probability(&self, d: D, from: Vec3<D::F>, light: D::U) -> D::F {
        self.tree.probability(d, from, light)
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
        self.kinds.sample(d, kind, record, from, u)
    }
    #[inline(always)]
    fn emit(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        u: EmissionNumbers<D::F>,
    ) -> Emission<D> {
        self.kinds.emit(d, kind, record, u)
    }
    #[inline(always)]
    fn background(&self, d: D, dir: Vec3<D::F>) -> Option<Background<D>> {
        self.kinds.background(d, dir)
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
        self.kinds.density(d, kind, record, ray, seen)
    }
    #[inline(always)]
    fn spread(&self, d: D, kind: KindIndex<D::U>, record: D::U, seen: &Surface<D>) -> Option<D::F> {
        self.kinds.spread(d, kind, record, seen)
    }
}
