//! The best hits so far of rays in lanes.

use crate::filter::{Culling, HitFilter, improve};
use crate::inlined::inlined;
use crate::layout::ray_packet::{HitPacket, RayPacket};
use crate::layout::triangle_packet::SINGLE_SIDED;
use crate::precision::ending::Early;
use crate::precision::triangle::{LaneHits, Shear, Triangles};
use crate::precision::triangle_test::Precision;
use crate::ray::Hit;
use crate::simd::{Stored, Width};
use crate::trace::goal::Goal;

/// The rays' hits so far.
#[repr(align(64))]
pub(crate) struct BestHits<const R: usize> {
    /// Where the interval ends: at the hit, or where any will do, before it begins. So it does in
    /// lanes left over.
    pub(crate) t: [f32; R],
    u: [f32; R],
    v: [f32; R],
    /// The bits of triangle indices.
    prim: [f32; R],
}

impl<const R: usize> BestHits<R> {
    /// None, of rays whose intervals end at `tmax`.
    #[inline(always)]
    pub(crate) fn none(tmax: [f32; R]) -> BestHits<R> {
        BestHits {
            t: tmax,
            u: [0.0; R],
            v: [0.0; R],
            prim: [f32::from_bits(Hit::NONE); R],
        }
    }

    /// Where the last of the intervals ends.
    #[inline(always)]
    pub(crate) fn farthest<S: Width<R>>(&self, simd: S) -> f32 {
        simd.greatest(simd.load(&self.t))
    }

    /// The hits of these rays, when there are no others to come.
    #[inline(always)]
    pub(crate) fn finish(&self, rays: &RayPacket<R>, hits: &mut HitPacket<R>) {
        for lane in 0..R {
            let prim = self.prim[lane].to_bits();
            let is_miss = prim == Hit::NONE;
            hits.t[lane] = if is_miss {
                rays.tmax[lane]
            } else {
                self.t[lane]
            };
            hits.u[lane] = self.u[lane];
            hits.v[lane] = self.v[lane];
            hits.prim[lane] = prim;
        }
    }

    #[inline(always)]
    pub(crate) fn hit(&self, lane: usize) -> Hit {
        Hit {
            t: self.t[lane],
            u: self.u[lane],
            v: self.v[lane],
            prim: self.prim[lane].to_bits(),
        }
    }

    #[inline(always)]
    pub(crate) fn set<G: Goal>(&mut self, lane: usize, hit: &Hit, _: G) {
        self.t[lane] = if G::ANY && hit.is_hit() { -1.0 } else { hit.t };
        self.u[lane] = hit.u;
        self.v[lane] = hit.v;
        self.prim[lane] = f32::from_bits(hit.prim);
    }

    /// Improves the rays' hits by one triangle, the same in all lanes, whose index is `prim`, still with its mark.
    /// Returns whether it did for any.
    #[inline(always)]
    pub(crate) fn improve<S: Width<R>, F: HitFilter>(
        &mut self,
        simd: S,
        precision: impl Precision,
        shear: &Shear<'_, S, R>,
        triangle: impl Triangles<S, R>,
        prim: u32,
        filter: &F,
        goal: impl Goal,
    ) -> bool {
        let ends = simd.load(&self.t);
        let test = precision.test(simd, shear, triangle, ends, F::CULLING, Early);
        let Some(mut test) = test else { return false };
        let mut found = false;
        // Rays that are strictly nearer need no second look, unless there is a filter.
        if !F::REJECTS && !matches!(F::CULLING, Culling::PerTriangle) {
            let nearer = test.lanes & simd.bits(simd.lt(test.t, ends));
            self.take(simd, &test, nearer, prim & !SINGLE_SIDED, goal);
            test.lanes &= !nearer;
            found = nearer != 0;
        }
        if test.lanes == 0 {
            return found;
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
            let mut improved = self.hit(lane);
            if improve(&mut improved, hit, back, &shear.ray(lane), filter) {
                self.set(lane, &improved, goal);
                found = true;
            }
        }
        found
    }

    /// Takes the hits of some lanes with one triangle.
    #[inline(always)]
    fn take<S: Width<R>, G: Goal>(
        &mut self,
        simd: S,
        hits: &LaneHits<S, R>,
        lanes: u32,
        prim: u32,
        _: G,
    ) {
        let replace = inlined(
            #[inline(always)]
            |column: &mut [f32; R], new: S::Float| {
                simd.store(simd.select(lanes, new, simd.load(column)), column);
            },
        );
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
pub(crate) fn lanes(bits: u32) -> impl Iterator<Item = usize> {
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
