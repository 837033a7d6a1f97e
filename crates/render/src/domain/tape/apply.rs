//! Operations by their name: the inverse of recording. Folding and evaluation do it over the scalar domain.

use super::node::Op;
use crate::domain::{Buffers, Domain, Scalar, Uint};

impl Op {
    /// The domain's operation. Operands and result are bits, truth values 0 and 1; a select chooses between words.
    pub fn apply<D: Domain>(self, d: D, [i, j, k]: [D::U; 3]) -> D::U {
        let [a, b, c] = [i, j, k].map(|bits| d.from_bits(bits));
        let [p, q] = [i, j].map(|bit| d.lt_u(d.uint(0), bit));
        let real = |value| d.to_bits(value);
        let truth = |value| d.select_u(value, d.uint(1), d.uint(0));
        match self {
            Self::Add => real(a + b),
            Self::Sub => real(a - b),
            Self::Mul => real(a * b),
            Self::Div => real(a / b),
            Self::Neg => real(-a),
            Self::Sqrt => real(d.sqrt(a)),
            Self::Min => real(d.min(a, b)),
            Self::Max => real(d.max(a, b)),
            Self::Abs => real(d.abs(a)),
            Self::Floor => real(d.floor(a)),
            Self::Fma => real(d.fma(a, b, c)),
            Self::Copysign => real(d.copysign(a, b)),
            Self::Lt => truth(d.lt(a, b)),
            Self::Le => truth(d.le(a, b)),
            Self::Eq => truth(d.eq(a, b)),
            Self::AddU => i + j,
            Self::SubU => i - j,
            Self::MulU => i * j,
            Self::AndU => i & j,
            Self::OrU => i | j,
            Self::XorU => i ^ j,
            Self::ShlU(by) => i << by,
            Self::ShrU(by) => i >> by,
            Self::ReverseBits => d.reverse_bits(i),
            Self::EqU => truth(d.eq_u(i, j)),
            Self::LtU => truth(d.lt_u(i, j)),
            Self::ToUint => d.to_uint(a),
            Self::ToReal => real(d.to_real(i)),
            Self::ToBits | Self::FromBits => real(a),
            Self::And => truth(p & q),
            Self::Or => truth(p | q),
            Self::Not => truth(!p),
            Self::Select => d.select_u(p, j, k),
        }
    }
}

/// The bits of an operation's result.
pub(super) fn apply(op: Op, operands: [u32; 3]) -> u32 {
    op.apply(Scalar::new(&Buffers::EMPTY), operands.map(Uint)).0
}
