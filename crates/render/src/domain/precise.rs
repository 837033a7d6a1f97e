//! One `f64` at a time: the reference that every `f32` formula is held against.

use super::scalar::Uint;
use super::{Buffer, Buffers, Bundle, Domain};

/// The domain of single `f64` numbers.
#[derive(Clone, Copy, Debug)]
pub struct Precise<'a> {
    buffers: &'a Buffers<'a>,
}

impl<'a> Precise<'a> {
    /// A domain that reads these buffers.
    #[inline(always)]
    pub fn new(buffers: &'a Buffers<'a>) -> Self {
        Self { buffers }
    }
}

impl Domain for Precise<'_> {
    type F = f64;
    type U = Uint;
    type M = bool;

    #[inline(always)]
    fn lit(self, value: f64) -> f64 {
        value
    }
    #[inline(always)]
    fn uint(self, value: u32) -> Uint {
        Uint(value)
    }
    #[inline(always)]
    fn truth(self, value: bool) -> bool {
        value
    }
    #[inline(always)]
    fn sqrt(self, a: f64) -> f64 {
        a.sqrt()
    }
    #[inline(always)]
    fn min(self, a: f64, b: f64) -> f64 {
        if a < b { a } else { b }
    }
    #[inline(always)]
    fn max(self, a: f64, b: f64) -> f64 {
        if a > b { a } else { b }
    }
    #[inline(always)]
    fn abs(self, a: f64) -> f64 {
        a.abs()
    }
    #[inline(always)]
    fn floor(self, a: f64) -> f64 {
        a.floor()
    }
    #[inline(always)]
    fn fma(self, a: f64, b: f64, c: f64) -> f64 {
        a * b + c
    }
    #[inline(always)]
    fn copysign(self, a: f64, b: f64) -> f64 {
        a.copysign(b)
    }
    #[inline(always)]
    fn lt(self, a: f64, b: f64) -> bool {
        a < b
    }
    #[inline(always)]
    fn le(self, a: f64, b: f64) -> bool {
        a <= b
    }
    #[inline(always)]
    fn eq(self, a: f64, b: f64) -> bool {
        a == b
    }
    #[inline(always)]
    fn eq_u(self, a: Uint, b: Uint) -> bool {
        a == b
    }
    #[inline(always)]
    fn lt_u(self, a: Uint, b: Uint) -> bool {
        a < b
    }
    #[inline(always)]
    fn select(self, mask: bool, a: f64, b: f64) -> f64 {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn select_u(self, mask: bool, a: Uint, b: Uint) -> Uint {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn to_uint(self, a: f64) -> Uint {
        Uint(a as u32)
    }
    #[inline(always)]
    fn to_real(self, a: Uint) -> f64 {
        f64::from(a.0)
    }
    #[inline(always)]
    fn to_bits(self, a: f64) -> Uint {
        Uint((a as f32).to_bits())
    }
    #[inline(always)]
    fn from_bits(self, a: Uint) -> f64 {
        f64::from(f32::from_bits(a.0))
    }
    #[inline(always)]
    fn load(self, buffer: Buffer, index: Uint) -> Uint {
        Uint(self.buffers.word(buffer, index.0))
    }
    #[inline(always)]
    fn uniform(self, buffer: Buffer, index: u32) -> Uint {
        Uint(self.buffers.word(buffer, index))
    }
    #[inline(always)]
    fn branch<T: Bundle<Self>>(
        self,
        mask: bool,
        a: impl FnOnce() -> T,
        b: impl FnOnce() -> T,
    ) -> T {
        if mask { a() } else { b() }
    }
}
