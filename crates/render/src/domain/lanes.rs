//! `f32` in SIMD lanes: 4, 8 or 16 paths at once, on whatever instruction set the token stands for.

use fearless_simd::{
    Bytes, Select, Simd, SimdBase, SimdCombine, SimdCvtFloat, SimdCvtTruncate, SimdFloat, SimdMask,
    f32x4, f32x8, f32x16, mask32x4, mask32x8, mask32x16, u32x4, u32x8, u32x16,
};

use super::single::Uint;
use super::{Buffer, Buffers, Bundle, Domain, Scalar};

/// A domain whose numbers are moved to and from arrays: what a device that executes needs.
pub trait Lanes: Domain {
    /// How many numbers there are at once.
    const LANES: usize;
    /// `LANES` integers; `from` must be that long.
    fn word(self, from: &[u32]) -> Self::U;
    /// The mask's bits, lane 0 lowest.
    fn bits(self, mask: Self::M) -> u32;
    /// Stores `LANES` integers; `to` must be that long.
    fn store_word(self, value: Self::U, to: &mut [u32]);
    /// The four columns of `LANES` rows of four words: what a record for each lane holds.
    fn columns(self, row: impl Fn(usize) -> [u32; 4]) -> [Self::U; 4];
    /// The rows of four columns; only the first `LANES` mean anything.
    fn rows(self, columns: [Self::U; 4]) -> [[u32; 4]; MAX_LANES];
}

/// The most lanes that a domain has.
pub const MAX_LANES: usize = 16;

impl Lanes for Scalar<'_> {
    const LANES: usize = 1;
    #[inline(always)]
    fn word(self, from: &[u32]) -> Uint {
        Uint(from[0])
    }
    #[inline(always)]
    fn bits(self, mask: bool) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn store_word(self, value: Uint, to: &mut [u32]) {
        to[0] = value.0;
    }
    #[inline(always)]
    fn columns(self, row: impl Fn(usize) -> [u32; 4]) -> [Uint; 4] {
        let [x, y, z, w] = row(0);
        [Uint(x), Uint(y), Uint(z), Uint(w)]
    }
    #[inline(always)]
    fn rows(self, [x, y, z, w]: [Uint; 4]) -> [[u32; 4]; MAX_LANES] {
        [[x.0, y.0, z.0, w.0]; MAX_LANES]
    }
}

