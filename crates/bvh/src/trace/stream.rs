//! Streams of rays, and the ways to trace them.

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::packet::Packet;
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::answers::Answers;
use crate::trace::goal::{AnyHit, ClosestHit};
use crate::trace::hybrid::HybridKernel;
use crate::trace::packet::PacketKernel;
use crate::trace::phased::PhasedKernel;
use crate::trace::single::{any_hit, closest_hit};

/// How a stream of rays is traced. The answers are the same.
pub trait Kernel<S, const N: usize, const P: usize>: Copy {
    /// The nearest hit of each ray, as [`closest_hit`].
    ///
    /// # Panics
    /// If there are not as many hits as rays.
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    );

    /// Whether each ray hits anything, as [`any_hit`].
    ///
    /// # Panics
    /// If there are not as many answers as rays.
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    );
}

/// One ray after the other: for a few incoherent rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Single;

/// Many rays in flight, which take like steps together: the best for incoherent rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Phased;

/// Packets of `R` rays (4, 8, 16 or 32), sorted by direction within a window: good for coherent rays
/// only.
#[derive(Clone, Copy, Debug, Default)]
pub struct Packets<const R: usize>;

/// Where neighbours are alike, packets of `R` rays (4, 8, 16 or 32; the more, the faster, with registers of eight or sixteen
/// numbers) until few of them agree, then single rays; elsewhere many rays in flight, as [`Phased`], in small hierarchies one after the other. Of up to 85 triangles it
/// tests all, with sixteen rays at once.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hybrid<const R: usize>;

impl<S, const N: usize, const P: usize> Kernel<S, N, P> for Single
where
    S: Width<N> + Width<P>,
{
    #[inline(always)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), hits.len(), "a hit for each ray");
        for (ray, hit) in rays.iter().zip(hits) {
            *hit = closest_hit(simd, precision, bvh, ray, filter);
        }
    }

    #[inline(always)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
        for (ray, occluded) in rays.iter().zip(occluded) {
            *occluded = any_hit(simd, precision, bvh, ray, filter);
        }
    }
}

impl<S, const N: usize, const P: usize> Kernel<S, N, P> for Phased
where
    S: Width<N> + Width<P>,
{
    #[inline(always)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), hits.len(), "a hit for each ray");
        let kernel = PhasedKernel {
            simd,
            precision,
            bvh,
            filter,
            goal: ClosestHit,
        };
        kernel.trace(rays, |ray, hit| hits.one(ray, hit));
    }

    #[inline(always)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
        let kernel = PhasedKernel {
            simd,
            precision,
            bvh,
            filter,
            goal: AnyHit,
        };
        kernel.trace(rays, |ray, hit| occluded.one(ray, hit));
    }
}

impl<S, const N: usize, const P: usize, const R: usize> Kernel<S, N, P> for Packets<R>
where
    S: Width<N> + Width<P> + Width<R>,
{
    #[inline(always)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), hits.len(), "a hit for each ray");
        let kernel = PacketKernel::new(simd, precision, bvh, filter, ClosestHit);
        kernel.windows::<R>(rays, hits);
    }

    #[inline(always)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
        let kernel = PacketKernel::new(simd, precision, bvh, filter, AnyHit);
        kernel.windows::<R>(rays, occluded);
    }
}

impl<S, const N: usize, const P: usize, const R: usize> Kernel<S, N, P> for Hybrid<R>
where
    S: Width<N> + Width<P> + Width<R>,
{
    #[inline(always)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), hits.len(), "a hit for each ray");
        let kernel = HybridKernel {
            simd,
            precision,
            bvh,
            filter,
            goal: ClosestHit,
        };
        kernel.trace::<R>(rays, hits);
    }

    #[inline(always)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    ) {
        assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
        let kernel = HybridKernel {
            simd,
            precision,
            bvh,
            filter,
            goal: AnyHit,
        };
        kernel.trace::<R>(rays, occluded);
    }
}
