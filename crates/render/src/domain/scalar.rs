//! One `f32` at a time.

use super::{Buffer, Buffers, Bundle, Domain};

/// The domain of single `f32` numbers.
#[derive(Clone, Copy, Debug)]
pub struct Scalar<'a> {
    buffers: &'a Buffers<'a>,
}

impl<'a> Scalar<'a> {
    /// A domain that reads these buffers.
    #[inline(always)]
    pub fn new(buffers: &'a Buffers<'a>) -> Self {
        Self { buffers }
    }
}

impl Domain for Scalar<'_> {
    type F = f32;
    type U = Uint;
    type M = bool;

    #[inline(always)]
    fn lit(self, value: f64) -> f32 {
        value as f32
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
    fn sqrt(self, a: f32) -> f32 {
        a.sqrt()
    }
    #[inline(always)]
    fn min(self, a: f32, b: f32) -> f32 {
        if a < b { a } else { b }
    }
    #[inline(always)]
    fn max(self, a: f32, b: f32) -> f32 {
        if a > b { a } else { b }
    }
    #[inline(always)]
    fn abs(self, a: f32) -> f32 {
        a.abs()
    }
    #[inline(always)]
    fn floor(self, a: f32) -> f32 {
        a.floor()
    }
    #[inline(always)]
    fn fma(self, a: f32, b: f32, c: f32) -> f32 {
        // Without the instruction, `mul_add` is a call into the C library.
        if cfg!(any(target_feature = "fma", target_arch = "aarch64")) {
            a.mul_add(b, c)
        } else {
            a * b + c
        }
    }
    #[inline(always)]
    fn copysign(self, a: f32, b: f32) -> f32 {
        a.copysign(b)
    }
    #[inline(always)]
    fn lt(self, a: f32, b: f32) -> bool {
        a < b
    }
    #[inline(always)]
    fn le(self, a: f32, b: f32) -> bool {
        a <= b
    }
    #[inline(always)]
    fn eq(self, a: f32, b: f32) -> bool {
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
    fn select(self, mask: bool, a: f32, b: f32) -> f32 {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn select_u(self, mask: bool, a: Uint, b: Uint) -> Uint {
        if mask { a } else { b }
    }
    #[inline(always)]
    fn to_uint(self, a: f32) -> Uint {
        Uint(a as u32)
    }
    #[inline(always)]
    fn to_real(self, a: Uint) -> f32 {
        a.0 as f32
    }
    #[inline(always)]
    fn to_bits(self, a: f32) -> Uint {
        Uint(a.to_bits())
    }
    #[inline(always)]
    fn from_bits(self, a: Uint) -> f32 {
        f32::from_bits(a.0)
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

/// A `u32` whose operators wrap and shift by any amount below 32.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Uint(pub u32);

macro_rules! wrapping {
    ($($op:ident $method:ident $with:ident),*) => {$(
        impl std::ops::$op for Uint {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$with(other.0))
            }
        }
    )*};
}
wrapping!(Add add wrapping_add, Sub sub wrapping_sub, Mul mul wrapping_mul,
          BitAnd bitand bitand, BitOr bitor bitor, BitXor bitxor bitxor);

impl std::ops::Shl<u32> for Uint {
    type Output = Self;
    #[inline(always)]
    fn shl(self, by: u32) -> Self {
        Self(self.0 << by)
    }
}
impl std::ops::Shr<u32> for Uint {
    type Output = Self;
    #[inline(always)]
    fn shr(self, by: u32) -> Self {
        Self(self.0 >> by)
    }
}
