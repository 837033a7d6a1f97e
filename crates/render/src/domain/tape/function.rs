//! Functions: what is needed of a tape, in the order and the blocks in which it is computed.

use super::node::{Id, Kind, Node};
use super::parameter::{Parameter, ParameterKind};
use super::record::{Expr, Real, Truth, Word};
use super::recorded::{Recorded, Tape};
use crate::math::Vec3;

/// One value that a function yields.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Output {
    /// Its name, `snake_case`.
    pub name: &'static str,
    /// What it is.
    pub kind: ParameterKind,
    /// Its component, or three of them.
    pub values: Vec<Id>,
}

/// What a function yields, in order.
#[derive(Clone, Debug, Default)]
pub struct Outputs<'t> {
    outputs: Vec<Output>,
    tape: Option<&'t Tape>,
}

impl<'t> Outputs<'t> {
    /// Nothing yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// There are none.
    pub fn is_empty(&self) -> bool {
        self.outputs.is_empty()
    }

    fn push<K>(
        mut self,
        name: &'static str,
        kind: ParameterKind,
        tape: &'t Tape,
        values: &[Expr<'t, K>],
    ) -> Self {
        assert!(
            self.tape.is_none_or(|known| std::ptr::eq(known, tape)),
            "outputs are of one tape"
        );
        self.tape = Some(tape);
        self.outputs.push(Output {
            name,
            kind,
            values: values.iter().map(|v| v.id()).collect(),
        });
        self
    }

    /// And a real number.
    #[must_use]
    pub fn real(self, name: &'static str, value: Real<'t>) -> Self {
        self.push(name, ParameterKind::Real, value.tape(), &[value])
    }

    /// And an unsigned integer.
    #[must_use]
    pub fn word(self, name: &'static str, value: Word<'t>) -> Self {
        self.push(name, ParameterKind::Word, value.tape(), &[value])
    }

    /// And a truth value.
    #[must_use]
    pub fn truth(self, name: &'static str, value: Truth<'t>) -> Self {
        self.push(name, ParameterKind::Truth, value.tape(), &[value])
    }

    /// And three real numbers.
    #[must_use]
    pub fn vector(self, name: &'static str, value: Vec3<Real<'t>>) -> Self {
        let tape = value.x.tape();
        self.push(
            name,
            ParameterKind::Vector,
            tape,
            &[value.x, value.y, value.z],
        )
    }

    fn finish(self, tape: &Tape) -> Vec<Output> {
        assert!(
            self.tape.is_none_or(|known| std::ptr::eq(known, tape)),
            "a function's outputs are of its tape"
        );
        self.outputs
    }
}

/// What one statement does.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Statement {
    /// Computes an expression.
    Let(Id),
    /// Computes one block or the other, and its choices.
    If {
        /// The condition.
        mask: Id,
        /// The values it yields.
        choices: Vec<Choice>,
        /// Where the mask holds.
        then: Vec<Statement>,
        /// Elsewhere.
        otherwise: Vec<Statement>,
    },
}

/// A value that an `if` yields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The expression that stands for it after the `if`.
    pub id: Id,
    /// Where the mask holds.
    pub then: Id,
    /// Elsewhere.
    pub otherwise: Id,
}

/// A recorded function.
#[derive(Clone, Debug)]
pub struct Function {
    /// Its name, `snake_case`.
    pub name: String,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// What it computes.
    pub body: Vec<Statement>,
    /// What it yields.
    pub outputs: Vec<Output>,
    nodes: Vec<Node>,
    kinds: Vec<Kind>,
}

impl Function {
    /// An expression.
    pub fn node(&self, id: Id) -> Node {
        self.nodes[id.index()]
    }

    /// What an expression is.
    pub fn kind(&self, id: Id) -> Kind {
        self.kinds[id.index()]
    }

    /// How many expressions there are on its tape, needed or not.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }
}

/// A block of statements, while it is being filled.
#[derive(Default)]
struct Block {
    parent: usize,
    depth: usize,
    /// What stands in it, last first.
    nodes: Vec<Id>,
}

/// Places every needed expression in the innermost block that encloses all its uses.
struct Schedule<'a> {
    recorded: &'a Recorded,
    blocks: Vec<Block>,
    /// The block of each expression that is needed.
    places: Vec<Option<usize>>,
    /// The blocks of each branch that is needed: where its mask holds, and elsewhere.
    sides: Vec<Option<[usize; 2]>>,
}

