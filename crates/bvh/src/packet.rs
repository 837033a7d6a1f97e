//! The packet kernel: `R` rays together, against one box or one triangle at once; and the hybrid
//! one, which goes on with single rays where few of a packet's rays agree.
//!
//! A packet's rays have their octant and their order of axes in common, so that which planes are
//! entered and which axes are sheared is known for all: `stream.rs` sorts them so. At a node, the
//! envelope of the packet is tested against all `N` boxes as a single ray would be; then the rays
//! against each box that it touches.

use std::mem::MaybeUninit;

use crate::bvh::{Child, MAX_DEPTH};
use crate::columns::{Columns, greatest};
use crate::filter::improve;
use crate::single::search;
use crate::slab::Slab;
use crate::stream::Class;
use crate::triangle::{OneTriangle, Shear};
use crate::{BvhView, Hit, HitFilter, Lanes, Precision, Ray};

/// What stays the same for all packets of a stream.
pub(crate) struct PacketKernel<'a, S, const N: usize, const P: usize, Pr, F> {
    pub(crate) simd: S,
    pub(crate) precision: Pr,
    pub(crate) bvh: BvhView<'a, N, P>,
    pub(crate) filter: &'a F,
    /// So many rays of a packet, or fewer, are traced as single rays.
    pub(crate) few: u32,
}

/// Rays whose slopes differ by more than this are not worth a packet.
const SPREAD: f32 = 0.25;

/// A subtree yet to visit.
#[derive(Clone, Copy)]
struct Entry {
    /// Where the packet's envelope enters it.
    distance: f32,
    child: Child,
    /// The rays that touch it.
    rays: u32,
}

/// As in `stack.rs`: each level leaves at most N - 1 siblings behind.
const STACK_CAPACITY: usize = MAX_DEPTH * 16;

