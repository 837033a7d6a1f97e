//! The recording domain: numbers are expressions on a tape, from which other languages are printed.
//!
//! A formula run over [`Record`] leaves its operations on a [`Tape`]. Every operation is pure and buffers are
//! read-only, so an expression stands for its value wherever it is used: equal expressions are one node, and
//! none belongs to the block in which it was recorded. [`Tape::function`] then schedules what the outputs need,
//! each expression in the innermost block that encloses all its uses: nothing is computed that is not needed, and
//! no block reads what another one computed.
//!
//! [`Domain::branch`](super::Domain::branch) records both sides and chooses between them with `Bundle::choose`,
//! during which a select on the branch's mask makes a [`Node::Choice`]: a variable that both blocks assign.
//!
//! **Contract.** Values are finite, and the sign of zero is not kept: `x + 0` is `x` and `x·0` is 0. A constant
//! operation whose result is not finite stays on the tape, its first operand behind a [`Node::Opaque`].

mod apply;
mod evaluate;
mod function;
mod node;
mod parameter;
mod record;
mod recorded;
mod simplify;

pub use function::{Choice, Function, Output, Outputs, Statement};
pub use node::{Id, Kind, Node, Op};
pub use parameter::{Parameter, ParameterKind};
pub use record::{Expr, Real, Record, Truth, Word};
pub use recorded::Tape;
