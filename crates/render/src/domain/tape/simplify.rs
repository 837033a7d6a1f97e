//! Recording of operations: constants are folded, and what changes nothing is left out.
//!
//! Each identity gives the same bits as the operation it replaces, under the tape's contract: values are finite
//! and the sign of zero is not kept.

use super::apply::apply;
use super::node::{Id, Kind, Node, Op};
use super::recorded::Recorded;

const ZERO: u32 = 0;
const MINUS_ZERO: u32 = 0x8000_0000;
const ONE: u32 = 0x3f80_0000;

impl Recorded {
    /// Records an operation. Operands beyond its arity are ignored.
    pub(super) fn apply(&mut self, op: Op, mut operands: [Id; 3]) -> Id {
        for unused in op.arity()..3 {
            operands[unused] = operands[0];
        }
        if op.commutes() {
            // Constants last, so that identities look for them in one place.
            let key = |id: Id| (self.constant(id).is_some(), id);
            if key(operands[1]) < key(operands[0]) {
                operands.swap(0, 1);
                if op.arity() == 2 {
                    operands[2] = operands[0];
                }
            }
        }
        let kind = op.kind().unwrap_or_else(|| self.kind(operands[1]));
        if let [Some(a), Some(b), Some(c)] = operands.map(|id| self.constant(id)) {
            let bits = apply(op, [a, b, c]);
            if kind != Kind::Real || f32::from_bits(bits).is_finite() {
                return self.constant_node(kind, bits);
            }
            return self.apply_unfolded(op, kind, operands);
        }
        match self.identity(op, operands) {
            Some(id) => id,
            None => self.intern(Node::Apply { op, operands }, kind),
        }
    }

    /// A constant operation without a finite value: it happens when the program runs.
    fn apply_unfolded(&mut self, op: Op, kind: Kind, mut operands: [Id; 3]) -> Id {
        let first = operands[0];
        let hidden = self.intern(Node::Opaque(first), self.kind(first));
        operands[0] = hidden;
        for operand in &mut operands[op.arity()..] {
            *operand = hidden;
        }
        self.intern(Node::Apply { op, operands }, kind)
    }

    /// The operation and operands of an expression that is one.
    fn applied(&self, id: Id) -> Option<(Op, [Id; 3])> {
        match self.node(id) {
            Node::Apply { op, operands } => Some((op, operands)),
            Node::Constant { .. }
            | Node::Parameter { .. }
            | Node::Load { .. }
            | Node::Opaque(_)
            | Node::Branch(_)
            | Node::Choice { .. } => None,
        }
    }

    /// `x` if the expression is `op` applied to `x`.
    fn operand_of(&self, id: Id, op: Op) -> Option<Id> {
        self.applied(id)
            .and_then(|(applied, [x, ..])| (applied == op).then_some(x))
    }

    fn is_zero(&self, id: Id) -> bool {
        matches!(self.constant(id), Some(ZERO | MINUS_ZERO))
    }

    fn is_one(&self, id: Id) -> bool {
        self.constant(id) == Some(ONE)
    }

    fn identity(&mut self, op: Op, operands: [Id; 3]) -> Option<Id> {
        match op {
            Op::Add
            | Op::Sub
            | Op::Mul
            | Op::Div
            | Op::Neg
            | Op::Min
            | Op::Max
            | Op::Abs
            | Op::Floor
            | Op::Fma => self.real_identity(op, operands),
            Op::AddU
            | Op::SubU
            | Op::MulU
            | Op::AndU
            | Op::OrU
            | Op::XorU
            | Op::ShlU(_)
            | Op::ShrU(_) => self.word_identity(op, operands),
            Op::And | Op::Or | Op::Not | Op::Select => self.truth_identity(op, operands),
            Op::ReverseBits => self.operand_of(operands[0], Op::ReverseBits),
            Op::ToBits => self.operand_of(operands[0], Op::FromBits),
            Op::FromBits => self.operand_of(operands[0], Op::ToBits),
            // −0 = 0, −0 < 0 is false, and so on: comparisons do not see the sign of zero.
            Op::Sqrt
            | Op::Copysign
            | Op::Lt
            | Op::Le
            | Op::Eq
            | Op::EqU
            | Op::LtU
            | Op::ToUint
            | Op::ToReal => None,
        }
    }

