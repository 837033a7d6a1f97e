//! Queries without SIMD: methods that pick the best kernel for the machine they run on.
//!
//! They are watertight, and trace streams with the hybrid kernel. Each call looks up the instruction
//! set anew, which costs little next to one ray and nothing next to a stream of them; code that is
//! itself compiled for an instruction set calls the kernels.

use fearless_simd::{Level, dispatch};

use crate::filter::{AllHits, HitFilter};
use crate::instances::instanced_bvh::InstancedBvh;
use crate::instances::query::{InstanceHit, any_instance_hit, closest_instance_hit};
use crate::layout::bvh::Bvh;
use crate::precision::watertight::Watertight;
use crate::ray::{Hit, Ray};
use crate::trace::single::{any_hit, closest_hit};
use crate::trace::stream::{Hybrid, Kernel};

/// Widths for which a query can be dispatched at run time: `N` of 2, 4, 8 or 16 with `P` of 1, 4, 8
/// or 16. Implemented for the [`Bvh`]s of these widths, and nothing else.
pub trait HasKernels<const N: usize, const P: usize>: sealed::Dispatch<N, P> {}

impl<const N: usize, const P: usize> Bvh<N, P>
where
    Bvh<N, P>: HasKernels<N, P>,
{
    /// The nearest hit in the ray's interval; of several at the same distance, the one with the
    /// smallest triangle index.
    pub fn closest_hit(&self, ray: &Ray) -> Hit {
        self.closest_hit_filtered(ray, &AllHits)
    }

    /// As [`closest_hit`](Bvh::closest_hit), among the hits that `filter` accepts.
    pub fn closest_hit_filtered(&self, ray: &Ray, filter: &impl HitFilter) -> Hit {
        sealed::Dispatch::closest_hit(self, ray, filter)
    }

    /// Whether there is a hit in the ray's interval.
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.any_hit_filtered(ray, &AllHits)
    }

    /// As [`any_hit`](Bvh::any_hit), among the hits that `filter` accepts.
    pub fn any_hit_filtered(&self, ray: &Ray, filter: &impl HitFilter) -> bool {
        sealed::Dispatch::any_hit(self, ray, filter)
    }

    /// The nearest hit of each ray.
    ///
    /// # Panics
    /// If there are not as many hits as rays.
    pub fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit]) {
        self.closest_hits_filtered(rays, hits, &AllHits);
    }

    /// As [`closest_hits`](Bvh::closest_hits), among the hits that `filter` accepts.
    pub fn closest_hits_filtered(&self, rays: &[Ray], hits: &mut [Hit], filter: &impl HitFilter) {
        sealed::Dispatch::closest_hits(self, rays, hits, filter);
    }

    /// Whether each ray hits anything.
    ///
    /// # Panics
    /// If there are not as many answers as rays.
    pub fn any_hits(&self, rays: &[Ray], occluded: &mut [bool]) {
        self.any_hits_filtered(rays, occluded, &AllHits);
    }

    /// As [`any_hits`](Bvh::any_hits), among the hits that `filter` accepts.
    pub fn any_hits_filtered(&self, rays: &[Ray], occluded: &mut [bool], filter: &impl HitFilter) {
        sealed::Dispatch::any_hits(self, rays, occluded, filter);
    }
}

impl<const N: usize, const P: usize> InstancedBvh<N, P>
where
    Bvh<N, P>: HasKernels<N, P>,
{
    /// The nearest hit in the ray's interval; of several at the same distance, the one with the
    /// smallest instance index, then with the smallest triangle index.
    pub fn closest_hit(&self, ray: &Ray) -> InstanceHit {
        self.closest_hit_filtered(ray, &AllHits)
    }

    /// As [`closest_hit`](InstancedBvh::closest_hit), among the hits that `filter` accepts. It sees
    /// rays and hits in the object's space.
    pub fn closest_hit_filtered(&self, ray: &Ray, filter: &impl HitFilter) -> InstanceHit {
        let mut hits = [InstanceHit::miss(ray.tmax)];
        <Bvh<N, P> as sealed::Dispatch<N, P>>::closest_instance_hits(
            self,
            std::slice::from_ref(ray),
            &mut hits,
            filter,
        );
        hits[0]
    }

    /// Whether there is a hit in the ray's interval.
    pub fn any_hit(&self, ray: &Ray) -> bool {
        self.any_hit_filtered(ray, &AllHits)
    }

    /// As [`any_hit`](InstancedBvh::any_hit), among the hits that `filter` accepts. It sees rays and
    /// hits in the object's space.
    pub fn any_hit_filtered(&self, ray: &Ray, filter: &impl HitFilter) -> bool {
        let mut occluded = [false];
        <Bvh<N, P> as sealed::Dispatch<N, P>>::any_instance_hits(
            self,
            std::slice::from_ref(ray),
            &mut occluded,
            filter,
        );
        occluded[0]
    }

    /// The nearest hit of each ray.
    ///
    /// # Panics
    /// If there are not as many hits as rays.
    pub fn closest_hits(&self, rays: &[Ray], hits: &mut [InstanceHit]) {
        assert_eq!(rays.len(), hits.len(), "a hit for each ray");
        <Bvh<N, P> as sealed::Dispatch<N, P>>::closest_instance_hits(self, rays, hits, &AllHits);
    }

    /// Whether each ray hits anything.
    ///
    /// # Panics
    /// If there are not as many answers as rays.
    pub fn any_hits(&self, rays: &[Ray], occluded: &mut [bool]) {
        assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
        <Bvh<N, P> as sealed::Dispatch<N, P>>::any_instance_hits(self, rays, occluded, &AllHits);
    }
}