macro_rules! lanes {
    ($name:ident, $lanes:literal, $real:ident, $word:ident, $mask:ident, $transpose:ident) => {
        #[doc = concat!("The domain of ", $lanes, " `f32` lanes.")]
        #[derive(Clone, Copy, Debug)]
        pub struct $name<'a, S> {
            simd: S,
            buffers: &'a Buffers<'a>,
        }

        impl<'a, S: Simd> $name<'a, S> {
            /// A domain on the token's instruction set that reads these buffers.
            #[inline(always)]
            pub fn new(simd: S, buffers: &'a Buffers<'a>) -> Self {
                Self { simd, buffers }
            }
        }

        impl<S: Simd> Domain for $name<'_, S> {
            type F = $real<S>;
            type U = $word<S>;
            type M = $mask<S>;

            #[inline(always)]
            fn lit(self, value: f64) -> Self::F {
                $real::splat(self.simd, value as f32)
            }
            #[inline(always)]
            fn uint(self, value: u32) -> Self::U {
                $word::splat(self.simd, value)
            }
            #[inline(always)]
            fn truth(self, value: bool) -> Self::M {
                $mask::splat(self.simd, value)
            }
            #[inline(always)]
            fn sqrt(self, a: Self::F) -> Self::F {
                a.sqrt()
            }
            #[inline(always)]
            fn min(self, a: Self::F, b: Self::F) -> Self::F {
                a.min(b)
            }
            #[inline(always)]
            fn max(self, a: Self::F, b: Self::F) -> Self::F {
                a.max(b)
            }
            #[inline(always)]
            fn abs(self, a: Self::F) -> Self::F {
                a.abs()
            }
            #[inline(always)]
            fn floor(self, a: Self::F) -> Self::F {
                a.floor()
            }
            #[inline(always)]
            fn fma(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
                a.mul_add(b, c)
            }
            #[inline(always)]
            fn copysign(self, a: Self::F, b: Self::F) -> Self::F {
                a.copysign(b)
            }
            #[inline(always)]
            fn lt(self, a: Self::F, b: Self::F) -> Self::M {
                a.simd_lt(b)
            }
            #[inline(always)]
            fn le(self, a: Self::F, b: Self::F) -> Self::M {
                a.simd_le(b)
            }
            #[inline(always)]
            fn eq(self, a: Self::F, b: Self::F) -> Self::M {
                a.simd_eq(b)
            }
            #[inline(always)]
            fn eq_u(self, a: Self::U, b: Self::U) -> Self::M {
                a.simd_eq(b)
            }
            #[inline(always)]
            fn lt_u(self, a: Self::U, b: Self::U) -> Self::M {
                a.simd_lt(b)
            }
            #[inline(always)]
            fn select(self, mask: Self::M, a: Self::F, b: Self::F) -> Self::F {
                mask.select(a, b)
            }
            #[inline(always)]
            fn select_u(self, mask: Self::M, a: Self::U, b: Self::U) -> Self::U {
                mask.select(a, b)
            }
            #[inline(always)]
            fn to_uint(self, a: Self::F) -> Self::U {
                $word::truncate_from(a)
            }
            #[inline(always)]
            fn to_real(self, a: Self::U) -> Self::F {
                $real::float_from(a)
            }
            #[inline(always)]
            fn to_bits(self, a: Self::F) -> Self::U {
                a.bitcast()
            }
            #[inline(always)]
            fn from_bits(self, a: Self::U) -> Self::F {
                a.bitcast()
            }
            #[inline(always)]
            fn reverse_bits(self, a: Self::U) -> Self::U {
                // The compiler makes vector instructions of this: one or two where there are any for it.
                let mut words = [0; $lanes];
                for (word, a) in words.iter_mut().zip(a.as_slice()) {
                    *word = a.reverse_bits();
                }
                $word::load_array(self.simd, words)
            }
            #[inline(always)]
            fn load(self, buffer: Buffer, index: Self::U) -> Self::U {
                let mut words = [0; $lanes];
                for (word, &index) in words.iter_mut().zip(index.as_slice()) {
                    *word = self.buffers.word(buffer, index);
                }
                $word::load_array(self.simd, words)
            }
            #[inline(always)]
            fn load_rows<const N: usize>(
                self,
                buffer: Buffer,
                first: Self::U,
            ) -> [[Self::U; 4]; N] {
                let first = first.as_slice();
                let mut lanes = [self.buffers.rows::<N>(buffer, first[0]); $lanes];
                for (lane, &first) in lanes.iter_mut().zip(first).skip(1) {
                    *lane = self.buffers.rows(buffer, first);
                }
                let mut rows = [[self.uint(0); 4]; N];
                for (r, row) in rows.iter_mut().enumerate() {
                    let mut of_lanes = [u32x4::splat(self.simd, 0); $lanes];
                    for (of_lane, lane) in of_lanes.iter_mut().zip(lanes) {
                        *of_lane = u32x4::load_array(self.simd, lane[r]);
                    }
                    *row = $transpose(of_lanes);
                }
                rows
            }
            #[inline(always)]
            fn uniform(self, buffer: Buffer, index: u32) -> Self::U {
                $word::splat(self.simd, self.buffers.word(buffer, index))
            }
            #[inline(always)]
            fn branch<T: Bundle<Self>>(
                self,
                mask: Self::M,
                a: impl FnOnce() -> T,
                b: impl FnOnce() -> T,
            ) -> T {
                if mask.all_true() {
                    a()
                } else if mask.all_false() {
                    b()
                } else {
                    T::choose(self, mask, a(), b())
                }
            }
            #[inline(always)]
            fn holds_nowhere(self, mask: Self::M) -> bool {
                mask.all_false()
            }
            #[inline(always)]
            fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
                self.simd.vectorize(f)
            }
        }

        impl<S: Simd> Lanes for $name<'_, S> {
            const LANES: usize = $lanes;
            #[inline(always)]
            fn word(self, from: &[u32]) -> Self::U {
                $word::from_slice(self.simd, from)
            }
            #[inline(always)]
            fn bits(self, mask: Self::M) -> u32 {
                mask.to_bitmask() as u32
            }
            #[inline(always)]
            fn store_word(self, value: Self::U, to: &mut [u32]) {
                value.store_slice(to);
            }
            #[inline(always)]
            fn columns(self, row: impl Fn(usize) -> [u32; 4]) -> [Self::U; 4] {
                let mut rows = [u32x4::splat(self.simd, 0); $lanes];
                for (lane, of_lane) in rows.iter_mut().enumerate() {
                    *of_lane = u32x4::load_array(self.simd, row(lane));
                }
                $transpose(rows)
            }
            #[inline(always)]
            fn rows(self, columns: [Self::U; 4]) -> [[u32; 4]; MAX_LANES] {
                let mut rows = [[0; 4]; MAX_LANES];
                let words = rows.as_flattened_mut();
                for (some, words) in rows_of(columns).iter().zip(words.chunks_exact_mut($lanes)) {
                    some.store_slice(words);
                }
                rows
            }
        }
    };
}

