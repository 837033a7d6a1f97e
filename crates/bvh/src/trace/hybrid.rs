//! The hybrid kernel: the runs of a stream, each traced in the way that suits its rays and the hierarchy.

use std::cell::LazyCell;

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::packet::Packet;
use crate::precision::triangle_test::Precision;
use crate::ray::Ray;
use crate::simd::{Width, apart};
use crate::trace::answers::Answers;
use crate::trace::exhaustive::ExhaustiveKernel;
use crate::trace::goal::Goal;
use crate::trace::packet::PacketKernel;
use crate::trace::phased::PhasedKernel;
use crate::trace::triangle_table::TriangleTable;
use crate::trace::window::{Run, runs};

/// So few nodes stay in the nearest cache, where rays wait for nothing: one after the other takes 0.9 times as long for 36
/// triangles as many in flight.
const FEW_NODES: usize = 16;
/// In a stream of fewer rays the table of all triangles costs more than it saves.
const ENOUGH_RAYS: usize = 512;

/// What stays the same for all rays of a stream.
pub(crate) struct HybridKernel<'a, S, const N: usize, const P: usize, Pr, F, B, T, G> {
    pub(crate) simd: S,
    pub(crate) precision: Pr,
    pub(crate) bvh: BvhView<'a, N, P, B, T>,
    pub(crate) filter: &'a F,
    pub(crate) goal: G,
}

impl<S, const N: usize, const P: usize, Pr, F, B, T, G> HybridKernel<'_, S, N, P, Pr, F, B, T, G>
where
    Pr: Precision,
    F: HitFilter,
    B: Boxes<N>,
    T: Packet<P>,
    G: Goal,
{
    /// Answers each ray.
    #[inline(always)]
    pub(crate) fn trace<const R: usize>(&self, rays: &[Ray], answers: &mut (impl Answers + ?Sized))
    where
        S: Width<N> + Width<P> + Width<R>,
    {
        let Self {
            simd,
            precision,
            bvh,
            filter,
            goal,
        } = *self;
        let packets = PacketKernel::hybrid::<R>(simd, precision, bvh, filter, goal);
        let phased = PhasedKernel {
            simd,
            precision,
            bvh,
            filter,
            goal,
        };
        let table = LazyCell::new(|| {
            let are_enough = rays.len() >= ENOUGH_RAYS;
            are_enough
                .then(|| TriangleTable::of(bvh.packets()))
                .flatten()
        });
        for run in runs(rays) {
            match run {
                Run::Coherent(window) => {
                    answers.together(
                        window.clone(),
                        #[inline(always)]
                        |hits| {
                            packets.neighbours::<R>(&rays[window], hits);
                        },
                    );
                }
                Run::Incoherent(run) if let Some(table) = &*table => {
                    let kernel = ExhaustiveKernel {
                        simd,
                        precision,
                        table,
                        filter,
                        goal,
                    };
                    let start = run.start;
                    apart(
                        simd,
                        #[inline(always)]
                        || kernel.trace(&rays[run], |ray, hit| answers.one(start + ray, hit)),
                    );
                }
                Run::Incoherent(run) if bvh.nodes().len() <= FEW_NODES => {
                    for index in run {
                        answers.one(index, packets.single(&rays[index]));
                    }
                }
                Run::Incoherent(run) => {
                    let start = run.start;
                    phased.trace(&rays[run], |ray, hit| answers.one(start + ray, hit));
                }
            }
        }
    }
}
