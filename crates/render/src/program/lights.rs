//! The lights of the interpreted renderer.

use super::Structure;
use super::boxed::Boxing;
use crate::domain::Domain;
use crate::light::{LightKind, LightKinds, LightTree, Pick, of_list};
use crate::math::Vec3;

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
    of_list!(kinds[..]);

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
}
