//! The packet kernel: `R` rays together, against one box or one triangle at once; and the hybrid
//! one, which goes on with single rays where few of a packet's rays agree.
//!
//! A packet's rays have their octant and their order of axes in common, so that which planes are
//! entered and which axes are sheared is known for all: `stream.rs` sorts them so. At a node, the
//! envelope of the packet is tested against all `N` boxes as a single ray would be; then the rays
//! against each box that it touches.

use std::mem::MaybeUninit;

use crate::filter::{Culling, HitFilter, improve};
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::child::Child;
use crate::layout::class::Class;
use crate::layout::columns::{Columns, greatest};
use crate::layout::triangle_packet::SINGLE_SIDED;
use crate::layout::validate::MAX_DEPTH;
use crate::precision::ending::Early;
use crate::precision::triangle::{LaneHits, OneTriangle, Shear};
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::{Stored, Width};
use crate::trace::goal::Goal;
use crate::trace::prefetch::prefetch_child;
use crate::trace::single::{query, search};
use crate::trace::slab::Slab;

/// What stays the same for all packets of a stream.
pub(crate) struct PacketKernel<'a, S, const N: usize, const P: usize, Pr, F, B, G> {
    pub(crate) simd: S,
    pub(crate) precision: Pr,
    pub(crate) bvh: BvhView<'a, N, P, B>,
    pub(crate) filter: &'a F,
    pub(crate) goal: G,
    /// So many rays of a packet, or fewer, are traced as single rays.
    pub(crate) few: u32,
}

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

