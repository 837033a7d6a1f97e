//! The domain whose numbers are expressions.

use std::fmt;
use std::marker::PhantomData;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Shl, Shr, Sub};

use super::node::{Id, Kind, Node, Op};
use super::parameter::{Parameter, ParameterKind};
use super::recorded::{Recorded, Tape};
use crate::domain::{Buffer, Bundle, Domain};
use crate::math::Vec3;
use crate::math::vec3::vec3;

/// The domain of expressions on a tape.
#[derive(Clone, Copy, Debug)]
pub struct Record<'t> {
    tape: &'t Tape,
}

/// An expression on a tape; `K` is `f32`, `u32` or `bool`.
pub struct Expr<'t, K> {
    tape: &'t Tape,
    id: Id,
    kind: PhantomData<fn() -> K>,
}

/// A real number.
pub type Real<'t> = Expr<'t, f32>;
/// An unsigned integer.
pub type Word<'t> = Expr<'t, u32>;
/// A truth value.
pub type Truth<'t> = Expr<'t, bool>;

impl<K> Clone for Expr<'_, K> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<K> Copy for Expr<'_, K> {}

impl<K> fmt::Debug for Expr<'_, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.id.fmt(f)
    }
}

impl<'t, K> Expr<'t, K> {
    pub(super) fn new(tape: &'t Tape, id: Id) -> Self {
        Self {
            tape,
            id,
            kind: PhantomData,
        }
    }

    pub(super) fn id(self) -> Id {
        self.id
    }

    pub(super) fn tape(self) -> &'t Tape {
        self.tape
    }

    fn apply<R>(self, op: Op, b: Id, c: Id) -> Expr<'t, R> {
        let id = self.tape.recorded.borrow_mut().apply(op, [self.id, b, c]);
        Expr::new(self.tape, id)
    }

    fn unary<R>(self, op: Op) -> Expr<'t, R> {
        self.apply(op, self.id, self.id)
    }

    fn binary<R>(self, op: Op, other: Self) -> Expr<'t, R> {
        self.apply(op, other.id, self.id)
    }
}

macro_rules! operators {
    ($kind:ty: $($trait:ident $method:ident $op:ident),*) => {$(
        impl $trait for Expr<'_, $kind> {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                self.binary(Op::$op, other)
            }
        }
    )*};
}
operators!(f32: Add add Add, Sub sub Sub, Mul mul Mul, Div div Div);
operators!(u32: Add add AddU, Sub sub SubU, Mul mul MulU, BitAnd bitand AndU, BitOr bitor OrU, BitXor bitxor XorU);
operators!(bool: BitAnd bitand And, BitOr bitor Or);

impl Neg for Expr<'_, f32> {
    type Output = Self;
    fn neg(self) -> Self {
        self.unary(Op::Neg)
    }
}
impl Not for Expr<'_, bool> {
    type Output = Self;
    fn not(self) -> Self {
        self.unary(Op::Not)
    }
}
impl Shl<u32> for Expr<'_, u32> {
    type Output = Self;
    fn shl(self, by: u32) -> Self {
        assert!(by < 32, "shifts are by less than 32");
        self.unary(Op::ShlU(by))
    }
}
impl Shr<u32> for Expr<'_, u32> {
    type Output = Self;
    fn shr(self, by: u32) -> Self {
        assert!(by < 32, "shifts are by less than 32");
        self.unary(Op::ShrU(by))
    }
}

impl Tape {
    fn parameter(&self, name: &'static str, kind: ParameterKind) -> u32 {
        let mut recorded = self.recorded.borrow_mut();
        recorded.parameters.push(Parameter { name, kind });
        recorded.parameters.len() as u32 - 1
    }

