//! `f32` in SIMD lanes: 4, 8 or 16 paths at once, on whatever instruction set the token stands for.

use fearless_simd::{
    Bytes, Select, Simd, SimdBase, SimdCvtFloat, SimdCvtTruncate, SimdFloat, SimdMask, f32x4,
    f32x8, f32x16, mask32x4, mask32x8, mask32x16, u32x4, u32x8, u32x16,
};

use super::single::Uint;
use super::{Buffer, Buffers, Bundle, Domain, Scalar};

/// A domain whose numbers are moved to and from arrays: what a device that executes needs.
pub trait Lanes: Domain {
    /// How many numbers there are at once.
    const LANES: usize;
    /// `LANES` numbers; `from` must be that long.
    fn real(self, from: &[f32]) -> Self::F;
    /// `LANES` integers; `from` must be that long.
    fn word(self, from: &[u32]) -> Self::U;
    /// The mask's bits, lane 0 lowest.
    fn bits(self, mask: Self::M) -> u32;
    /// Stores `LANES` numbers; `to` must be that long.
    fn store(self, value: Self::F, to: &mut [f32]);
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
    fn real(self, from: &[f32]) -> f32 {
        from[0]
    }
    #[inline(always)]
    fn word(self, from: &[u32]) -> Uint {
        Uint(from[0])
    }
    #[inline(always)]
    fn bits(self, mask: bool) -> u32 {
        u32::from(mask)
    }
    #[inline(always)]
    fn store(self, value: f32, to: &mut [f32]) {
        to[0] = value;
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
    ($name:ident, $lanes:literal, $real:ident, $word:ident, $mask:ident) => {
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
            fn load(self, buffer: Buffer, index: Self::U) -> Self::U {
                let mut words = [0; $lanes];
                for (word, &index) in words.iter_mut().zip(index.as_slice()) {
                    *word = self.buffers.word(buffer, index);
                }
                $word::load_array(self.simd, words)
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
            fn vectorize<R>(self, f: impl FnOnce() -> R) -> R {
                self.simd.vectorize(f)
            }
        }

        impl<S: Simd> Lanes for $name<'_, S> {
            const LANES: usize = $lanes;
            #[inline(always)]
            fn real(self, from: &[f32]) -> Self::F {
                $real::from_slice(self.simd, from)
            }
            #[inline(always)]
            fn word(self, from: &[u32]) -> Self::U {
                $word::from_slice(self.simd, from)
            }
            #[inline(always)]
            fn bits(self, mask: Self::M) -> u32 {
                mask.to_bitmask() as u32
            }
            #[inline(always)]
            fn store(self, value: Self::F, to: &mut [f32]) {
                value.store_slice(to);
            }
            #[inline(always)]
            fn store_word(self, value: Self::U, to: &mut [u32]) {
                value.store_slice(to);
            }
            #[inline(always)]
            fn columns(self, row: impl Fn(usize) -> [u32; 4]) -> [Self::U; 4] {
                const ROWS: usize = $lanes / 4;
                let quarter = |first: usize| {
                    let mut words = [0; $lanes];
                    for k in 0..ROWS {
                        words[4 * k..4 * k + 4].copy_from_slice(&row(first * ROWS + k));
                    }
                    $word::load_array(self.simd, words)
                };
                // Even columns, then every second of them, in the order of the rows.
                let (a, b) = (quarter(0), quarter(1));
                let (c, d) = (quarter(2), quarter(3));
                let (xz_low, yw_low) = (a.unzip_low(b), a.unzip_high(b));
                let (xz_high, yw_high) = (c.unzip_low(d), c.unzip_high(d));
                [
                    xz_low.unzip_low(xz_high),
                    yw_low.unzip_low(yw_high),
                    xz_low.unzip_high(xz_high),
                    yw_low.unzip_high(yw_high),
                ]
            }
            #[inline(always)]
            fn rows(self, [x, y, z, w]: [Self::U; 4]) -> [[u32; 4]; MAX_LANES] {
                let (xz_low, xz_high) = (x.zip_low(z), x.zip_high(z));
                let (yw_low, yw_high) = (y.zip_low(w), y.zip_high(w));
                let quarters = [
                    xz_low.zip_low(yw_low),
                    xz_low.zip_high(yw_low),
                    xz_high.zip_low(yw_high),
                    xz_high.zip_high(yw_high),
                ];
                let mut rows = [[0; 4]; MAX_LANES];
                let words = rows.as_flattened_mut();
                for (quarter, words) in quarters.iter().zip(words.chunks_exact_mut($lanes)) {
                    quarter.store_slice(words);
                }
                rows
            }
        }
    };
}

lanes!(Lanes4, 4, f32x4, u32x4, mask32x4);
lanes!(Lanes8, 8, f32x8, u32x8, mask32x8);
lanes!(Lanes16, 16, f32x16, u32x16, mask32x16);