lanes!(Lanes4, 4, f32x4, u32x4, mask32x4, transpose4);
lanes!(Lanes8, 8, f32x8, u32x8, mask32x8, transpose8);
lanes!(Lanes16, 16, f32x16, u32x16, mask32x16, transpose16);

/// The inverse of [`columns`].
#[inline(always)]
fn rows_of<S: Simd, V: SimdBase<S>>([x, y, z, w]: [V; 4]) -> [V; 4] {
    let (low, high) = ((x.zip_low(z), y.zip_low(w)), (x.zip_high(z), y.zip_high(w)));
    [
        low.0.zip_low(low.1),
        low.0.zip_high(low.1),
        high.0.zip_low(high.1),
        high.0.zip_high(high.1),
    ]
}

/// Row `r` of four vectors that hold one row of four a lane, in the order of lanes, turned into four vectors of one
/// word a lane.
#[inline(always)]
fn columns<S: Simd, V: SimdBase<S>>([a, b, c, d]: [V; 4]) -> [V; 4] {
    let (xz, yw) = (
        (a.unzip_low(b), c.unzip_low(d)),
        (a.unzip_high(b), c.unzip_high(d)),
    );
    [
        xz.0.unzip_low(xz.1),
        yw.0.unzip_low(yw.1),
        xz.0.unzip_high(xz.1),
        yw.0.unzip_high(yw.1),
    ]
}

#[inline(always)]
fn transpose4<S: Simd>(rows: [u32x4<S>; 4]) -> [u32x4<S>; 4] {
    columns(rows)
}

#[inline(always)]
fn transpose8<S: Simd>([a, b, c, d, e, f, g, h]: [u32x4<S>; 8]) -> [u32x8<S>; 4] {
    columns([a.combine(b), c.combine(d), e.combine(f), g.combine(h)])
}

#[inline(always)]
fn transpose16<S: Simd>(
    [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p]: [u32x4<S>; 16],
) -> [u32x16<S>; 4] {
    columns([
        a.combine(b).combine(c.combine(d)),
        e.combine(f).combine(g.combine(h)),
        i.combine(j).combine(k.combine(l)),
        m.combine(n).combine(o.combine(p)),
    ])
}
