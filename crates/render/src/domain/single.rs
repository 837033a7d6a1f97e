//! One number at a time: `f32`, and `f64` as the reference that every `f32` formula is held against.

use super::{Buffer, Buffers, Bundle, Domain};

/// Whether [`Domain::fma`] of [`Scalar`] fuses.
pub const FUSES: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));

/// A domain of single numbers. The two differ in the type of a number, in `fma`, and in that bits are those of an
/// `f32` in both.
macro_rules! single {
    ($(#[$doc:meta])* $name:ident, $real:ident, |$a:ident, $b:ident, $c:ident| $fma:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub struct $name<'a> {
            buffers: &'a Buffers<'a>,
        }

        impl<'a> $name<'a> {
            /// A domain that reads these buffers.
            #[inline(always)]
            pub fn new(buffers: &'a Buffers<'a>) -> Self {
                Self { buffers }
            }
        }

        impl Domain for $name<'_> {
            type F = $real;
            type U = Uint;
            type M = bool;

            #[inline(always)]
            fn lit(self, value: f64) -> $real {
                value as $real
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
            fn sqrt(self, a: $real) -> $real {
                a.sqrt()
            }
            #[inline(always)]
            fn min(self, a: $real, b: $real) -> $real {
                if a < b { a } else { b }
            }
            #[inline(always)]
            fn max(self, a: $real, b: $real) -> $real {
                if a > b { a } else { b }
            }
            #[inline(always)]
            fn abs(self, a: $real) -> $real {
                a.abs()
            }
            #[inline(always)]
            fn floor(self, a: $real) -> $real {
                a.floor()
            }
            #[inline(always)]
            fn fma(self, $a: $real, $b: $real, $c: $real) -> $real {
                $fma
            }
            #[inline(always)]
            fn copysign(self, a: $real, b: $real) -> $real {
                a.copysign(b)
            }
            #[inline(always)]
            fn lt(self, a: $real, b: $real) -> bool {
                a < b
            }
            #[inline(always)]
            fn le(self, a: $real, b: $real) -> bool {
                a <= b
            }
            #[inline(always)]
            fn eq(self, a: $real, b: $real) -> bool {
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
            fn select(self, mask: bool, a: $real, b: $real) -> $real {
                if mask { a } else { b }
            }
            #[inline(always)]
            fn select_u(self, mask: bool, a: Uint, b: Uint) -> Uint {
                if mask { a } else { b }
            }
            #[inline(always)]
            fn to_uint(self, a: $real) -> Uint {
                Uint(a as u32)
            }
            #[inline(always)]
            fn to_real(self, a: Uint) -> $real {
                a.0 as $real
            }
            #[inline(always)]
            fn to_bits(self, a: $real) -> Uint {
                Uint((a as f32).to_bits())
            }
            #[inline(always)]
            fn from_bits(self, a: Uint) -> $real {
                $real::from(f32::from_bits(a.0))
            }
            #[inline(always)]
            fn reverse_bits(self, a: Uint) -> Uint {
                Uint(a.0.reverse_bits())
            }
            #[inline(always)]
            fn load(self, buffer: Buffer, index: Uint) -> Uint {
                Uint(self.buffers.word(buffer, index.0))
            }
            #[inline(always)]
            fn load_rows<const N: usize>(self, buffer: Buffer, first: Uint) -> [[Uint; 4]; N] {
                let mut rows = [[Uint(0); 4]; N];
                for (row, from) in rows.iter_mut().zip(self.buffers.rows::<N>(buffer, first.0)) {
                    for (word, &from) in row.iter_mut().zip(from) {
                        *word = Uint(from);
                    }
                }
                rows
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
            #[inline(always)]
            fn holds_nowhere(self, mask: bool) -> bool {
                !mask
            }
        }
    };
}

single!(
    /// The domain of single `f32` numbers.
    Scalar, f32, |a, b, c| {
        // Without the instruction, `mul_add` is a call into the C library.
        if FUSES {
            a.mul_add(b, c)
        } else {
            a * b + c
        }
    }
);

single!(
    /// The domain of single `f64` numbers. Elementary functions are the same polynomials here as for `f32`.
    Precise, f64, |a, b, c| a * b + c
);

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
