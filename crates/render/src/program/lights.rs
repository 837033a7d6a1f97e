//! The lights of the interpreted renderer.

use super::Structure;
use super::boxed::Boxing;
use crate::domain::Domain;
use crate::light::{
    Background, Emission, EmissionNumbers, KindIndex, LightKind, LightKinds, LightSample,
    LightTree, Pick,
};
use crate::math::Vec3;
use crate::surface::{PathRay, Surface};

/// Kinds of lights in boxes, and how a light is picked.
pub struct BoxedLights<'a, D: Domain> {
    /// The kinds.
    pub kinds: Vec<Box<dyn LightKind<D> + Send + Sync + 'a>>,
    tree: Option<LightTree>,
}

impl<'a, D: Domain + 'a> BoxedLights<'a, D> {
    /// Those of a structure.
    pub(super) fn new(structure: &Structure) -> Self {
        Self {
            kinds: structure.lights.iter().map(Boxing::boxed).collect(),
            tree: structure.light_tree,
        }
    }
}

impl<D: Domain> LightKinds<D> for BoxedLights<'_, D> {
    fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }
    fn takes_three(&self) -> bool {
        self.kinds[..].takes_three()
    }
    #[inline(always)]
    fn pick(&self, d: D, from: Vec3<D::F>, u: [D::F; 2]) -> Pick<D> {
        match self.tree {
            Some(tree) => tree.pick(d, from, u),
            None => self.kinds[..].pick(d, from, u),
        }
    }
    #[inline(always)]
    fn pick_probability(&self, d: D, from: Vec3<D::F>, light: D::U) -> D::F {
        match self.tree {
            Some(tree) => tree.probability(d, from, light),
            None => self.kinds[..].pick_probability(d, from, light),
        }
    }
    fn sample(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        from: Vec3<D::F>,
        u: [D::F; 3],
    ) -> LightSample<D> {
        self.kinds[..].sample(d, kind, record, from, u)
    }
    fn emit(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        u: EmissionNumbers<D::F>,
    ) -> Emission<D> {
        self.kinds[..].emit(d, kind, record, u)
    }
    fn background(&self, d: D, dir: Vec3<D::F>) -> Option<Background<D>> {
        self.kinds[..].background(d, dir)
    }
    fn density(
        &self,
        d: D,
        kind: KindIndex<D::U>,
        record: D::U,
        ray: &PathRay<D>,
        seen: &Surface<D>,
    ) -> Option<D::F> {
        self.kinds[..].density(d, kind, record, ray, seen)
    }
    fn spread(&self, d: D, kind: KindIndex<D::U>, record: D::U, seen: &Surface<D>) -> Option<D::F> {
        self.kinds[..].spread(d, kind, record, seen)
    }
}