    fn real_identity(&mut self, op: Op, [a, b, c]: [Id; 3]) -> Option<Id> {
        let negated = |this: &Self, id| this.operand_of(id, Op::Neg);
        match op {
            Op::Add if self.is_zero(b) => Some(a),
            // x + (−y) is x − y, bit for bit; and the like.
            Op::Add => match (negated(self, a), negated(self, b)) {
                (_, Some(y)) => Some(self.apply(Op::Sub, [a, y, a])),
                (Some(x), None) => Some(self.apply(Op::Sub, [b, x, b])),
                (None, None) => None,
            },
            Op::Sub if self.is_zero(b) => Some(a),
            Op::Sub if self.is_zero(a) => Some(self.apply(Op::Neg, [b; 3])),
            Op::Sub => negated(self, b).map(|y| self.apply(Op::Add, [a, y, a])),
            Op::Mul if self.is_one(b) => Some(a),
            Op::Mul if self.is_zero(b) => Some(self.constant_node(Kind::Real, ZERO)),
            Op::Div if self.is_one(b) => Some(a),
            // A constant 0 ÷ x: x is not 0, for the quotient is finite.
            Op::Div if self.is_zero(a) => Some(self.constant_node(Kind::Real, ZERO)),
            Op::Neg => negated(self, a),
            Op::Min | Op::Max if a == b => Some(a),
            Op::Abs => match self.applied(a) {
                Some((Op::Neg, [x, ..])) => Some(self.apply(Op::Abs, [x; 3])),
                Some((Op::Abs, _)) => Some(a),
                _ => None,
            },
            Op::Floor => self.operand_of(a, Op::Floor).map(|_| a),
            // One rounding each way: x·1 is exact, and so is adding 0.
            Op::Fma if self.is_zero(b) => Some(c),
            Op::Fma if self.is_one(b) => Some(self.apply(Op::Add, [a, c, a])),
            Op::Fma if self.is_zero(c) => Some(self.apply(Op::Mul, [a, b, a])),
            _ => None,
        }
    }

    fn word_identity(&mut self, op: Op, [a, b, _]: [Id; 3]) -> Option<Id> {
        let right = self.constant(b);
        match (op, right) {
            (Op::AddU | Op::SubU | Op::OrU | Op::XorU, Some(0)) => Some(a),
            (Op::MulU, Some(1)) | (Op::AndU, Some(u32::MAX)) => Some(a),
            (Op::MulU | Op::AndU, Some(0)) => Some(b),
            (Op::ShlU(0) | Op::ShrU(0), _) => Some(a),
            // (x + m) + n = x + (m + n): addition wraps.
            (Op::AddU, Some(_)) => match self.applied(a) {
                Some((Op::AddU, [x, m, _])) if self.constant(m).is_some() => {
                    let sum = self.apply(Op::AddU, [m, b, m]);
                    Some(self.apply(Op::AddU, [x, sum, x]))
                }
                _ => None,
            },
            _ => None,
        }
    }

    fn truth_identity(&mut self, op: Op, [a, b, c]: [Id; 3]) -> Option<Id> {
        match op {
            Op::And | Op::Or if a == b => Some(a),
            Op::And => self.constant(b).map(|truth| if truth != 0 { a } else { b }),
            Op::Or => self.constant(b).map(|truth| if truth != 0 { b } else { a }),
            Op::Not => self.operand_of(a, Op::Not),
            Op::Select if b == c => Some(b),
            Op::Select => {
                if let Some(mask) = self.constant(a) {
                    return Some(if mask != 0 { b } else { c });
                }
                if let Some(mask) = self.operand_of(a, Op::Not) {
                    return Some(self.apply(Op::Select, [mask, c, b]));
                }
                if let Some((Op::Select, [mask, x, _])) = self.applied(b)
                    && mask == a
                {
                    return Some(self.apply(Op::Select, [a, x, c]));
                }
                if let Some((Op::Select, [mask, _, y])) = self.applied(c)
                    && mask == a
                {
                    return Some(self.apply(Op::Select, [a, b, y]));
                }
                self.truth_select(a, b, c)
            }
            _ => None,
        }
    }

    /// A select between truth values of which one is constant.
    fn truth_select(&mut self, mask: Id, b: Id, c: Id) -> Option<Id> {
        if self.kind(b) != Kind::Truth {
            return None;
        }
        let and_or = |this: &mut Self, op, negate: bool, other| {
            let mask = if negate {
                this.apply(Op::Not, [mask; 3])
            } else {
                mask
            };
            this.apply(op, [mask, other, mask])
        };
        match (self.constant(b), self.constant(c)) {
            (Some(0), _) => Some(and_or(self, Op::And, true, c)),
            (Some(_), _) => Some(and_or(self, Op::Or, false, c)),
            (_, Some(0)) => Some(and_or(self, Op::And, false, b)),
            (_, Some(_)) => Some(and_or(self, Op::Or, true, b)),
            (None, None) => None,
        }
    }
}
