//! The least, or the greatest, lane of each of four vectors: together they take half as many operations as one after the other.

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f32x4, f32x8, f32x16};

macro_rules! reductions {
    ($module:ident, $better:ident) => {
        pub(crate) mod $module {
            use super::*;

            /// Of the lanes of four vectors: after two steps each is every fourth lane of one.
            macro_rules! woven {
                ($four:expr) => {{
                    let [a, b, c, d] = $four;
                    let ac = a.zip_low(c).$better(a.zip_high(c));
                    let bd = b.zip_low(d).$better(b.zip_high(d));
                    ac.zip_low(bd).$better(ac.zip_high(bd))
                }};
            }

            #[inline(always)]
            pub(crate) fn of_4<S: Simd>(_: S, four: [f32x4<S>; 4]) -> [f32; 4] {
                woven!(four).into()
            }

            #[inline(always)]
            pub(crate) fn of_8<S: Simd>(simd: S, four: [f32x8<S>; 4]) -> [f32; 4] {
                let (low, high) = simd.split_f32x8(woven!(four));
                low.$better(high).into()
            }

            #[inline(always)]
            pub(crate) fn of_16<S: Simd>(simd: S, four: [f32x16<S>; 4]) -> [f32; 4] {
                let (low, high) = simd.split_f32x16(woven!(four));
                let (low, high) = simd.split_f32x8(low.$better(high));
                low.$better(high).into()
            }
        }
    };
}

reductions!(least, min);
reductions!(greatest, max);
