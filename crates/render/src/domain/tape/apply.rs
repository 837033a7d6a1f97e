//! Operations on bits, by the scalar domain: what folding and evaluation have in common.

use super::node::Op;
use crate::domain::{Buffers, Domain, Scalar, Uint};

/// The bits of an operation's result.
pub(super) fn apply(op: Op, operands: [u32; 3]) -> u32 {
    let d = Scalar::new(&Buffers::EMPTY);
    let [a, b, c] = operands.map(f32::from_bits);
    let [i, j, k] = operands.map(Uint);
    let [p, q, _] = operands.map(|bits| bits != 0);
    let real = f32::to_bits;
    match op {
        Op::Add => real(a + b),
        Op::Sub => real(a - b),
        Op::Mul => real(a * b),
        Op::Div => real(a / b),
        Op::Neg => real(-a),
        Op::Sqrt => real(d.sqrt(a)),
        Op::Min => real(d.min(a, b)),
        Op::Max => real(d.max(a, b)),
        Op::Abs => real(d.abs(a)),
        Op::Floor => real(d.floor(a)),
        Op::Fma => real(d.fma(a, b, c)),
        Op::Copysign => real(d.copysign(a, b)),
        Op::Lt => u32::from(d.lt(a, b)),
        Op::Le => u32::from(d.le(a, b)),
        Op::Eq => u32::from(d.eq(a, b)),
        Op::AddU => (i + j).0,
        Op::SubU => (i - j).0,
        Op::MulU => (i * j).0,
        Op::AndU => (i & j).0,
        Op::OrU => (i | j).0,
        Op::XorU => (i ^ j).0,
        Op::ShlU(by) => (i << by).0,
        Op::ShrU(by) => (i >> by).0,
        Op::ReverseBits => d.reverse_bits(i).0,
        Op::EqU => u32::from(d.eq_u(i, j)),
        Op::LtU => u32::from(d.lt_u(i, j)),
        Op::ToUint => d.to_uint(a).0,
        Op::ToReal => real(d.to_real(i)),
        // Bits are bits.
        Op::ToBits | Op::FromBits => i.0,
        Op::And => u32::from(p & q),
        Op::Or => u32::from(p | q),
        Op::Not => u32::from(!p),
        Op::Select => d.select_u(p, j, k).0,
    }
}
