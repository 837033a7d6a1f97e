//! Streams of rays, and the ways to trace them.

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::class::{Class, axes};
use crate::layout::columns::Columns;
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::goal::{AnyHit, ClosestHit, Goal};
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
        bvh: BvhView<'_, N, P, impl Boxes<N>>,
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
        bvh: BvhView<'_, N, P, impl Boxes<N>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    );
}

/// One ray after the other: the best for incoherent rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Single;

/// Many rays in flight, which take like steps together: the best for incoherent rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Phased;

/// Packets of `R` rays (4, 8 or 16), sorted by direction within a window: good for coherent rays
/// only.
#[derive(Clone, Copy, Debug, Default)]
pub struct Packets<const R: usize>;

/// Packets of `R` rays (4, 8 or 16), sorted by direction within a window, until few of them agree;
/// then single rays.
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
        bvh: BvhView<'_, N, P, impl Boxes<N>>,
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
        bvh: BvhView<'_, N, P, impl Boxes<N>>,
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
        bvh: BvhView<'_, N, P, impl Boxes<N>>,
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
        kernel.trace(rays, |ray, hit| hits[ray] = hit);
    }

    #[inline(always)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>>,
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
        kernel.trace(rays, |ray, hit| occluded[ray] = hit.is_hit());
    }
}

macro_rules! implement_packet_kernel {
    ($kernel:ident, $few:expr) => {
        impl<S, const N: usize, const P: usize, const R: usize> Kernel<S, N, P> for $kernel<R>
        where
            S: Width<N> + Width<P> + Width<R>,
        {
            #[inline(always)]
            fn closest_hits(
                self,
                simd: S,
                precision: impl Precision,
                bvh: BvhView<'_, N, P, impl Boxes<N>>,
                rays: &[Ray],
                hits: &mut [Hit],
                filter: &impl HitFilter,
            ) {
                assert_eq!(rays.len(), hits.len(), "a hit for each ray");
                let kernel = PacketKernel {
                    simd,
                    precision,
                    bvh,
                    filter,
                    goal: ClosestHit,
                    few: $few,
                };
                for (rays, hits) in rays.chunks(WINDOW).zip(hits.chunks_mut(WINDOW)) {
                    kernel.window::<R>(rays, hits);
                }
            }

            #[inline(always)]
            fn any_hits(
                self,
                simd: S,
                precision: impl Precision,
                bvh: BvhView<'_, N, P, impl Boxes<N>>,
                rays: &[Ray],
                occluded: &mut [bool],
                filter: &impl HitFilter,
            ) {
                assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
                let kernel = PacketKernel {
                    simd,
                    precision,
                    bvh,
                    filter,
                    goal: AnyHit,
                    few: $few,
                };
                let mut hits = [Hit::miss(0.0); WINDOW];
                for (rays, occluded) in rays.chunks(WINDOW).zip(occluded.chunks_mut(WINDOW)) {
                    let hits = &mut hits[..rays.len()];
                    kernel.window::<R>(rays, hits);
                    for (hit, occluded) in hits.iter().zip(occluded) {
                        *occluded = hit.is_hit();
                    }
                }
            }
        }
    };
}
implement_packet_kernel!(Packets, 0);
implement_packet_kernel!(Hybrid, R as u32 / 4);

/// Rays that are sorted into packets together.
const WINDOW: usize = 256;

/// The indices of rays that are in order as they are.
const IN_ORDER: [u16; 32] = {
    let mut order = [0; 32];
    let mut i = 0;
    while i < 32 {
        order[i] = i as u16;
        i += 1;
    }
    order
};

/// Whether packets are worth while: whether most of some pairs of neighbours have a class in common
/// and similar slopes.
#[inline(always)]
fn is_coherent(rays: &[Ray]) -> bool {
    const PAIRS: usize = 8;
    /// Slopes of rays lie in [-1, 1].
    const SIMILAR: f32 = 0.1;
    let step = (rays.len() / PAIRS).max(2);
    let (mut pairs, mut similar) = (0, 0);
    for pair in rays.chunks(step).filter(|pair| pair.len() > 1) {
        let [kx, ky, kz] = axes(&pair[0]);
        let slopes = |ray: &Ray| [ray.dir[kx] / ray.dir[kz], ray.dir[ky] / ray.dir[kz]];
        let (a, b) = (slopes(&pair[0]), slopes(&pair[1]));
        let near = (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < SIMILAR;
        similar += u32::from(near && Class::index(&pair[0]) == Class::index(&pair[1]));
        pairs += 1;
    }
    2 * similar >= pairs
}

impl<S, const N: usize, const P: usize, Pr, F, B, G> PacketKernel<'_, S, N, P, Pr, F, B, G>
where
    Pr: Precision,
    F: HitFilter,
    B: Boxes<N>,
    G: Goal,
{
    /// Traces at most [`WINDOW`] rays.
    #[inline(always)]
    fn window<const R: usize>(&self, rays: &[Ray], hits: &mut [Hit])
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        const { assert!(R <= 32) };
        if is_coherent(rays) {
            // Neighbours make good packets as they come.
            for (rays, hits) in rays.chunks(R).zip(hits.chunks_mut(R)) {
                let members = &IN_ORDER[..rays.len()];
                let columns = Columns::<R>::gather(rays, members);
                match columns.class(self.simd) {
                    Some(class) => self.trace(columns, rays, members, class, hits),
                    None => self.sort::<R>(rays, hits),
                }
            }
        } else if self.few > 0 {
            for (ray, hit) in rays.iter().zip(hits) {
                *hit = self.single(ray);
            }
        } else {
            self.sort::<R>(rays, hits);
        }
    }

    /// Sorts at most [`WINDOW`] rays by class, keeping their order in each, and traces packets of
    /// neighbours.
    #[inline(always)]
    fn sort<const R: usize>(&self, rays: &[Ray], hits: &mut [Hit])
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        let mut classes = [0u8; WINDOW];
        let mut ends = [0u16; Class::INVALID + 1];
        for (ray, class) in rays.iter().zip(&mut classes) {
            *class = Class::index(ray) as u8;
            ends[*class as usize] += 1;
        }
        let mut start = 0;
        for end in &mut ends {
            (*end, start) = (start, start + *end);
        }
        let mut order = [0u16; WINDOW];
        for (ray, &class) in classes[..rays.len()].iter().enumerate() {
            let end = &mut ends[class as usize];
            order[*end as usize] = ray as u16;
            *end += 1;
        }
        let mut start = 0;
        for &end in &ends[..Class::INVALID] {
            for members in order[start as usize..end as usize].chunks(R) {
                if members.len() as u32 > self.few {
                    let class = Class::of(&rays[members[0] as usize]);
                    let columns = Columns::<R>::gather(rays, members);
                    self.trace(columns, rays, members, class, hits);
                } else {
                    for &member in members {
                        hits[member as usize] = self.single(&rays[member as usize]);
                    }
                }
            }
            start = end;
        }
        for &member in &order[start as usize..rays.len()] {
            hits[member as usize] = Hit::miss(rays[member as usize].tmax);
        }
    }
}