    fn component<K>(&self, parameter: u32, component: Option<u8>, kind: Kind) -> Expr<'_, K> {
        let node = Node::Parameter {
            parameter,
            component,
        };
        Expr::new(self, self.recorded.borrow_mut().intern(node, kind))
    }

    /// The function's next parameter: a real number.
    pub fn real(&self, name: &'static str) -> Real<'_> {
        self.component(self.parameter(name, ParameterKind::Real), None, Kind::Real)
    }

    /// The function's next parameter: an unsigned integer.
    pub fn word(&self, name: &'static str) -> Word<'_> {
        self.component(self.parameter(name, ParameterKind::Word), None, Kind::Word)
    }

    /// The function's next parameter: three real numbers.
    pub fn vector(&self, name: &'static str) -> Vec3<Real<'_>> {
        let parameter = self.parameter(name, ParameterKind::Vector);
        let [x, y, z] = [0, 1, 2].map(|k| self.component(parameter, Some(k), Kind::Real));
        vec3(x, y, z)
    }
}

impl<'t> Record<'t> {
    /// The domain that records on this tape.
    pub fn new(tape: &'t Tape) -> Self {
        Self { tape }
    }

    fn record<K>(self, record: impl FnOnce(&mut Recorded) -> Id) -> Expr<'t, K> {
        let id = record(&mut self.tape.recorded.borrow_mut());
        Expr::new(self.tape, id)
    }

    fn choose<K>(self, mask: Truth<'t>, a: Expr<'t, K>, b: Expr<'t, K>) -> Expr<'t, K> {
        self.record(|recorded| recorded.select(mask.id, a.id, b.id))
    }
}

impl<'t> Domain for Record<'t> {
    type F = Real<'t>;
    type U = Word<'t>;
    type M = Truth<'t>;

    fn lit(self, value: f64) -> Self::F {
        let rounded = value as f32;
        assert!(
            rounded.is_finite(),
            "{value} cannot be recorded: constants are finite"
        );
        self.record(|recorded| recorded.constant_node(Kind::Real, rounded.to_bits()))
    }
    fn uint(self, value: u32) -> Self::U {
        self.record(|recorded| recorded.constant_node(Kind::Word, value))
    }
    fn truth(self, value: bool) -> Self::M {
        self.record(|recorded| recorded.constant_node(Kind::Truth, value.into()))
    }
    fn sqrt(self, a: Self::F) -> Self::F {
        a.unary(Op::Sqrt)
    }
    fn min(self, a: Self::F, b: Self::F) -> Self::F {
        a.binary(Op::Min, b)
    }
    fn max(self, a: Self::F, b: Self::F) -> Self::F {
        a.binary(Op::Max, b)
    }
    fn abs(self, a: Self::F) -> Self::F {
        a.unary(Op::Abs)
    }
    fn floor(self, a: Self::F) -> Self::F {
        a.unary(Op::Floor)
    }
    fn fma(self, a: Self::F, b: Self::F, c: Self::F) -> Self::F {
        a.apply(Op::Fma, b.id, c.id)
    }
    fn copysign(self, a: Self::F, b: Self::F) -> Self::F {
        a.binary(Op::Copysign, b)
    }
    fn lt(self, a: Self::F, b: Self::F) -> Self::M {
        a.binary(Op::Lt, b)
    }
    fn le(self, a: Self::F, b: Self::F) -> Self::M {
        a.binary(Op::Le, b)
    }
    fn eq(self, a: Self::F, b: Self::F) -> Self::M {
        a.binary(Op::Eq, b)
    }
    fn eq_u(self, a: Self::U, b: Self::U) -> Self::M {
        a.binary(Op::EqU, b)
    }
    fn lt_u(self, a: Self::U, b: Self::U) -> Self::M {
        a.binary(Op::LtU, b)
    }
    fn select(self, mask: Self::M, a: Self::F, b: Self::F) -> Self::F {
        self.choose(mask, a, b)
    }
    fn select_u(self, mask: Self::M, a: Self::U, b: Self::U) -> Self::U {
        self.choose(mask, a, b)
    }
    fn select_mask(self, mask: Self::M, a: Self::M, b: Self::M) -> Self::M {
        self.choose(mask, a, b)
    }
    fn to_uint(self, a: Self::F) -> Self::U {
        a.unary(Op::ToUint)
    }
    fn to_real(self, a: Self::U) -> Self::F {
        a.unary(Op::ToReal)
    }
    fn to_bits(self, a: Self::F) -> Self::U {
        a.unary(Op::ToBits)
    }
    fn from_bits(self, a: Self::U) -> Self::F {
        a.unary(Op::FromBits)
    }
    fn reverse_bits(self, a: Self::U) -> Self::U {
        a.unary(Op::ReverseBits)
    }
    fn load(self, buffer: Buffer, index: Self::U) -> Self::U {
        let node = Node::Load {
            buffer,
            index: index.id,
        };
        self.record(|recorded| recorded.intern(node, Kind::Word))
    }
    fn uniform(self, buffer: Buffer, index: u32) -> Self::U {
        self.load(buffer, self.uint(index))
    }
    fn branch<T: Bundle<Self>>(
        self,
        mask: Self::M,
        a: impl FnOnce() -> T,
        b: impl FnOnce() -> T,
    ) -> T {
        let known = self.tape.recorded.borrow().constant(mask.id);
        match known {
            Some(0) => b(),
            Some(_) => a(),
            None => {
                let (a, b) = (a(), b());
                let interrupted = self.tape.recorded.borrow_mut().open_choice(mask.id);
                let chosen = T::choose(self, mask, a, b);
                self.tape.recorded.borrow_mut().choosing = interrupted;
                chosen
            }
        }
    }
}
