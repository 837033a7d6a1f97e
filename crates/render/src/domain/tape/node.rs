//! What stands on a tape.

use crate::domain::Buffer;

/// The number of an expression on its tape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Id(u32);

impl Id {
    pub(super) fn new(index: usize) -> Self {
        Self(u32::try_from(index).expect("a tape holds fewer than 2³² expressions"))
    }

    /// Its place among the function's nodes.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// What an expression is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// An `f32`.
    Real,
    /// A `u32`.
    Word,
    /// A truth value.
    Truth,
}

/// An expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A constant: the bits of a finite `f32`, a `u32`, or 0 and 1 for the truth values.
    Constant {
        /// Its kind.
        kind: Kind,
        /// Its value.
        bits: u32,
    },
    /// A parameter, or a component of one that is a vector.
    Parameter {
        /// Which.
        parameter: u32,
        /// 0, 1, 2 for x, y, z.
        component: Option<u8>,
    },
    /// An operation. Operands beyond its arity repeat the first.
    Apply {
        /// Which.
        op: Op,
        /// On what.
        operands: [Id; 3],
    },
    /// A word of a buffer.
    Load {
        /// Which buffer.
        buffer: Buffer,
        /// Which word.
        index: Id,
    },
    /// A constant that compilers must not see through: an operation on it has no finite value.
    Opaque(Id),
    /// A branch. It has no value; its choices have.
    Branch(u32),
    /// What a branch yields.
    Choice {
        /// The branch.
        branch: Id,
        /// Which of the values that it yields.
        place: u32,
    },
}

/// An operation. Those without a suffix are on real numbers. Each is in
/// [`Operation::ALL`](crate::domain::operations::Operation::ALL), too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names are those of `Domain`'s operations")]
pub enum Op {
    Add,
    Sub,
    Mul,
    Div,
    Neg,
    Sqrt,
    Min,
    Max,
    Abs,
    Floor,
    Fma,
    Copysign,
    Lt,
    Le,
    Eq,
    AddU,
    SubU,
    MulU,
    AndU,
    OrU,
    XorU,
    ShlU(u32),
    ShrU(u32),
    ReverseBits,
    EqU,
    LtU,
    ToUint,
    ToReal,
    ToBits,
    FromBits,
    And,
    Or,
    Not,
    /// The second operand where the first holds, else the third; of any kind.
    Select,
}

impl Op {
    /// How many operands there are.
    pub fn arity(self) -> usize {
        match self {
            Self::Neg
            | Self::Sqrt
            | Self::Abs
            | Self::Floor
            | Self::ShlU(_)
            | Self::ShrU(_)
            | Self::ReverseBits
            | Self::ToUint
            | Self::ToReal
            | Self::ToBits
            | Self::FromBits
            | Self::Not => 1,
            Self::Add
            | Self::Sub
            | Self::Mul
            | Self::Div
            | Self::Min
            | Self::Max
            | Self::Copysign
            | Self::Lt
            | Self::Le
            | Self::Eq
            | Self::AddU
            | Self::SubU
            | Self::MulU
            | Self::AndU
            | Self::OrU
            | Self::XorU
            | Self::EqU
            | Self::LtU
            | Self::And
            | Self::Or => 2,
            Self::Fma | Self::Select => 3,
        }
    }

    /// What it yields; `None` is the kind of its second operand.
    pub fn kind(self) -> Option<Kind> {
        match self {
            Self::Add
            | Self::Sub
            | Self::Mul
            | Self::Div
            | Self::Neg
            | Self::Sqrt
            | Self::Min
            | Self::Max
            | Self::Abs
            | Self::Floor
            | Self::Fma
            | Self::Copysign
            | Self::ToReal
            | Self::FromBits => Some(Kind::Real),
            Self::AddU
            | Self::SubU
            | Self::MulU
            | Self::AndU
            | Self::OrU
            | Self::XorU
            | Self::ShlU(_)
            | Self::ShrU(_)
            | Self::ReverseBits
            | Self::ToUint
            | Self::ToBits => Some(Kind::Word),
            Self::Lt
            | Self::Le
            | Self::Eq
            | Self::EqU
            | Self::LtU
            | Self::And
            | Self::Or
            | Self::Not => Some(Kind::Truth),
            Self::Select => None,
        }
    }

    /// Its first two operands may be exchanged.
    pub(super) fn commutes(self) -> bool {
        matches!(
            self,
            Self::Add
                | Self::Mul
                | Self::Fma
                | Self::Eq
                | Self::AddU
                | Self::MulU
                | Self::AndU
                | Self::OrU
                | Self::XorU
                | Self::EqU
                | Self::And
                | Self::Or
        )
    }
}
