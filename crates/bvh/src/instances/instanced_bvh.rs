//! The two-level hierarchy in memory.

use crate::bounds::Bounds;
use crate::instances::instance::{Instance, InvalidInstance};
use crate::instances::placed::{Placed, place};
use crate::instances::top_level::build_top_level;
use crate::layout::bvh::Bvh;
use crate::layout::node::WideNode;
use crate::layout::validate::check_nodes;

/// Hierarchies of objects, and a hierarchy over their instances.
#[derive(Clone, Debug)]
pub struct InstancedBvh<const N: usize, const P: usize = N> {
    pub(crate) objects: Vec<Bvh<N, P>>,
    /// Leaves name ranges of `placed`.
    pub(crate) nodes: Vec<WideNode<N>>,
    pub(crate) placed: Vec<Placed>,
}

impl<const N: usize, const P: usize> InstancedBvh<N, P> {
    /// Places objects in the world. Instances of objects without triangles are never hit.
    ///
    /// # Panics
    /// If there are more than 2²⁷ instances.
    pub fn new(
        objects: Vec<Bvh<N, P>>,
        instances: &[Instance],
    ) -> Result<InstancedBvh<N, P>, InvalidInstance> {
        assert!(instances.len() <= 1 << 27, "too many instances");
        let bounds: Vec<Bounds> = objects.iter().map(Bvh::bounds).collect();
        let mut placed = Vec::with_capacity(instances.len());
        for (index, instance) in instances.iter().enumerate() {
            let new = place(instance, index, &bounds).map_err(|fault| InvalidInstance {
                instance: index,
                fault,
            })?;
            placed.extend(new);
        }
        let boxes: Vec<Bounds> = placed.iter().map(|placed| placed.bounds).collect();
        let (nodes, order) = build_top_level(&boxes);
        check_nodes(&nodes, placed.len()).expect("the builder keeps the kernels' contract");
        Ok(InstancedBvh {
            objects,
            nodes,
            placed: order.iter().map(|&index| placed[index as usize]).collect(),
        })
    }

    /// The objects' hierarchies.
    pub fn objects(&self) -> &[Bvh<N, P>] {
        &self.objects
    }

    /// The objects' hierarchies, to be placed anew.
    pub fn into_objects(self) -> Vec<Bvh<N, P>> {
        self.objects
    }

    /// The box around everything, in the world; empty if there is nothing.
    pub fn bounds(&self) -> Bounds {
        self.placed
            .iter()
            .fold(Bounds::EMPTY, |bounds, placed| bounds.union(&placed.bounds))
    }

    /// Size of the objects, and of what is stored for their instances.
    pub fn memory_bytes(&self) -> usize {
        let objects: usize = self.objects.iter().map(Bvh::memory_bytes).sum();
        objects + size_of_val(&self.nodes[..]) + size_of_val(&self.placed[..])
    }
}
