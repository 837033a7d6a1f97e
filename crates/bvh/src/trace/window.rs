//! Windows: so many rays of a stream as are looked at together, and the packets that they make.

use std::ops::Range;

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::class::{Class, axes};
use crate::layout::packet::Packet;
use crate::layout::ray_packet::{HitPacket, RayPacket};
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::answers::{Answers, WINDOW};
use crate::trace::counting_sort::Sorted;
use crate::trace::goal::Goal;
use crate::trace::packet::PacketKernel;

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

/// Rays that are traced in the same way.
pub(crate) enum Run {
    /// A window of rays that make good packets.
    Coherent(Range<usize>),
    /// As many windows of other rays as follow each other, since the last rays of a run are few in flight.
    Incoherent(Range<usize>),
}

/// The window that starts at a ray.
#[inline(always)]
fn window(rays: &[Ray], start: usize) -> Range<usize> {
    start..rays.len().min(start + WINDOW)
}

/// The runs of a stream, in their order.
#[inline(always)]
pub(crate) fn runs(rays: &[Ray]) -> impl Iterator<Item = Run> {
    let window = move |start: usize| window(rays, start);
    let is_incoherent =
        move |start: usize| start < rays.len() && !is_coherent(&rays[window(start)]);
    let mut next = 0;
    std::iter::from_fn(move || {
        let start = next;
        while is_incoherent(next) {
            next = window(next).end;
        }
        if next > start {
            return Some(Run::Incoherent(start..next));
        }
        next = window(start).end;
        (next > start).then_some(Run::Coherent(start..next))
    })
}

impl<S, const N: usize, const P: usize, Pr, F, B, T, G> PacketKernel<'_, S, N, P, Pr, F, B, T, G>
where
    Pr: Precision,
    F: HitFilter,
    B: Boxes<N>,
    T: Packet<P>,
    G: Goal,
{
    /// Traces any number of rays, a window after the other.
    #[inline(always)]
    pub(crate) fn windows<const R: usize>(
        &self,
        rays: &[Ray],
        answers: &mut (impl Answers + ?Sized),
    ) where
        S: Width<N> + Width<P> + Width<R>,
    {
        for start in (0..rays.len()).step_by(WINDOW) {
            let window = window(rays, start);
            answers.together(
                window.clone(),
                #[inline(always)]
                |hits| self.window::<R>(&rays[window], hits),
            );
        }
    }

    /// Traces at most [`WINDOW`] rays.
    #[inline(always)]
    fn window<const R: usize>(&self, rays: &[Ray], hits: &mut [Hit])
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        if is_coherent(rays) {
            self.neighbours::<R>(rays, hits);
        } else {
            self.sort::<R>(rays, hits);
        }
    }

    /// Traces packets of neighbours as they come.
    #[inline(always)]
    pub(crate) fn neighbours<const R: usize>(&self, rays: &[Ray], hits: &mut [Hit])
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        const { assert!(R <= 32) };
        for (rays, hits) in rays.chunks(R).zip(hits.chunks_mut(R)) {
            let members = &IN_ORDER[..rays.len()];
            let packet = match rays.as_array::<R>() {
                Some(rays) => RayPacket::of(self.simd, rays),
                None => RayPacket::<R>::gather(rays, members),
            };
            match packet.class(self.simd) {
                Some(class) => self.members(&packet, members, class, hits),
                None => self.sort::<R>(rays, hits),
            }
        }
    }

    /// Traces the first rays of a packet, whose places in the window are `members`. All are of one class.
    #[inline(always)]
    fn members<const R: usize>(
        &self,
        packet: &RayPacket<R>,
        members: &[u16],
        class: Class,
        hits: &mut [Hit],
    ) where
        S: Width<N> + Width<P> + Width<R>,
    {
        let mut found = HitPacket::misses(packet);
        let active = u32::MAX >> (32 - members.len());
        self.trace(packet, active, class, &mut found);
        for (lane, &member) in members.iter().enumerate() {
            hits[member as usize] = found.hit(lane);
        }
    }

    /// Sorts at most [`WINDOW`] rays by class, keeping their order in each, and traces packets of
    /// neighbours.
    #[inline(always)]
    fn sort<const R: usize>(&self, rays: &[Ray], hits: &mut [Hit])
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        let Sorted { order, ends } =
            Sorted::<WINDOW, { Class::INVALID + 1 }>::by_key(rays, Class::index);
        let mut start = 0;
        for &end in &ends[..Class::INVALID] {
            for members in order[start as usize..end as usize].chunks(R) {
                if members.len() as u32 > self.few {
                    let class = Class::of(&rays[members[0] as usize]);
                    let packet = RayPacket::<R>::gather(rays, members);
                    self.members(&packet, members, class, hits);
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
