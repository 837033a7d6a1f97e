//! The domain's contract: what each operation gives, in which domain, and cases that hold a domain to it.
//!
//! [`Operation::ALL`] with [`Operation::operands`] is a suite for every domain and device that computes: it runs
//! [`Operation::evaluate`] on the operands, by itself or as recorded and printed, and [`Operation::answer`] says what has to
//! come out. (fidget exports such a suite to its backends.) [`Expression`] has formulas of few operations that give away a
//! compiler which takes liberties between them.
//!
//! | operation | `Scalar`, `Lanes` | `Precise`, rounded to `f32` | tape | WGSL, exact | WGSL, plain |
//! |---|---|---|---|---|---|
//! | `Add`, `Sub`, `Mul` | exact | exact¹ | `x + 0` is `x`, `x·0` is 0 | exact: `NoContraction` | may differ: contraction, reassociation |
//! | `Div` | exact | exact¹ | `0 ÷ x` is 0 | exact, replaced where the adapter's is not | 2.5 ulp (Vulkan) |
//! | `Sqrt` | exact | exact¹ | exact | exact, replaced where the adapter's is not | as `1 ÷ inverseSqrt(x)`, 2 ulp and 2.5 ulp |
//! | `Fma` | fused where the instruction set fuses | sum rounded twice | `0·x + y` is `y`, and the like | as `Scalar`, replaced where the adapter's is not | fused or not |
//! | `Min`, `Max` | second operand on NaN and of two zeros | the same | the same | the same, printed as select | either on NaN and of two zeros |
//! | `Neg`, `Abs`, `Copysign`, `Floor` | exact | exact | exact | exact | exact, but for the sign of zero |
//! | `Lt`, `Le`, `Eq` | exact, false on NaN | the same | the same | the same | either on NaN |
//! | `Select` | exact | exact | exact | exact | exact |
//! | `AddU` … `LtU`, `And`, `Or`, `Not` | exact | exact | exact | exact | exact |
//! | `ToUint` | exact from 0 to below 2³², else unspecified | the same | the same | the same | the same |
//! | `ToReal` | exact | exact¹ | exact | exact | exact below 2²⁴, else either neighbour |
//! | `ToBits`, `FromBits` | exact | exact | exact | exact | exact |
//!
//! ¹ A number of 53 ≥ 2·24 + 2 bits, rounded once more, is the number rounded once (Figueroa 1995).
//!
//! *Exact* is the one correctly rounded IEEE 754 result, to nearest even, with denormals; where that is a NaN, any NaN. A NaN's
//! sign counts for no operation but `Copysign`, whose second operand is looked at as bits. What the tape does differently, it
//! does to constants only: it takes values for finite and does not keep the sign of zero. Plain WGSL may moreover take NaN and
//! infinities for absent and flush denormals. Exact WGSL is SPIR-V in which nothing is contracted, and whose division, root
//! and `fma` are those that a probe of the adapter, with this suite, found right.
//!
//! Two rows of `Lanes` do not hold everywhere. `Min` and `Max` are fearless_simd's, which are the second operand on NaN and of
//! two zeros on x86 only. `Fma` fuses in lanes wherever the instruction set does that they are dispatched to, but in `Scalar`
//! only if the program is built for one that fuses: as the workspace is, not as a program that is built for any x86.

mod expression;
mod operands;

pub use expression::Expression;

use super::tape::{Kind, Op};
use super::{Buffers, Domain, Scalar, Uint};

/// An operation, and what it is applied to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Operation {
    /// Which.
    pub op: Op,
    /// The kind of its operands; but a select's first operand is a truth value.
    pub on: Kind,
}

/// What the contract says of an operation's result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// These bits.
    Bits(u32),
    /// A NaN, of any sign and payload.
    NaN,
    /// Anything.
    Unspecified,
}

impl Answer {
    /// The result is as the contract says.
    pub fn admits(self, result: u32) -> bool {
        match self {
            Self::Bits(bits) => bits == result,
            Self::NaN => f32::from_bits(result).is_nan(),
            Self::Unspecified => true,
        }
    }

    /// A number with these bits.
    fn real(bits: u32) -> Self {
        if f32::from_bits(bits).is_nan() {
            Self::NaN
        } else {
            Self::Bits(bits)
        }
    }
}