impl<S, const N: usize, const P: usize, Pr: Precision, F: HitFilter>
    PacketKernel<'_, S, N, P, Pr, F>
{
    /// Traces at most `R` rays of one class, which `members` number: improves their hits.
    #[inline(always)]
    pub(crate) fn trace<const R: usize, const ANY: bool>(
        &self,
        rays: &[Ray],
        members: &[u16],
        class: Class,
        hits: &mut [Hit],
    ) where
        S: Lanes<N> + Lanes<P> + Lanes<R>,
    {
        if members.len() as u32 <= self.few {
            for &member in members {
                self.single::<ANY>(Child::ROOT, rays, member, hits);
            }
            return;
        }
        let simd = self.simd;
        let columns = Columns::<R>::gather(rays, members);
        if self.few > 0 && columns.spread(class.axes) > SPREAD {
            for &member in members {
                self.single::<ANY>(Child::ROOT, rays, member, hits);
            }
            return;
        }
        let envelope = Slab::<S, N>::enclosing(simd, &columns, class.octant);
        let slab = Slab::<S, R>::of_rays(simd, &columns, class.octant);
        let shear = Shear::<S, R>::of_rays(simd, &columns, rays, members, class.axes);

        // Lanes left over find nothing: their interval ends before it begins.
        let mut tmax = columns.tmax;
        let mut farthest = greatest(tmax);
        let mut alive = u32::MAX >> (32 - members.len());
        let mut stack = [const { MaybeUninit::<Entry>::uninit() }; STACK_CAPACITY];
        let mut len = 0;
        let mut child = Child::ROOT;
        let mut active = alive;
        loop {
            if active.count_ones() <= self.few {
                for lane in lanes(active) {
                    let hit = self.single::<ANY>(child, rays, members[lane], hits);
                    tmax[lane] = if ANY && hit.is_hit() { -1.0 } else { hit.t };
                }
                farthest = greatest(tmax);
            } else if child.is_leaf() {
                if self.leaf::<R, ANY>(child, &shear, rays, members, &mut tmax, hits) {
                    farthest = greatest(tmax);
                }
            } else {
                // SAFETY: children that are not leaves index the nodes of a sound hierarchy.
                let node = unsafe { self.bvh.nodes().get_unchecked(child.0 as usize) };
                let (mut touched, entry) = envelope.touched_children(simd, node, farthest);
                let mut distances = [0.0f32; N];
                simd.store(entry, &mut distances);
                let base = len;
                while touched != 0 {
                    // The last first: pushed in reverse, children come in their order.
                    let slot = (31 - touched.leading_zeros()) as usize % N;
                    touched &= !(1 << slot);
                    let touching = active & slab.touching_rays(simd, node, slot, &tmax);
                    if touching == 0 {
                        continue;
                    }
                    let entry = Entry {
                        distance: distances[slot],
                        child: Child(node.children[slot]),
                        rays: touching,
                    };
                    // Insertion, nearest on top; where any hit will do, the order is the builder's.
                    let mut place = len;
                    while !ANY && place > base {
                        // SAFETY: entries below `len` are initialised.
                        let other = unsafe { stack[place - 1].assume_init() };
                        if other.distance >= entry.distance {
                            break;
                        }
                        stack[place].write(other);
                        place -= 1;
                    }
                    stack[place].write(entry);
                    len += 1;
                }
            }
            if ANY {
                alive = 0;
                for (lane, &tmax) in tmax.iter().enumerate() {
                    alive |= u32::from(tmax >= 0.0) << lane;
                }
            }
            loop {
                if len == 0 {
                    return;
                }
                len -= 1;
                // SAFETY: this was below `len` until now.
                let entry = unsafe { stack[len].assume_init() };
                if entry.rays & alive != 0 && entry.distance <= farthest {
                    (child, active) = (entry.child, entry.rays & alive);
                    break;
                }
            }
        }
    }

    /// Traces one ray alone.
    #[inline(always)]
    fn single<const ANY: bool>(
        &self,
        start: Child,
        rays: &[Ray],
        member: u16,
        hits: &mut [Hit],
    ) -> Hit
    where
        S: Lanes<N> + Lanes<P>,
    {
        let (ray, hit) = (&rays[member as usize], &mut hits[member as usize]);
        // SAFETY: the start is the root or a child of one of the hierarchy's nodes.
        *hit = unsafe {
            search::<S, N, P, Pr, F, ANY>(
                self.simd,
                self.precision,
                self.bvh,
                start,
                ray,
                ray.interval().0,
                self.filter,
                *hit,
            )
        };
        *hit
    }

    /// Tests the leaf's triangles. Returns whether there were hits; where any will do, the
    /// interval of those that found one ends.
    #[inline(always)]
    fn leaf<const R: usize, const ANY: bool>(
        &self,
        leaf: Child,
        shear: &Shear<'_, S, R>,
        rays: &[Ray],
        members: &[u16],
        tmax: &mut [f32; R],
        hits: &mut [Hit],
    ) -> bool
    where
        S: Lanes<R>,
    {
        let simd = self.simd;
        let mut found = false;
        let first = leaf.first_packet();
        for packet in &self.bvh.packets()[first..first + leaf.packet_count()] {
            for lane in 0..P {
                if packet.prim_ids[lane] == u32::MAX {
                    break;
                }
                let triangle = OneTriangle { packet, lane };
                let ends = simd.load(tmax);
                let test = self.precision.test(simd, shear, triangle, ends, F::CULLING);
                let Some(test) = test else { continue };
                let (t, u, v) = test.store(simd);
                for ray in lanes(test.lanes) {
                    let hit = Hit {
                        t: t[ray],
                        u: u[ray],
                        v: v[ray],
                        prim: packet.prim_ids[lane],
                    };
                    let back = test.back >> ray & 1 == 1;
                    let member = members[ray] as usize;
                    if improve(&mut hits[member], hit, back, &rays[member], self.filter) {
                        found = true;
                        tmax[ray] = if ANY { -1.0 } else { hit.t };
                    }
                }
            }
        }
        found
    }
}

/// The numbers of the bits that are set.
#[inline(always)]
fn lanes(bits: u32) -> impl Iterator<Item = usize> {
    let mut rest = bits;
    std::iter::from_fn(
        #[inline(always)]
        move || {
            let lane = rest.trailing_zeros() as usize;
            rest &= rest.wrapping_sub(1);
            (lane < 32).then_some(lane)
        },
    )
}
