//! Kernels as functions of their own.

use fearless_simd::Simd;

use crate::filter::HitFilter;
use crate::layout::boxes::Boxes;
use crate::layout::bvh::BvhView;
use crate::layout::packet::Packet;
use crate::precision::triangle_test::Precision;
use crate::ray::{Hit, Ray};
use crate::trace::stream::Kernel;

/// A kernel that is a function of its own, compiled for its instruction set. Others are inlined into their caller, which is faster for a
/// few rays; a caller that chooses among several becomes a function for which compilers take minutes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Apart<K>(pub K);

impl<S: Simd, K: Kernel<S, N, P>, const N: usize, const P: usize> Kernel<S, N, P> for Apart<K> {
    #[inline(never)]
    fn closest_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        hits: &mut [Hit],
        filter: &impl HitFilter,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                self.0
                    .closest_hits(simd, precision, bvh, rays, hits, filter)
            },
        );
    }

    #[inline(never)]
    fn any_hits(
        self,
        simd: S,
        precision: impl Precision,
        bvh: BvhView<'_, N, P, impl Boxes<N>, impl Packet<P>>,
        rays: &[Ray],
        occluded: &mut [bool],
        filter: &impl HitFilter,
    ) {
        simd.vectorize(
            #[inline(always)]
            || {
                self.0
                    .any_hits(simd, precision, bvh, rays, occluded, filter)
            },
        );
    }
}