mod sealed {
    use crate::filter::HitFilter;
    use crate::instances::instanced_bvh::InstancedBvh;
    use crate::instances::query::InstanceHit;
    use crate::ray::{Hit, Ray};

    /// The queries that are compiled for every instruction set.
    pub trait Dispatch<const N: usize, const P: usize> {
        fn closest_hit(&self, ray: &Ray, filter: &impl HitFilter) -> Hit;
        fn any_hit(&self, ray: &Ray, filter: &impl HitFilter) -> bool;
        fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], filter: &impl HitFilter);
        fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], filter: &impl HitFilter);
        fn closest_instance_hits(
            bvh: &InstancedBvh<N, P>,
            rays: &[Ray],
            hits: &mut [InstanceHit],
            filter: &impl HitFilter,
        );
        fn any_instance_hits(
            bvh: &InstancedBvh<N, P>,
            rays: &[Ray],
            occluded: &mut [bool],
            filter: &impl HitFilter,
        );
    }
}

/// Rays in a packet of a stream, on whatever instruction set: two to eight registers of them make up for each other's waiting.
const PACKET: usize = 32;

/// A macro, because a function cannot ask that every instruction set has a width.
macro_rules! implement_dispatch {
    ($($n:literal x [$($p:literal)*],)*) => {$($(
        impl HasKernels<$n, $p> for Bvh<$n, $p> {}

        impl sealed::Dispatch<$n, $p> for Bvh<$n, $p> {
            fn closest_hit(&self, ray: &Ray, filter: &impl HitFilter) -> Hit {
                dispatch!(Level::new(), simd =>
                    closest_hit(simd, Watertight, self.view(), ray, filter))
            }

            fn any_hit(&self, ray: &Ray, filter: &impl HitFilter) -> bool {
                dispatch!(Level::new(), simd =>
                    any_hit(simd, Watertight, self.view(), ray, filter))
            }

            fn closest_hits(&self, rays: &[Ray], hits: &mut [Hit], filter: &impl HitFilter) {
                let (kernel, bvh) = (Hybrid::<PACKET>, self.view());
                dispatch!(Level::new(), simd =>
                    kernel.closest_hits(simd, Watertight, bvh, rays, hits, filter))
            }

            fn any_hits(&self, rays: &[Ray], occluded: &mut [bool], filter: &impl HitFilter) {
                let (kernel, bvh) = (Hybrid::<PACKET>, self.view());
                dispatch!(Level::new(), simd =>
                    kernel.any_hits(simd, Watertight, bvh, rays, occluded, filter))
            }

            fn closest_instance_hits(
                bvh: &InstancedBvh<$n, $p>,
                rays: &[Ray],
                hits: &mut [InstanceHit],
                filter: &impl HitFilter,
            ) {
                dispatch!(Level::new(), simd => for (ray, hit) in rays.iter().zip(hits) {
                    *hit = closest_instance_hit(simd, Watertight, bvh, ray, filter);
                })
            }

            fn any_instance_hits(
                bvh: &InstancedBvh<$n, $p>,
                rays: &[Ray],
                occluded: &mut [bool],
                filter: &impl HitFilter,
            ) {
                dispatch!(Level::new(), simd => for (ray, occluded) in rays.iter().zip(occluded) {
                    *occluded = any_instance_hit(simd, Watertight, bvh, ray, filter);
                })
            }
        }
    )*)*};
}
implement_dispatch! {
    2 x [1 4 8 16],
    4 x [1 4 8 16],
    8 x [1 4 8 16],
    16 x [1 4 8 16],
}

/// Hierarchies are shared between threads.
const _: fn() = || {
    fn shared<T: Send + Sync>() {}
    shared::<Bvh<8>>();
    shared::<InstancedBvh<8>>();
};
