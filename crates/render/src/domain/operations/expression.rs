//! Formulas that give different bits if a compiler does not compute what is written.

use super::{Answer, operands};
use crate::domain::tape::Kind;
use crate::domain::{Buffers, Domain, Scalar, Uint};

/// A formula of three real numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Expression {
    /// What rounding took from a + b (Knuth): 0 to who reassociates.
    SumError,
    /// (a + b) − a: b to who reassociates.
    SumLessTerm,
    /// (a + 1) + 1: a + 2 to who collects constants.
    CollectedConstants,
    /// a·b − c, which contracts.
    ProductLessTerm,
    /// a·b − b·c, which contracts on either side, or has a factor taken out.
    ProductLessProduct,
    /// a·b + a·c, which contracts, or has a factor taken out.
    CommonFactor,
    /// a ÷ c + b ÷ c, which multiplies by 1 ÷ c.
    CommonDivisor,
    /// (a ÷ b)·b: a to who cancels.
    QuotientTimesDivisor,
    /// (√|a|)²: |a| to who cancels.
    RootSquared,
    /// a·b ≥ b·c, which is decided by a and c to who cancels, or by a rounded product and one that is not.
    ProductsInOrder,
    /// a, if a < b, else b: a minimum to who does not think of NaN and two zeros.
    Lesser,
    /// a = a: true to who does not think of NaN.
    EqualToItself,
}

impl Expression {
    /// All of them.
    pub const ALL: [Self; 12] = [
        Self::SumError,
        Self::SumLessTerm,
        Self::CollectedConstants,
        Self::ProductLessTerm,
        Self::ProductLessProduct,
        Self::CommonFactor,
        Self::CommonDivisor,
        Self::QuotientTimesDivisor,
        Self::RootSquared,
        Self::ProductsInOrder,
        Self::Lesser,
        Self::EqualToItself,
    ];

    /// The bits of its value in the domain, truth values 0 and 1.
    pub fn evaluate<D: Domain>(self, d: D, [a, b, c]: [D::F; 3]) -> D::U {
        let real = |value| d.to_bits(value);
        let truth = |value| d.select_u(value, d.uint(1), d.uint(0));
        match self {
            Self::SumError => {
                let sum = a + b;
                let of_b = sum - a;
                real((a - (sum - of_b)) + (b - of_b))
            }
            Self::SumLessTerm => real((a + b) - a),
            Self::CollectedConstants => real((a + d.lit(1.0)) + d.lit(1.0)),
            Self::ProductLessTerm => real(a * b - c),
            Self::ProductLessProduct => real(a * b - b * c),
            Self::CommonFactor => real(a * b + a * c),
            Self::CommonDivisor => real(a / c + b / c),
            Self::QuotientTimesDivisor => real((a / b) * b),
            Self::RootSquared => {
                let root = d.sqrt(d.abs(a));
                real(root * root)
            }
            Self::ProductsInOrder => truth(d.le(b * c, a * b)),
            Self::Lesser => real(d.select(d.lt(a, b), a, b)),
            Self::EqualToItself => truth(d.eq(a, a)),
        }
    }

    /// What it has to be tried on: the operands of every operation on three real numbers.
    pub fn operands() -> Vec<[u32; 3]> {
        operands::of_kinds(&[Kind::Real; 3])
    }

    /// What has to come out.
    pub fn answer(self, operands: [u32; 3]) -> Answer {
        let Uint(bits) = self.evaluate(Scalar::new(&Buffers::EMPTY), operands.map(f32::from_bits));
        Answer::real(bits)
    }
}
