//! The exhaustive kernel: sixteen rays at once against one triangle after the other, without a hierarchy.
//!
//! Where triangles are a few dozen, a walk costs more than the tests it saves. Rays are sorted by the order of
//! their axes, each vertex is sheared once for sixteen of them, and what is left of most triangles is their three
//! edges. It takes 0.5 to 0.6 of a walk's time for 24 to 36 triangles, and as much for 110.
//!
//! Measured and rejected: as many lanes as a node has children (eight: 1.3 of the time that sixteen take, with
//! AVX2, too); rays sorted by the signs of all components of their directions.

use crate::filter::HitFilter;
use crate::layout::class::{AXES, Axes, axes_index};
use crate::layout::ray_packet::{HitPacket, Intervals, RayPacket};
use crate::precision::shearing::Shearing;
use crate::precision::triangle::{Shear, Triangles};
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::simd::Width;
use crate::trace::best_hits::BestHits;
use crate::trace::counting_sort::Sorted;
use crate::trace::goal::Goal;
use crate::trace::triangle_table::{Indexed, MOST_TRIANGLES, MOST_VERTICES, TriangleTable};

/// Rays that are sorted together: so many that few lanes are left over.
const WINDOW: usize = 1024;
/// Rays that are tested together.
const LANES: usize = 16;

/// What stays the same for all rays of a stream.
pub(crate) struct ExhaustiveKernel<'a, S, Pr, F, G> {
    pub(crate) simd: S,
    pub(crate) precision: Pr,
    pub(crate) table: &'a TriangleTable,
    pub(crate) filter: &'a F,
    pub(crate) goal: G,
}

impl<S, Pr: Precision, F: HitFilter, G: Goal> ExhaustiveKernel<'_, S, Pr, F, G> {
    /// Finds the hit of each ray; `answer` gets its index and the hit, in whatever order.
    #[inline(always)]
    pub(crate) fn trace(&self, rays: &[Ray], mut answer: impl FnMut(usize, Hit))
    where
        S: Width<LANES>,
    {
        let mut sheared = [[self.simd.splat(0.0); 3]; MOST_VERTICES];
        for (window, rays) in rays.chunks(WINDOW).enumerate() {
            let mut answer = |ray: usize, hit| answer(WINDOW * window + ray, hit);
            let Sorted { order, ends } =
                Sorted::<WINDOW, { AXES.len() + 1 }>::by_key(rays, |ray| {
                    if ray.is_valid() {
                        axes_index(ray)
                    } else {
                        AXES.len()
                    }
                });
            let mut start = 0;
            for (&axes, &end) in AXES.iter().zip(&ends) {
                let end = usize::from(end);
                for members in order[start..end].chunks(LANES) {
                    self.lanes(rays, members, axes, &mut sheared, &mut answer);
                }
                start = end;
            }
            for &ray in &order[start..rays.len()] {
                let ray = usize::from(ray);
                answer(ray, Hit::miss(rays[ray].tmax));
            }
        }
    }

    /// Traces at most sixteen rays with these axes, whose indices are `members`.
    #[inline(always)]
    fn lanes(
        &self,
        rays: &[Ray],
        members: &[u16],
        axes: Axes,
        sheared: &mut [[S::Float; 3]; MOST_VERTICES],
        mut answer: impl FnMut(usize, Hit),
    ) where
        S: Width<LANES>,
    {
        let Self {
            simd,
            precision,
            table,
            ..
        } = *self;
        let rays = RayPacket::<LANES>::gather(rays, members);
        let Intervals { tmin, tmax } = rays.intervals(u32::MAX >> (32 - members.len()));
        let shear = Shear::<S, LANES>::of_packet(simd, &rays, &tmin, axes);
        for (sheared, vertex) in sheared.iter_mut().zip(table.vertices()) {
            *sheared = shear.sheared::<Pr::Shearing>(
                simd,
                #[inline(always)]
                |axis| simd.splat(vertex[axis % 3]),
            );
        }

        // First the triangles that some ray may hit, without a branch that may be mispredicted.
        let mut candidates = [0u8; MOST_TRIANGLES];
        let mut count = 0;
        for (index, triangle) in table.triangles().iter().enumerate() {
            let triangle = Sheared::<S>::new(table, triangle, sheared);
            let lanes = precision.candidates(simd, &shear, triangle, F::CULLING);
            candidates[count % MOST_TRIANGLES] = index as u8;
            count += usize::from(lanes != 0);
        }
        let mut best = BestHits::none(tmax);
        for &candidate in &candidates[..count] {
            let triangle = &table.triangles()[usize::from(candidate)];
            let found = best.improve(
                simd,
                precision,
                &shear,
                Sheared::<S>::new(table, triangle, sheared),
                triangle.prim,
                self.filter,
                self.goal,
            );
            if G::ANY && found && best.farthest(simd) < 0.0 {
                break;
            }
        }
        let mut hits = HitPacket::misses(&rays);
        best.finish(&rays, &mut hits);
        for (lane, &member) in members.iter().enumerate() {
            answer(usize::from(member), hits.hit(lane));
        }
    }
}

/// A triangle of the table in every lane, whose vertices have been sheared.
struct Sheared<'a, S: Width<LANES>> {
    table: &'a TriangleTable,
    sheared: &'a [[S::Float; 3]; MOST_VERTICES],
    corners: [usize; 3],
}

impl<'a, S: Width<LANES>> Sheared<'a, S> {
    #[inline(always)]
    fn new(
        table: &'a TriangleTable,
        triangle: &Indexed,
        sheared: &'a [[S::Float; 3]; MOST_VERTICES],
    ) -> Self {
        Sheared {
            table,
            sheared,
            corners: triangle.corners.map(usize::from),
        }
    }
}

impl<S: Width<LANES>> Triangles<S, LANES> for Sheared<'_, S> {
    #[inline(always)]
    fn used(&self, _: S) -> u32 {
        u32::MAX
    }

    #[inline(always)]
    fn corners(&self, _: usize) -> [[f32; 3]; 3] {
        self.corners.map(|vertex| self.table.vertices()[vertex])
    }

    #[inline(always)]
    fn sheared<K: Shearing>(&self, _: S, _: &Shear<'_, S, LANES>) -> [[S::Float; 3]; 3] {
        self.corners.map(|vertex| self.sheared[vertex])
    }
}
