//! Kinds of lights that are picked from a tree.

use super::kinds::of_list;
use super::tree::LightTree;
use super::{LightKinds, Pick};
use crate::domain::Domain;
use crate::math::Vec3;

/// Lights of the kinds of a list, picked from a [`LightTree`] instead of a table.
#[derive(Clone, Copy, Debug)]
pub struct ByTree<K> {
    /// The tree.
    pub tree: LightTree,
    /// The kinds.
    pub kinds: K,
}

impl<D: Domain, K: LightKinds<D>> LightKinds<D> for ByTree<K> {
    of_list!(kinds);

    #[inline(always)]
    fn pick(&self, d: D, from: Vec3<D::F>, u: [D::F; 2]) -> Pick<D> {
        self.tree.pick(d, from, u)
    }
    #[inline(always)]
    fn pick_probability(&self, d: D, from: Vec3<D::F>, light: D::U) -> D::F {
        self.tree.probability(d, from, light)
    }
}
