//! The vector operations that the kernels call, and nothing else, over fearless_simd's tokens.
//!
//! The fused multiply-add is for bounds that stay conservative however it rounds, and for
//! [`Fast`](crate::Fast). What decides a watertight hit does without: so every instruction set
//! gives the same bits, and no edge is decided by the sign of a fused difference, which opens
//! cracks.

use fearless_simd::prelude::*;
use fearless_simd::{f32x4, f32x8, f32x16, mask32x4, mask32x8, mask32x16, u8x16};

use crate::look_up::{
    high_bits, high_bits_4, high_bits_8, high_bits_16, look_up, look_up_4, look_up_8, look_up_16,
};
use crate::reduce::{greatest, least};

/// `N` lanes of `f32` on the instruction set that the token `Self` stands for; `N` is 1, 2, 4, 8,
/// 16 or 32.
///
/// Every fearless_simd token implements it at all widths, so a function generic in the width
/// says `S: Width<N>` and needs no other bound. Widths 1 and 2 are arrays, 32 is a pair.
pub trait Width<const N: usize>: fearless_simd::Simd {
    /// `N` floats.
    type Float: Copy;
    /// `N` truth values.
    type Mask: Copy;

    /// `x` in every lane.
    fn splat(self, x: f32) -> Self::Float;
    /// The array's elements in order.
    fn load(self, array: &[f32; N]) -> Self::Float;
    /// The array's elements in order, as floats.
    fn load_bytes(self, array: &[u8; N]) -> Self::Float;
    /// Writes the lanes in order.
    fn store(self, a: Self::Float, array: &mut [f32; N]);
    /// `a + b`.
    fn add(self, a: Self::Float, b: Self::Float) -> Self::Float;
    /// `a - b`.
    fn sub(self, a: Self::Float, b: Self::Float) -> Self::Float;
    /// `a * b`.
    fn mul(self, a: Self::Float, b: Self::Float) -> Self::Float;
    /// `a * b + c`, rounded once where the instruction set can, else twice.
    fn mul_add(self, a: Self::Float, b: Self::Float, c: Self::Float) -> Self::Float;
    /// `a * b - c`, rounded as [`mul_add`](Width::mul_add).
    fn mul_sub(self, a: Self::Float, b: Self::Float, c: Self::Float) -> Self::Float;
    /// `a / b`.
    fn div(self, a: Self::Float, b: Self::Float) -> Self::Float;
    /// `|a|`.
    fn abs(self, a: Self::Float) -> Self::Float;
    /// The smaller; `number`, which must not be NaN, where `a` is NaN.
    fn min_number(self, a: Self::Float, number: Self::Float) -> Self::Float;
    /// The greater; `number`, which must not be NaN, where `a` is NaN.
    fn max_number(self, a: Self::Float, number: Self::Float) -> Self::Float;
    /// `a <= b`; false where either is NaN.
    fn le(self, a: Self::Float, b: Self::Float) -> Self::Mask;
    /// `a < b`; false where either is NaN.
    fn lt(self, a: Self::Float, b: Self::Float) -> Self::Mask;
    /// Both.
    fn and(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// `a` in the lanes whose bits are set, `b` in the others.
    fn select(self, bits: u32, a: Self::Float, b: Self::Float) -> Self::Float;
    /// The least lane; none may be NaN.
    fn least(self, a: Self::Float) -> f32;
    /// The greatest lane; none may be NaN.
    fn greatest(self, a: Self::Float) -> f32;
    /// The least lane of each of four; none may be NaN.
    fn least_of(self, four: [Self::Float; 4]) -> [f32; 4];
    /// The greatest lane of each of four; none may be NaN.
    fn greatest_of(self, four: [Self::Float; 4]) -> [f32; 4];
    /// Lane `i` in bit `i`.
    fn bits(self, mask: Self::Mask) -> u32;
    /// Each lane's numbers of three tables of `N`: `[index][table]`. An index has four bits, of which a table of fewer numbers uses
    /// the lower; the first index of a lane is in the lowest bits of its word.
    fn look_up(self, tables: [Self::Float; 3], indices: &[u16; N]) -> [[Self::Float; 3]; 3];
    /// The highest bit of word `i` in bit `i`.
    fn high_bits(self, words: &[u16; N]) -> u32;
}

/// Calls `f` as a function of its own, compiled for the token's instruction set. A kernel that is inlined beside
/// another takes registers from it: packets were 8 % slower beside one that they did not even call.
#[inline(never)]
pub(crate) fn apart<S: fearless_simd::Simd, T>(simd: S, f: impl FnOnce() -> T) -> T {
    simd.vectorize(f)
}

/// Lanes in memory, to be picked one by one. Aligned, because the machine's stack is so by chance only: sixteen lanes
/// across two cache lines, read back at once, made camera rays 15 % slower in every other process.
#[derive(Clone, Copy)]
#[repr(align(64))]
pub(crate) struct Stored<const N: usize>(pub(crate) [f32; N]);

impl<const N: usize> Stored<N> {
    #[inline(always)]
    pub(crate) fn of<S: Width<N>>(simd: S, lanes: S::Float) -> Self {
        let mut stored = Stored([0.0; N]);
        simd.store(lanes, &mut stored.0);
        stored
    }
}

/// On x86 fearless_simd's `min` and `max` are `minps` and `maxps`, which return their *second*
/// operand where either is NaN; its fallback uses `f32::min`, which drops NaN. Either way
/// `a.min(number)` is `number` where `a` is NaN, in one instruction. Elsewhere (NEON's `fmin`
/// propagates NaN) we ask for the precise operations.
const SECOND_OPERAND_WINS: bool = cfg!(any(target_arch = "x86", target_arch = "x86_64"));

macro_rules! implement_lanes {
    ($n:literal, $float:ident, $mask:ident, $bytes:ident, $look_up:ident, $high_bits:ident, $of:ident) => {
        impl<S: fearless_simd::Simd> Width<$n> for S {
            type Float = $float<S>;
            type Mask = $mask<S>;

            #[inline(always)]
            fn splat(self, x: f32) -> $float<S> {
                $float::splat(self, x)
            }
            #[inline(always)]
            fn load(self, array: &[f32; $n]) -> $float<S> {
                $float::load_array_ref(self, array)
            }
            #[inline(always)]
            fn load_bytes(self, array: &[u8; $n]) -> $float<S> {
                $bytes(self, array)
            }
            #[inline(always)]
            fn store(self, a: $float<S>, array: &mut [f32; $n]) {
                a.store_array(array)
            }
            #[inline(always)]
            fn add(self, a: $float<S>, b: $float<S>) -> $float<S> {
                a + b
            }
            #[inline(always)]
            fn sub(self, a: $float<S>, b: $float<S>) -> $float<S> {
                a - b
            }
            #[inline(always)]
            fn mul(self, a: $float<S>, b: $float<S>) -> $float<S> {
                a * b
            }
            #[inline(always)]
            fn mul_add(self, a: $float<S>, b: $float<S>, c: $float<S>) -> $float<S> {
                a.mul_add(b, c)
            }
            #[inline(always)]
            fn mul_sub(self, a: $float<S>, b: $float<S>, c: $float<S>) -> $float<S> {
                a.mul_sub(b, c)
            }
            #[inline(always)]
            fn div(self, a: $float<S>, b: $float<S>) -> $float<S> {
                a / b
            }
            #[inline(always)]
            fn abs(self, a: $float<S>) -> $float<S> {
                a.abs()
            }
            #[inline(always)]
            fn min_number(self, a: $float<S>, number: $float<S>) -> $float<S> {
                if SECOND_OPERAND_WINS {
                    a.min(number)
                } else {
                    a.min_precise(number)
                }
            }
            #[inline(always)]
            fn max_number(self, a: $float<S>, number: $float<S>) -> $float<S> {
                if SECOND_OPERAND_WINS {
                    a.max(number)
                } else {
                    a.max_precise(number)
                }
            }
            #[inline(always)]
            fn le(self, a: $float<S>, b: $float<S>) -> $mask<S> {
                a.simd_le(b)
            }
            #[inline(always)]
            fn lt(self, a: $float<S>, b: $float<S>) -> $mask<S> {
                a.simd_lt(b)
            }
            #[inline(always)]
            fn and(self, a: $mask<S>, b: $mask<S>) -> $mask<S> {
                a & b
            }
            #[inline(always)]
            fn select(self, bits: u32, a: $float<S>, b: $float<S>) -> $float<S> {
                <$mask<S> as SimdMask<S>>::from_bitmask(self, u64::from(bits)).select(a, b)
            }
            #[inline(always)]
            fn least(self, a: $float<S>) -> f32 {
                a.reduce_min()
            }
            #[inline(always)]
            fn greatest(self, a: $float<S>) -> f32 {
                a.reduce_max()
            }
            #[inline(always)]
            fn least_of(self, four: [$float<S>; 4]) -> [f32; 4] {
                least::$of(self, four)
            }
            #[inline(always)]
            fn greatest_of(self, four: [$float<S>; 4]) -> [f32; 4] {
                greatest::$of(self, four)
            }
            #[inline(always)]
            fn bits(self, mask: $mask<S>) -> u32 {
                mask.to_bitmask() as u32
            }
            #[inline(always)]
            fn look_up(self, tables: [$float<S>; 3], indices: &[u16; $n]) -> [[$float<S>; 3]; 3] {
                $look_up(self, tables, indices)
            }
            #[inline(always)]
            fn high_bits(self, words: &[u16; $n]) -> u32 {
                $high_bits(self, words)
            }
        }
    };
}

// The compiler makes two instructions of each of these; of an array's elements converted one by one
// it does so for 16 only.

#[inline(always)]
fn load_bytes_4<S: fearless_simd::Simd>(simd: S, array: &[u8; 4]) -> f32x4<S> {
    let mut padded = [0; 16];
    padded[..4].copy_from_slice(array);
    let (shorts, _) = simd.widen_u8x16(u8x16::load_array(simd, padded));
    let (ints, _) = simd.widen_u16x8(shorts);
    simd.cvt_f32_i32x4(ints.bitcast())
}

#[inline(always)]
fn load_bytes_8<S: fearless_simd::Simd>(simd: S, array: &[u8; 8]) -> f32x8<S> {
    let mut padded = [0; 16];
    padded[..8].copy_from_slice(array);
    let (shorts, _) = simd.widen_u8x16(u8x16::load_array(simd, padded));
    let (low, high) = simd.widen_u16x8(shorts);
    simd.cvt_f32_i32x8(simd.combine_i32x4(low.bitcast(), high.bitcast()))
}

#[inline(always)]
fn load_bytes_16<S: fearless_simd::Simd>(simd: S, array: &[u8; 16]) -> f32x16<S> {
    f32x16::load_array(simd, array.map(f32::from))
}

implement_lanes!(
    4,
    f32x4,
    mask32x4,
    load_bytes_4,
    look_up_4,
    high_bits_4,
    of_4
);
implement_lanes!(
    8,
    f32x8,
    mask32x8,
    load_bytes_8,
    look_up_8,
    high_bits_8,
    of_8
);
implement_lanes!(
    16,
    f32x16,
    mask32x16,
    load_bytes_16,
    look_up_16,
    high_bits_16,
    of_16
);

/// Too narrow for registers: arrays, left to the compiler.
macro_rules! implement_narrow_lanes {
    ($n:literal) => {
        impl<S: fearless_simd::Simd> Width<$n> for S {
            type Float = [f32; $n];
            type Mask = [bool; $n];

            #[inline(always)]
            fn splat(self, x: f32) -> [f32; $n] {
                [x; $n]
            }
            #[inline(always)]
            fn load(self, array: &[f32; $n]) -> [f32; $n] {
                *array
            }
            #[inline(always)]
            fn load_bytes(self, array: &[u8; $n]) -> [f32; $n] {
                array.map(f32::from)
            }
            #[inline(always)]
            fn store(self, a: [f32; $n], array: &mut [f32; $n]) {
                *array = a;
            }
            #[inline(always)]
            fn add(self, a: [f32; $n], b: [f32; $n]) -> [f32; $n] {
                zip(a, b, |a, b| a + b)
            }
            #[inline(always)]
            fn sub(self, a: [f32; $n], b: [f32; $n]) -> [f32; $n] {
                zip(a, b, |a, b| a - b)
            }
            #[inline(always)]
            fn mul(self, a: [f32; $n], b: [f32; $n]) -> [f32; $n] {
                zip(a, b, |a, b| a * b)
            }
            #[inline(always)]
            fn mul_add(self, a: [f32; $n], b: [f32; $n], c: [f32; $n]) -> [f32; $n] {
                zip(zip(a, b, |a, b| a * b), c, |ab, c| ab + c)
            }
            #[inline(always)]
            fn mul_sub(self, a: [f32; $n], b: [f32; $n], c: [f32; $n]) -> [f32; $n] {
                zip(zip(a, b, |a, b| a * b), c, |ab, c| ab - c)
            }
            #[inline(always)]
            fn div(self, a: [f32; $n], b: [f32; $n]) -> [f32; $n] {
                zip(a, b, |a, b| a / b)
            }
            #[inline(always)]
            fn abs(self, a: [f32; $n]) -> [f32; $n] {
                a.map(f32::abs)
            }
            #[inline(always)]
            fn min_number(self, a: [f32; $n], number: [f32; $n]) -> [f32; $n] {
                zip(a, number, |a, b| if a < b { a } else { b })
            }
            #[inline(always)]
            fn max_number(self, a: [f32; $n], number: [f32; $n]) -> [f32; $n] {
                zip(a, number, |a, b| if a > b { a } else { b })
            }
            #[inline(always)]
            fn le(self, a: [f32; $n], b: [f32; $n]) -> [bool; $n] {
                zip(a, b, |a, b| a <= b)
            }
            #[inline(always)]
            fn lt(self, a: [f32; $n], b: [f32; $n]) -> [bool; $n] {
                zip(a, b, |a, b| a < b)
            }
            #[inline(always)]
            fn and(self, a: [bool; $n], b: [bool; $n]) -> [bool; $n] {
                zip(a, b, |a, b| a & b)
            }
            #[inline(always)]
            fn select(self, bits: u32, a: [f32; $n], b: [f32; $n]) -> [f32; $n] {
                std::array::from_fn(|lane| {
                    if bits >> lane & 1 == 1 {
                        a[lane]
                    } else {
                        b[lane]
                    }
                })
            }
            #[inline(always)]
            fn least(self, a: [f32; $n]) -> f32 {
                a.into_iter()
                    .fold(f32::INFINITY, |a, b| if b < a { b } else { a })
            }
            #[inline(always)]
            fn greatest(self, a: [f32; $n]) -> f32 {
                a.into_iter()
                    .fold(f32::NEG_INFINITY, |a, b| if b > a { b } else { a })
            }
            #[inline(always)]
            fn least_of(self, four: [[f32; $n]; 4]) -> [f32; 4] {
                four.map(|a| Width::<$n>::least(self, a))
            }
            #[inline(always)]
            fn greatest_of(self, four: [[f32; $n]; 4]) -> [f32; 4] {
                four.map(|a| Width::<$n>::greatest(self, a))
            }
            #[inline(always)]
            fn bits(self, mask: [bool; $n]) -> u32 {
                mask.iter()
                    .rev()
                    .fold(0, |bits, &lane| bits << 1 | u32::from(lane))
            }
            #[inline(always)]
            fn look_up(self, tables: [[f32; $n]; 3], indices: &[u16; $n]) -> [[[f32; $n]; 3]; 3] {
                look_up(tables, indices)
            }
            #[inline(always)]
            fn high_bits(self, words: &[u16; $n]) -> u32 {
                high_bits(words)
            }
        }
    };
}

#[inline(always)]
fn zip<A: Copy, B: Copy, C, const N: usize>(a: [A; N], b: [B; N], f: impl Fn(A, B) -> C) -> [C; N] {
    std::array::from_fn(|lane| f(a[lane], b[lane]))
}

implement_narrow_lanes!(1);
implement_narrow_lanes!(2);