impl<S, const N: usize, const P: usize, Pr, F, B, G> PacketKernel<'_, S, N, P, Pr, F, B, G>
where
    Pr: Precision,
    F: HitFilter,
    B: Boxes<N>,
    G: Goal,
{
    /// Traces one ray alone.
    #[inline(always)]
    pub(crate) fn single(&self, ray: &Ray) -> Hit
    where
        S: Width<N> + Width<P>,
    {
        query(
            self.simd,
            self.precision,
            self.bvh,
            ray,
            self.filter,
            self.goal,
        )
    }

    /// Traces at most `R` rays of one class, whose indices are `members` and which `columns` hold.
    #[inline(always)]
    pub(crate) fn trace<const R: usize>(
        &self,
        mut columns: Columns<R>,
        rays: &[Ray],
        members: &[u16],
        class: Class,
        hits: &mut [Hit],
    ) where
        S: Width<N> + Width<P> + Width<R>,
    {
        let simd = self.simd;
        columns.clip(members.len());
        let envelope = Slab::<S, N>::enclosing(simd, &columns, class.octant);
        let slab = Slab::<S, R>::of_rays(simd, &columns, class.octant);
        let shear = Shear::<S, R>::of_rays(simd, &columns, rays, members, class.axes);

        let mut best = Best::new(&columns);
        let mut farthest = greatest(best.t);
        let mut alive = u32::MAX >> (32 - members.len());
        let mut stack = [const { MaybeUninit::<Entry>::uninit() }; STACK_CAPACITY];
        let mut len = 0;
        let mut child = Child::ROOT;
        let mut active = alive;
        loop {
            if active.count_ones() <= self.few {
                for lane in lanes(active) {
                    // SAFETY: this is the root or a child of one of the hierarchy's nodes.
                    let hit = unsafe {
                        search(
                            simd,
                            self.precision,
                            self.bvh,
                            child,
                            &rays[members[lane] as usize],
                            columns.tmin[lane],
                            self.filter,
                            self.goal,
                            best.hit(lane),
                        )
                    };
                    best.set(lane, &hit, self.goal);
                }
                farthest = greatest(best.t);
            } else if child.is_leaf() {
                if self.leaf(child, &shear, &mut best) {
                    farthest = greatest(best.t);
                }
            } else {
                // SAFETY: children that are not leaves index the nodes of a sound hierarchy.
                let node = unsafe { self.bvh.nodes().get_unchecked(child.0 as usize) };
                let (mut touched, entry) = envelope.touched_children(simd, node, farthest);
                let Stored(distances) = Stored::<N>::of(simd, entry);
                let base = len;
                while touched != 0 {
                    // The last first: pushed in reverse, children come in their order.
                    let slot = (31 - touched.leading_zeros()) as usize % N;
                    touched &= !(1 << slot);
                    let touching = active & slab.touching_rays(simd, node, slot, &best.t);
                    if touching == 0 {
                        continue;
                    }
                    let child = Child(node.children()[slot]);
                    prefetch_child(self.bvh.nodes(), self.bvh.packets(), child);
                    let entry = Entry {
                        distance: distances[slot],
                        child,
                        rays: touching,
                    };
                    // Insertion, nearest on top; where any hit will do, the order is the builder's.
                    let mut index = len;
                    while !G::ANY && index > base {
                        // SAFETY: entries below `len` are initialised.
                        let other = unsafe { stack[index - 1].assume_init() };
                        if other.distance >= entry.distance {
                            break;
                        }
                        stack[index].write(other);
                        index -= 1;
                    }
                    stack[index].write(entry);
                    len += 1;
                }
            }
            if G::ANY {
                alive = 0;
                for (lane, &tmax) in best.t.iter().enumerate() {
                    alive |= u32::from(tmax >= 0.0) << lane;
                }
            }
            let next = loop {
                if len == 0 {
                    break None;
                }
                len -= 1;
                // SAFETY: this was below `len` until now.
                let entry = unsafe { stack[len].assume_init() };
                if entry.rays & alive != 0 && entry.distance <= farthest {
                    break Some(entry);
                }
            };
            match next {
                Some(entry) => (child, active) = (entry.child, entry.rays & alive),
                None => break,
            }
        }
        for (lane, &member) in members.iter().enumerate() {
            let hit = best.hit(lane);
            hits[member as usize] = if hit.is_hit() {
                hit
            } else {
                Hit::miss(rays[member as usize].tmax)
            };
        }
    }

    /// Tests the leaf's triangles. Returns whether there were hits.
    #[inline(always)]
    fn leaf<const R: usize>(&self, leaf: Child, shear: &Shear<'_, S, R>, best: &mut Best<R>) -> bool
    where
        S: Width<R>,
    {
        let simd = self.simd;
        let mut found = false;
        let first = leaf.first_packet();
        for packet in &self.bvh.packets()[first..first + leaf.packet_count()] {
            for lane in 0..P {
                let prim = packet.prim_ids[lane];
                if prim == u32::MAX {
                    break;
                }
                let triangle = OneTriangle { packet, lane };
                let ends = simd.load(&best.t);
                let test = self
                    .precision
                    .test(simd, shear, triangle, ends, F::CULLING, Early);
                let Some(mut test) = test else { continue };
                // Rays that are strictly nearer need no second look, unless there is a filter.
                if !F::REJECTS && !matches!(F::CULLING, Culling::PerTriangle) {
                    let nearer = test.lanes & simd.bits(simd.lt(test.t, ends));
                    best.improve(simd, &test, nearer, prim & !SINGLE_SIDED, self.goal);
                    test.lanes &= !nearer;
                    found |= nearer != 0;
                }
                if test.lanes == 0 {
                    continue;
                }
                let [Stored(t), Stored(u), Stored(v)] = test.store(simd);
                for lane in lanes(test.lanes) {
                    let hit = Hit {
                        t: t[lane],
                        u: u[lane],
                        v: v[lane],
                        prim,
                    };
                    let back = test.back >> lane & 1 == 1;
                    let mut improved = best.hit(lane);
                    if improve(&mut improved, hit, back, shear.ray(lane), self.filter) {
                        best.set(lane, &improved, self.goal);
                        found = true;
                    }
                }
            }
        }
        found
    }
}

/// The rays' hits so far.
#[repr(align(64))]
struct Best<const R: usize> {
    /// Where the interval ends: at the hit, or where any will do, before it begins. So it does in
    /// lanes left over.
    t: [f32; R],
    u: [f32; R],
    v: [f32; R],
    /// The bits of triangle indices.
    prim: [f32; R],
}

impl<const R: usize> Best<R> {
    #[inline(always)]
    fn new(columns: &Columns<R>) -> Best<R> {
        Best {
            t: columns.tmax,
            u: [0.0; R],
            v: [0.0; R],
            prim: [f32::from_bits(Hit::NONE); R],
        }
    }

    #[inline(always)]
    fn hit(&self, lane: usize) -> Hit {
        Hit {
            t: self.t[lane],
            u: self.u[lane],
            v: self.v[lane],
            prim: self.prim[lane].to_bits(),
        }
    }

    #[inline(always)]
    fn set<G: Goal>(&mut self, lane: usize, hit: &Hit, _: G) {
        self.t[lane] = if G::ANY && hit.is_hit() { -1.0 } else { hit.t };
        self.u[lane] = hit.u;
        self.v[lane] = hit.v;
        self.prim[lane] = f32::from_bits(hit.prim);
    }

    /// Takes the hits of some lanes with one triangle.
    #[inline(always)]
    fn improve<S: Width<R>, G: Goal>(
        &mut self,
        simd: S,
        hits: &LaneHits<S, R>,
        lanes: u32,
        prim: u32,
        _: G,
    ) {
        let replace = |column: &mut [f32; R], new: S::Float| {
            simd.store(simd.select(lanes, new, simd.load(column)), column);
        };
        replace(&mut self.prim, simd.splat(f32::from_bits(prim)));
        if G::ANY {
            replace(&mut self.t, simd.splat(-1.0));
        } else {
            replace(&mut self.t, hits.t);
            replace(&mut self.u, hits.u);
            replace(&mut self.v, hits.v);
        }
    }
}

/// The indices of the bits that are set.
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