const fn on(on: Kind, op: Op) -> Operation {
    Operation { op, on }
}

impl Operation {
    /// All of them; shifts by a few amounts, and selects of each kind.
    pub const ALL: [Self; 42] = [
        on(Kind::Real, Op::Add),
        on(Kind::Real, Op::Sub),
        on(Kind::Real, Op::Mul),
        on(Kind::Real, Op::Div),
        on(Kind::Real, Op::Neg),
        on(Kind::Real, Op::Sqrt),
        on(Kind::Real, Op::Min),
        on(Kind::Real, Op::Max),
        on(Kind::Real, Op::Abs),
        on(Kind::Real, Op::Floor),
        on(Kind::Real, Op::Fma),
        on(Kind::Real, Op::Copysign),
        on(Kind::Real, Op::Lt),
        on(Kind::Real, Op::Le),
        on(Kind::Real, Op::Eq),
        on(Kind::Word, Op::AddU),
        on(Kind::Word, Op::SubU),
        on(Kind::Word, Op::MulU),
        on(Kind::Word, Op::AndU),
        on(Kind::Word, Op::OrU),
        on(Kind::Word, Op::XorU),
        on(Kind::Word, Op::ShlU(0)),
        on(Kind::Word, Op::ShlU(1)),
        on(Kind::Word, Op::ShlU(13)),
        on(Kind::Word, Op::ShlU(31)),
        on(Kind::Word, Op::ShrU(0)),
        on(Kind::Word, Op::ShrU(1)),
        on(Kind::Word, Op::ShrU(13)),
        on(Kind::Word, Op::ShrU(31)),
        on(Kind::Word, Op::ReverseBits),
        on(Kind::Word, Op::EqU),
        on(Kind::Word, Op::LtU),
        on(Kind::Real, Op::ToUint),
        on(Kind::Word, Op::ToReal),
        on(Kind::Real, Op::ToBits),
        on(Kind::Word, Op::FromBits),
        on(Kind::Truth, Op::And),
        on(Kind::Truth, Op::Or),
        on(Kind::Truth, Op::Not),
        on(Kind::Real, Op::Select),
        on(Kind::Word, Op::Select),
        on(Kind::Truth, Op::Select),
    ];

    /// The kind of its result.
    pub fn kind(self) -> Kind {
        self.op.kind().unwrap_or(self.on)
    }

    /// The kinds of its operands; those beyond its arity are ignored.
    pub fn kinds(self) -> [Kind; 3] {
        let first = if self.op == Op::Select {
            Kind::Truth
        } else {
            self.on
        };
        [first, self.on, self.on]
    }

    /// Its result in the domain. Operands and result are bits, truth values 0 and 1.
    pub fn evaluate<D: Domain>(self, d: D, operands: [D::U; 3]) -> D::U {
        let [p, q, r] = operands.map(|bit| d.lt_u(d.uint(0), bit));
        let [_, b, c] = operands.map(|bits| d.from_bits(bits));
        match (self.op, self.on) {
            (Op::Select, Kind::Real) => d.to_bits(d.select(p, b, c)),
            (Op::Select, Kind::Truth) => d.select_u(d.select_mask(p, q, r), d.uint(1), d.uint(0)),
            (op, _) => op.apply(d, operands),
        }
    }

    /// What it has to be tried on, the same each time: special values in all combinations (of three reals, in some), and a
    /// few thousand pseudo-random ones. Operands beyond its arity are 0.
    pub fn operands(self) -> Vec<[u32; 3]> {
        operands::of_kinds(&self.kinds()[..self.op.arity()])
    }

    /// What the contract says of its result, on this machine's instruction set.
    pub fn answer(self, operands: [u32; 3]) -> Answer {
        let bits = self
            .evaluate(Scalar::new(&Buffers::EMPTY), operands.map(Uint))
            .0;
        let in_range = (0.0..4_294_967_296.0).contains(&f32::from_bits(operands[0]));
        match (self.op, self.kind()) {
            (Op::ToUint, _) if !in_range => Answer::Unspecified,
            (Op::ToBits, _) | (_, Kind::Real) => Answer::real(bits),
            (_, Kind::Word | Kind::Truth) => Answer::Bits(bits),
        }
    }
}
