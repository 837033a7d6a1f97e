//! Streams of rays, and the ways to trace them.

use crate::packet::PacketKernel;
use crate::slab::{Octant, octant};
use crate::triangle::{Axes, axes};
use crate::{BvhView, Hit, HitFilter, Lanes, Precision, Ray, any_hit, closest_hit};

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
        bvh: BvhView<'_, N, P>,
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
        bvh: BvhView<'_, N, P>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    );
}

/// One ray after the other: the best for incoherent rays.
#[derive(Clone, Copy, Debug, Default)]
pub struct Single;

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
    S: Lanes<N> + Lanes<P>,
{
    #[inline(always)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P>,
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
        bvh: BvhView<'_, N, P>,
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

macro_rules! implement_packet_kernel {
    ($kernel:ident, $few:expr) => {
        impl<S, const N: usize, const P: usize, const R: usize> Kernel<S, N, P> for $kernel<R>
        where
            S: Lanes<N> + Lanes<P> + Lanes<R>,
        {
            #[inline(always)]
            fn closest_hits(
                self,
                simd: S,
                precision: impl Precision,
                bvh: BvhView<'_, N, P>,
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
                    few: $few,
                };
                for (rays, hits) in rays.chunks(WINDOW).zip(hits.chunks_mut(WINDOW)) {
                    window::<S, N, P, R, _, _, false>(&kernel, rays, hits);
                }
            }

            #[inline(always)]
            fn any_hits(
                self,
                simd: S,
                precision: impl Precision,
                bvh: BvhView<'_, N, P>,
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
                    few: $few,
                };
                let mut hits = [Hit::miss(0.0); WINDOW];
                for (rays, occluded) in rays.chunks(WINDOW).zip(occluded.chunks_mut(WINDOW)) {
                    let hits = &mut hits[..rays.len()];
                    window::<S, N, P, R, _, _, true>(&kernel, rays, hits);
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

/// What the rays of a packet have in common.
#[derive(Clone, Copy)]
pub(crate) struct Class {
    pub(crate) octant: Octant,
    pub(crate) axes: Axes,
}

impl Class {
    /// Numbers of classes, of which the last is that of invalid rays.
    const COUNT: usize = 25;

    #[inline(always)]
    fn of(ray: &Ray) -> Class {
        Class {
            octant: octant(ray),
            axes: axes(ray),
        }
    }

    #[inline(always)]
    fn number(ray: &Ray) -> usize {
        if !ray.is_valid() {
            return Class::COUNT - 1;
        }
        let Class { octant, axes } = Class::of(ray);
        let octant = octant
            .iter()
            .fold(0, |number, &negative| 2 * number + usize::from(negative));
        3 * octant + axes[2]
    }
}

/// Sorts at most [`WINDOW`] rays by class, keeping their order in each, and traces packets of
/// neighbours.
#[inline(always)]
fn window<S, const N: usize, const P: usize, const R: usize, Pr, F, const ANY: bool>(
    kernel: &PacketKernel<'_, S, N, P, Pr, F>,
    rays: &[Ray],
    hits: &mut [Hit],
) where
    S: Lanes<N> + Lanes<P> + Lanes<R>,
    Pr: Precision,
    F: HitFilter,
{
    const { assert!(R <= 32) };
    let mut numbers = [0u8; WINDOW];
    let mut ends = [0u16; Class::COUNT];
    for ((ray, hit), number) in rays.iter().zip(&mut *hits).zip(&mut numbers) {
        *hit = Hit::miss(ray.interval().1);
        let class = Class::number(ray);
        *number = class as u8;
        ends[class] += 1;
    }
    let mut start = 0;
    for end in &mut ends {
        (*end, start) = (start, start + *end);
    }
    let mut order = [0u16; WINDOW];
    for (ray, &class) in numbers[..rays.len()].iter().enumerate() {
        let place = &mut ends[class as usize];
        order[*place as usize] = ray as u16;
        *place += 1;
    }
    let mut start = 0;
    for &end in &ends[..Class::COUNT - 1] {
        for members in order[start as usize..end as usize].chunks(R) {
            let class = Class::of(&rays[members[0] as usize]);
            kernel.trace::<R, ANY>(rays, members, class, hits);
        }
        start = end;
    }
    for (ray, hit) in rays.iter().zip(hits) {
        if !hit.is_hit() {
            *hit = Hit::miss(ray.tmax);
        }
    }
}
