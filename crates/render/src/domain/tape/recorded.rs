//! What has been recorded: nodes, each once, and the branches that enclose them.

use std::cell::RefCell;
use std::collections::HashMap;

use super::node::{Id, Kind, Node, Op};
use super::parameter::Parameter;

/// Expressions, in the order in which they were recorded; operands come before what uses them.
#[derive(Debug, Default)]
pub struct Tape {
    pub(super) recorded: RefCell<Recorded>,
}

/// A branch: what its two sides yield.
#[derive(Clone, Debug)]
pub(super) struct Branch {
    pub(super) mask: Id,
    /// The values of each choice: where the mask holds, and elsewhere.
    pub(super) sides: Vec<[Id; 2]>,
}

/// What a tape holds.
#[derive(Debug, Default)]
pub(super) struct Recorded {
    pub(super) nodes: Vec<Node>,
    pub(super) kinds: Vec<Kind>,
    pub(super) numbers: HashMap<Node, Id>,
    pub(super) branches: Vec<Branch>,
    pub(super) parameters: Vec<Parameter>,
    /// The branch whose sides are being chosen between.
    pub(super) choosing: Option<Id>,
}

impl Recorded {
    /// The number of a node, recorded if it is new.
    pub(super) fn intern(&mut self, node: Node, kind: Kind) -> Id {
        if let Some(&id) = self.numbers.get(&node) {
            return id;
        }
        let id = Id::new(self.nodes.len());
        self.nodes.push(node);
        self.kinds.push(kind);
        self.numbers.insert(node, id);
        id
    }

    pub(super) fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    pub(super) fn kind(&self, id: Id) -> Kind {
        self.kinds[id.index()]
    }

    /// The bits of a constant.
    pub(super) fn constant(&self, id: Id) -> Option<u32> {
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

    pub(super) fn constant_node(&mut self, kind: Kind, bits: u32) -> Id {
        self.intern(Node::Constant { kind, bits }, kind)
    }

    /// Opens the choice between the two sides of a branch; returns the choice that it interrupts.
    pub(super) fn open_choice(&mut self, mask: Id) -> Option<Id> {
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
    pub(super) fn select(&mut self, mask: Id, a: Id, b: Id) -> Id {
        let Some(branch) = self.choosing else {
            return self.apply(Op::Select, [mask, a, b]);
        };
        let Node::Branch(index) = self.node(branch) else {
            unreachable!("choices are of branches")
        };
        let index = index as usize;
        // What `choose` itself computes is not part of either side.
        let of_sides = self.branches[index].mask == mask && a < branch && b < branch;
        if !of_sides || a == b || self.is_mask_again(a, b) {
            return self.apply(Op::Select, [mask, a, b]);
        }
        let sides = &mut self.branches[index].sides;
        let side = sides
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
                place: side as u32,
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
}
