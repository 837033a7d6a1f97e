//! Two-level hierarchies: objects, each in a space of its own, placed in the world any number of
//! times.
//!
//! A ray is taken to an object's space without normalising its direction, so that distances mean
//! the same in both. What holds within a hierarchy (no holes between triangles, ties) holds within
//! an instance, in the object's space.

use std::fmt;
use std::ops::ControlFlow;

use glam::Affine3A;

use crate::bvh::{Child, Node};
use crate::placed::{Placed, place};
use crate::single::search;
use crate::slab::Slab;
use crate::top_level::build_top_level;
use crate::traverse::{Visitor, traverse};
use crate::validate::check_nodes;
use crate::{Bounds, Bvh, Hit, HitFilter, Lanes, Precision, Ray};

/// An object placed in the world.
///
/// The transform may mirror and shear. Fronts are the object's: the front of a triangle is the side
/// from which its vertices appear counter-clockwise in the object's space, and a mirror takes it
/// along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Index of the object's hierarchy.
    pub bvh: usize,
    /// From the object's space to the world's.
    pub object_to_world: Affine3A,
}

/// An instance that cannot be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InvalidInstance {
    /// Index of the instance.
    pub instance: usize,
    /// What is wrong with it.
    pub fault: InstanceFault,
}

/// What is wrong with an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstanceFault {
    /// There is no hierarchy of this index.
    NoSuchObject {
        /// The index.
        bvh: usize,
    },
    /// The transform, or its inverse, has components that are not finite.
    NotFinite,
    /// The transform's determinant is zero, as far as `f64` can tell.
    NotInvertible,
}

impl fmt::Display for InvalidInstance {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let InvalidInstance { instance, fault } = self;
        write!(f, "instance {instance}: ")?;
        match fault {
            InstanceFault::NoSuchObject { bvh } => write!(f, "there is no object {bvh}"),
            InstanceFault::NotFinite => write!(f, "the transform or its inverse is not finite"),
            InstanceFault::NotInvertible => write!(f, "the transform has no inverse"),
        }
    }
}

impl std::error::Error for InvalidInstance {}

/// Where a ray meets an instance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct InstanceHit {
    /// The distance, in units of the ray's direction in either space; and the place in the object's
    /// mesh.
    pub hit: Hit,
    /// Index of the instance; [`Hit::NONE`] on a miss.
    pub instance: u32,
}

impl InstanceHit {
    /// The answer for a ray that meets nothing up to `tmax`.
    #[inline(always)]
    pub fn miss(tmax: f32) -> InstanceHit {
        InstanceHit {
            hit: Hit::miss(tmax),
            instance: Hit::NONE,
        }
    }

    /// Whether an instance was hit.
    #[inline(always)]
    pub fn is_hit(&self) -> bool {
        self.hit.is_hit()
    }
}

/// Hierarchies of objects, and a hierarchy over their instances.
#[derive(Clone, Debug)]
pub struct InstancedBvh<const N: usize, const P: usize = N> {
    objects: Vec<Bvh<N, P>>,
    /// Leaves name ranges of `placed`.
    nodes: Vec<Node<N>>,
    placed: Vec<Placed>,
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

/// The nearest hit with an instance in the ray's interval that `filter` accepts; of several at the
/// same distance, the one with the smallest instance index, then with the smallest triangle index.
///
/// The filter sees rays and hits in the object's space.
#[inline(always)]
pub fn closest_instance_hit<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: &InstancedBvh<N, P>,
    ray: &Ray,
    filter: &impl HitFilter,
) -> InstanceHit
where
    S: Lanes<N> + Lanes<P>,
{
    query::<S, N, P, _, _, false>(simd, precision, bvh, ray, filter)
}

/// Whether there is a hit with an instance in the ray's interval that `filter` accepts: exactly
/// when [`closest_instance_hit`] finds one.
#[inline(always)]
pub fn any_instance_hit<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: &InstancedBvh<N, P>,
    ray: &Ray,
    filter: &impl HitFilter,
) -> bool
where
    S: Lanes<N> + Lanes<P>,
{
    query::<S, N, P, _, _, true>(simd, precision, bvh, ray, filter).is_hit()
}

#[inline(always)]
fn query<S, const N: usize, const P: usize, Pr: Precision, F: HitFilter, const ANY: bool>(
    simd: S,
    precision: Pr,
    bvh: &InstancedBvh<N, P>,
    ray: &Ray,
    filter: &F,
) -> InstanceHit
where
    S: Lanes<N> + Lanes<P>,
{
    if !ray.is_valid() {
        return InstanceHit::miss(ray.tmax);
    }
    let (tmin, tmax) = ray.interval();
    let mut search = InstanceSearch::<S, N, P, Pr, F, ANY> {
        simd,
        precision,
        bvh,
        ray,
        tmin,
        filter,
        best: InstanceHit::miss(tmax),
    };
    let slab = Slab::<S, N>::of_ray(simd, ray, tmin);
    // SAFETY: the nodes were checked, and the root is there.
    unsafe { traverse(simd, &bvh.nodes, Child::ROOT, &slab, &mut search) };
    if search.best.is_hit() {
        search.best
    } else {
        InstanceHit::miss(ray.tmax)
    }
}

/// The search for one ray's hit among the instances.
struct InstanceSearch<'a, S, const N: usize, const P: usize, Pr, F, const ANY: bool> {
    simd: S,
    precision: Pr,
    bvh: &'a InstancedBvh<N, P>,
    ray: &'a Ray,
    tmin: f32,
    filter: &'a F,
    best: InstanceHit,
}

impl<S, const N: usize, const P: usize, Pr: Precision, F: HitFilter, const ANY: bool> Visitor
    for InstanceSearch<'_, S, N, P, Pr, F, ANY>
where
    S: Lanes<N> + Lanes<P>,
{
    const ANY: bool = ANY;
    type Item = Placed;

    #[inline(always)]
    fn items(&self) -> &[Placed] {
        &self.bvh.placed
    }

    #[inline(always)]
    fn tmax(&self) -> f32 {
        self.best.hit.t
    }

    #[inline(always)]
    fn leaf(&mut self, leaf: Child) -> ControlFlow<()> {
        let first = leaf.first_packet();
        for placed in &self.bvh.placed[first..first + leaf.packet_count()] {
            let (entry, exit) = placed.bounds.passage(self.ray);
            let entry = entry.max(self.tmin);
            let object_ray = placed.object_ray(self.ray);
            if entry > exit || entry > self.best.hit.t || !object_ray.is_valid() {
                continue;
            }
            // SAFETY: the root is there.
            let mut hit = unsafe {
                search::<S, N, P, Pr, F, _, ANY>(
                    self.simd,
                    self.precision,
                    self.bvh.objects[placed.bvh as usize].view(),
                    Child::ROOT,
                    &object_ray,
                    self.tmin,
                    self.filter,
                    Hit::miss(self.best.hit.t),
                )
            };
            if !hit.is_hit() {
                continue;
            }
            hit.t = hit.t.max(entry);
            let instance = placed.instance;
            if (hit.t, instance) < (self.best.hit.t, self.best.instance) {
                self.best = InstanceHit { hit, instance };
                if ANY {
                    return ControlFlow::Break(());
                }
            }
        }
        ControlFlow::Continue(())
    }
}