const ROOT: usize = 0;

impl Schedule<'_> {
    fn common(&self, mut a: usize, mut b: usize) -> usize {
        while a != b {
            if self.blocks[a].depth < self.blocks[b].depth {
                std::mem::swap(&mut a, &mut b);
            }
            a = self.blocks[a].parent;
        }
        a
    }

    fn use_in(&mut self, block: usize, id: Id) {
        let place = self.places[id.index()].map_or(block, |known| self.common(known, block));
        self.places[id.index()] = Some(place);
    }

    fn open(&mut self, parent: usize) -> usize {
        let depth = self.blocks[parent].depth + 1;
        self.blocks.push(Block {
            parent,
            depth,
            nodes: Vec::new(),
        });
        self.blocks.len() - 1
    }

    /// Places the expression's operands, all of whose other users come later on the tape.
    fn place(&mut self, id: Id, block: usize) {
        let node = self.recorded.node(id);
        match node {
            Node::Constant { .. } | Node::Parameter { .. } => return,
            Node::Apply { op, operands } => {
                for &operand in &operands[..op.arity()] {
                    self.use_in(block, operand);
                }
            }
            Node::Load { index, .. } => self.use_in(block, index),
            Node::Opaque(constant) => self.use_in(block, constant),
            Node::Branch(number) => {
                let sides = [self.open(block), self.open(block)];
                self.sides[number as usize] = Some(sides);
                let branch = &self.recorded.branches[number as usize];
                self.use_in(block, branch.mask);
                for choice in self.choices(id, number) {
                    self.use_in(sides[0], choice.then);
                    self.use_in(sides[1], choice.otherwise);
                }
            }
            // Its branch assigns it.
            Node::Choice { branch, .. } => return self.use_in(block, branch),
        }
        self.blocks[block].nodes.push(id);
    }

    /// The needed choices of a branch.
    fn choices(&self, branch: Id, number: u32) -> Vec<Choice> {
        let sides = self.recorded.branches[number as usize]
            .sides
            .iter()
            .enumerate();
        let choices = sides.map(|(place, &[then, otherwise])| {
            let id = self.recorded.numbers[&Node::Choice {
                branch,
                place: place as u32,
            }];
            Choice {
                id,
                then,
                otherwise,
            }
        });
        choices
            .filter(|choice| self.places[choice.id.index()].is_some())
            .collect()
    }

    fn statements(&self, block: usize) -> Vec<Statement> {
        let statement = |&id: &Id| match self.recorded.node(id) {
            Node::Branch(number) => {
                let sides = self.sides[number as usize].expect("a placed branch has sides");
                Statement::If {
                    mask: self.recorded.branches[number as usize].mask,
                    choices: self.choices(id, number),
                    then: self.statements(sides[0]),
                    otherwise: self.statements(sides[1]),
                }
            }
            Node::Constant { .. }
            | Node::Parameter { .. }
            | Node::Apply { .. }
            | Node::Load { .. }
            | Node::Opaque(_)
            | Node::Choice { .. } => Statement::Let(id),
        };
        self.blocks[block]
            .nodes
            .iter()
            .rev()
            .map(statement)
            .collect()
    }
}

impl Tape {
    /// What computes these outputs from the parameters.
    pub fn function(&self, name: impl Into<String>, outputs: Outputs<'_>) -> Function {
        schedule(&self.recorded.borrow(), name.into(), outputs.finish(self))
    }
}

/// The function that yields `outputs`.
fn schedule(recorded: &Recorded, name: String, outputs: Vec<Output>) -> Function {
    let mut schedule = Schedule {
        recorded,
        blocks: vec![Block::default()],
        places: vec![None; recorded.nodes.len()],
        sides: vec![None; recorded.branches.len()],
    };
    for &value in outputs.iter().flat_map(|output| &output.values) {
        schedule.use_in(ROOT, value);
    }
    for index in (0..recorded.nodes.len()).rev() {
        if let Some(block) = schedule.places[index] {
            schedule.place(Id::new(index), block);
        }
    }
    Function {
        name,
        parameters: recorded.parameters.clone(),
        body: schedule.statements(ROOT),
        outputs,
        nodes: recorded.nodes.clone(),
        kinds: recorded.kinds.clone(),
    }
}
