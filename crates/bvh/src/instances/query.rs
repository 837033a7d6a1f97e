//! Queries of two-level hierarchies.

use std::mem::{offset_of, size_of};
use std::ops::ControlFlow;

use crate::filter::HitFilter;
use crate::instances::instanced_bvh::InstancedBvh;
use crate::instances::placed::Placed;
use crate::layout::child::Child;
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::goal::{AnyHit, ClosestHit, Goal};
use crate::trace::single::search;
use crate::trace::slab::Slab;
use crate::trace::traverse::{Visitor, traverse};

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

const _: () = assert!(size_of::<InstanceHit>() == 20 && offset_of!(InstanceHit, instance) == 16);

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
    S: Width<N> + Width<P>,
{
    query(simd, precision, bvh, ray, filter, ClosestHit)
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
    S: Width<N> + Width<P>,
{
    query(simd, precision, bvh, ray, filter, AnyHit).is_hit()
}

#[inline(always)]
fn query<S, const N: usize, const P: usize>(
    simd: S,
    precision: impl Precision,
    bvh: &InstancedBvh<N, P>,
    ray: &Ray,
    filter: &impl HitFilter,
    goal: impl Goal,
) -> InstanceHit
where
    S: Width<N> + Width<P>,
{
    if !ray.is_valid() {
        return InstanceHit::miss(ray.tmax);
    }
    let (tmin, tmax) = ray.interval();
    let mut search = InstanceSearch {
        simd,
        precision,
        bvh,
        ray,
        tmin,
        filter,
        goal,
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
struct InstanceSearch<'a, S, const N: usize, const P: usize, Pr, F, G> {
    simd: S,
    precision: Pr,
    bvh: &'a InstancedBvh<N, P>,
    ray: &'a Ray,
    tmin: f32,
    filter: &'a F,
    goal: G,
    best: InstanceHit,
}

impl<S, const N: usize, const P: usize, Pr: Precision, F: HitFilter, G: Goal> Visitor
    for InstanceSearch<'_, S, N, P, Pr, F, G>
where
    S: Width<N> + Width<P>,
{
    type Goal = G;
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
                search(
                    self.simd,
                    self.precision,
                    self.bvh.objects[placed.bvh as usize].view(),
                    Child::ROOT,
                    &object_ray,
                    self.tmin,
                    self.filter,
                    self.goal,
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
                self.goal.found()?;
            }
        }
        ControlFlow::Continue(())
    }
}
