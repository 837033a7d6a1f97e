//! What a precision is: a test of rays against triangles.

use crate::filter::Culling;
use crate::simd::Width;

/// How exactly triangles are tested: [`Fast`](crate::Fast), [`Watertight`](crate::Watertight) or
/// [`Exact`](crate::Exact). The same hierarchy serves all.
pub trait Precision: sealed::Test {}

pub(crate) mod sealed {
    use crate::filter::Culling;
    use crate::layout::packet::Packet;
    use crate::precision::ending::Ending;
    use crate::precision::shear_bounds::ShearBounds;
    use crate::precision::shearing::Shearing;
    use crate::precision::triangle::{LaneHits, Shear, Triangles};
    use crate::simd::Width;

    /// The test itself.
    pub trait Test: Copy + Default + Send + Sync + 'static {
        /// How it shears corners.
        #[doc(hidden)]
        type Shearing: Shearing;

        /// The lanes whose ray may meet its triangle at some distance, as bits: no hit is in any other.
        #[doc(hidden)]
        fn candidates<S: Width<W>, const W: usize>(
            self,
            simd: S,
            rays: &Shear<'_, S, W>,
            triangles: impl Triangles<S, W>,
            culling: Culling,
        ) -> u32;

        /// The lanes whose triangle may meet any of some rays, as bits: for packets whose coordinates are far from
        /// overflow.
        #[doc(hidden)]
        fn candidates_of_rays<S: Width<W>, const W: usize>(
            self,
            simd: S,
            rays: &ShearBounds<S, W>,
            packet: &impl Packet<W>,
            culling: Culling,
        ) -> u32;

        /// The lanes whose ray meets its triangle at a distance in `[tmin, tmax]`, from the sides
        /// that `culling` leaves; if none is inside, `None` or no lanes, as `ending` says. (Marks of single triangles are the caller's business: see
        /// [`LaneHits::back`].)
        #[doc(hidden)]
        fn test<S: Width<W>, const W: usize, E: Ending>(
            self,
            simd: S,
            rays: &Shear<'_, S, W>,
            triangles: impl Triangles<S, W>,
            tmax: S::Float,
            culling: Culling,
            ending: E,
        ) -> Option<LaneHits<S, W>>;
    }
}

/// Lanes whose ray passes inside their triangle, as bits.
pub(crate) struct Inside {
    /// On the sides of interest.
    pub(crate) lanes: u32,
    /// From behind; meaningful in those lanes.
    pub(crate) back: u32,
}

impl Inside {
    /// Only in these lanes.
    #[inline(always)]
    pub(crate) fn among(self, lanes: u32) -> Inside {
        Inside {
            lanes: self.lanes & lanes,
            back: self.back,
        }
    }
}

/// Inside a triangle the three weights have the same sign, or are zero; in front it is positive.
/// Of NaN, from coordinates whose products overflow, nothing is said.
#[inline(always)]
pub(crate) fn sides<S: Width<W>, const W: usize>(
    simd: S,
    [w, u, v]: [S::Float; 3],
    culling: Culling,
) -> Inside {
    let zero = simd.splat(0.0);
    let least = simd.min_number(simd.min_number(w, u), v);
    let front = simd.bits(simd.le(zero, least));
    let back = match culling {
        Culling::Back => 0,
        Culling::None | Culling::PerTriangle => {
            let greatest = simd.max_number(simd.max_number(w, u), v);
            simd.bits(simd.le(greatest, zero))
        }
    };
    Inside {
        lanes: front | back,
        back: back & !front,
    }
}
