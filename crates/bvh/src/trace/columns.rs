//! Streams of packets that are given and answered in columns: nothing is sorted, nothing transposed.

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::class::Class;
use crate::layout::packet::Packet;
use crate::layout::ray_packet::{HitPacket, RayPacket};
use crate::precision::triangle_test::Precision;
use crate::simd::Width;
use crate::trace::best_hits::lanes;
use crate::trace::goal::{AnyHit, ClosestHit, Goal};
use crate::trace::packet::PacketKernel;

/// The nearest hit of each ray, as [`closest_hit`](crate::closest_hit), of packets of `R` rays (4, 8, 16 or 32: the more, the
/// faster). It pays where a packet's rays come from about one place and go in about one direction, as those through
/// neighbours of an image do.
/// Rays that are not [valid](crate::Ray::is_valid) hit nothing.
///
/// # Panics
/// If there are not as many packets of hits as of rays.
#[inline(always)]
pub fn closest_hit_packets<S, const N: usize, const P: usize, const R: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    rays: &[RayPacket<R>],
    hits: &mut [HitPacket<R>],
    filter: &impl HitFilter,
) where
    S: Width<N> + Width<P> + Width<R>,
{
    assert_eq!(rays.len(), hits.len(), "a packet of hits for each of rays");
    let kernel = PacketKernel::hybrid::<R>(simd, precision, bvh, filter, ClosestHit);
    for (rays, hits) in rays.iter().zip(hits) {
        kernel.packet(rays, hits);
    }
}

/// Which rays of each packet hit anything, as bits, the first ray's in the lowest: as [`any_hit`](crate::any_hit), of packets as for
/// [`closest_hit_packets`].
///
/// # Panics
/// If there are not as many answers as packets.
#[inline(always)]
pub fn any_hit_packets<S, const N: usize, const P: usize, const R: usize>(
    simd: S,
    precision: impl Precision,
    bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
    rays: &[RayPacket<R>],
    occluded: &mut [u32],
    filter: &impl HitFilter,
) where
    S: Width<N> + Width<P> + Width<R>,
{
    assert_eq!(rays.len(), occluded.len(), "an answer for each packet");
    let kernel = PacketKernel::hybrid::<R>(simd, precision, bvh, filter, AnyHit);
    for (rays, occluded) in rays.iter().zip(occluded) {
        let mut hits = HitPacket::misses(rays);
        kernel.packet(rays, &mut hits);
        *occluded = hits.hits();
    }
}

impl<S, const N: usize, const P: usize, Pr, F, B, T, G> PacketKernel<'_, S, N, P, Pr, F, B, T, G>
where
    Pr: Precision,
    F: HitFilter,
    B: Boxes<N>,
    T: Packet<P>,
    G: Goal,
{
    /// Traces the rays of a packet.
    #[inline(always)]
    fn packet<const R: usize>(&self, rays: &RayPacket<R>, hits: &mut HitPacket<R>)
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        match rays.class(self.simd) {
            Some(class) => self.trace(rays, u32::MAX >> (32 - R), class, hits),
            None => self.classes(rays, hits),
        }
    }

    /// Traces the rays of a packet class by class.
    #[inline(always)]
    fn classes<const R: usize>(&self, rays: &RayPacket<R>, hits: &mut HitPacket<R>)
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        *hits = HitPacket::misses(rays);
        let mut rest = rays.valid(self.simd);
        while let Some(first) = lanes(rest).next() {
            let ray = rays.ray(first);
            let index = Class::index(&ray);
            let mut members = 0;
            for lane in lanes(rest) {
                members |= u32::from(Class::index(&rays.ray(lane)) == index) << lane;
            }
            rest &= !members;
            if members.count_ones() > self.few {
                let mut found = *hits;
                self.trace(&rays.only(members), members, Class::of(&ray), &mut found);
                lanes(members).for_each(|lane| hits.set(lane, found.hit(lane)));
            } else {
                lanes(members).for_each(|lane| hits.set(lane, self.single(&rays.ray(lane))));
            }
        }
    }
}
