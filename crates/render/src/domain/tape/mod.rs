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
mod record;
mod simplify;

use std::cell::RefCell;
use std::collections::HashMap;

pub use function::{Choice, Function, Output, Outputs, Parameter, ParameterKind, Statement};
pub use node::{Id, Kind, Node, Op};
pub use record::{Expr, Real, Record, Truth, Word};

use crate::math::Vec3;
use crate::math::vec3::vec3;

/// Expressions, in the order in which they were recorded; operands come before what uses them.
#[derive(Debug, Default)]
pub struct Tape {
    recorded: RefCell<Recorded>,
}

/// A branch: what its two sides yield.
#[derive(Clone, Debug)]
struct Branch {
    mask: Id,
    /// The values of each choice: where the mask holds, and elsewhere.
    sides: Vec<[Id; 2]>,
}

#[derive(Debug, Default)]
struct Recorded {
    nodes: Vec<Node>,
    kinds: Vec<Kind>,
    numbers: HashMap<Node, Id>,
    branches: Vec<Branch>,
    parameters: Vec<Parameter>,
    /// The branch whose sides are being chosen between.
    choosing: Option<Id>,
}

impl Recorded {
    /// The number of a node, recorded if it is new.
    fn intern(&mut self, node: Node, kind: Kind) -> Id {
        if let Some(&id) = self.numbers.get(&node) {
            return id;
        }
        let id = Id::new(self.nodes.len());
        self.nodes.push(node);
        self.kinds.push(kind);
        self.numbers.insert(node, id);
        id
    }

    fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    fn kind(&self, id: Id) -> Kind {
        self.kinds[id.index()]
    }

    /// The bits of a constant.
    fn constant(&self, id: Id) -> Option<u32> {
        match self.node(id) {
            Node::Constant { bits, .. } => Some(bits),
            Node::Parameter { .. }
            | Node::Apply { .. }
            | Node::Load { .. }
            | Node::Opaque(_)
            | Node::Branch(_)
            | Node::Choice { .. } => None,
        }
    }

    fn constant_node(&mut self, kind: Kind, bits: u32) -> Id {
        self.intern(Node::Constant { kind, bits }, kind)
    }

    /// Opens the choice between the two sides of a branch; returns the choice that it interrupts.
    fn open_choice(&mut self, mask: Id) -> Option<Id> {
        let branch = self.branches.len() as u32;
        self.branches.push(Branch {
            mask,
            sides: Vec::new(),
        });
        // Two branches are never equal, so this always makes a new node.
        let id = self.intern(Node::Branch(branch), Kind::Truth);
        self.choosing.replace(id)
    }

    /// `a` where the mask holds, else `b`: an operation, or a choice of the branch that is being closed.
    fn select(&mut self, mask: Id, a: Id, b: Id) -> Id {
        let Some(branch) = self.choosing else {
            return self.apply(Op::Select, [mask, a, b]);
        };
        let Node::Branch(number) = self.node(branch) else {
            unreachable!("choices are of branches")
        };
        let number = number as usize;
        // What `choose` itself computes is not part of either side.
        let of_sides = self.branches[number].mask == mask && a < branch && b < branch;
        if !of_sides || a == b || self.is_mask_again(a, b) {
            return self.apply(Op::Select, [mask, a, b]);
        }
        let sides = &mut self.branches[number].sides;
        let place = sides
            .iter()
            .position(|known| *known == [a, b])
            .unwrap_or_else(|| {
                sides.push([a, b]);
                sides.len() - 1
            });
        let kind = self.kind(a);
        self.intern(
            Node::Choice {
                branch,
                place: place as u32,
            },
            kind,
        )
    }

    /// The two sides are the two constant truth values.
    fn is_mask_again(&self, a: Id, b: Id) -> bool {
        self.kind(a) == Kind::Truth && self.constant(a).is_some() && self.constant(b).is_some()
    }
}

impl Tape {
    /// An empty tape.
    pub fn new() -> Self {
        Self::default()
    }

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

    /// What computes these outputs from the parameters.
    pub fn function(&self, name: impl Into<String>, outputs: Outputs<'_>) -> Function {
        function::schedule(&self.recorded.borrow(), name.into(), outputs.finish(self))
    }
}
