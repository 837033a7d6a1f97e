//! Functions, evaluated: the oracle that says whether a recording computes what the formula does.

use super::apply::apply;
use super::function::{Function, Statement};
use super::node::{Id, Node};
use super::parameter::ParameterKind;
use crate::domain::Buffers;

/// A run of a function.
struct Run<'a> {
    function: &'a Function,
    buffers: &'a Buffers<'a>,
    /// The components of the parameters, and where each parameter's start.
    arguments: &'a [u32],
    starts: Vec<usize>,
    /// The bits of what has been computed and is in scope.
    values: Vec<Option<u32>>,
}

impl Function {
    /// The components of the outputs for these components of the parameters, as bits. It computes as the scalar
    /// domain does, statement by statement.
    ///
    /// # Panics
    /// If the number of arguments is wrong, or a statement reads what is not in scope.
    pub fn evaluate(&self, buffers: &Buffers<'_>, arguments: &[u32]) -> Vec<u32> {
        let mut components = 0;
        let starts = self.parameters.iter().map(|parameter| {
            let start = components;
            components += match parameter.kind {
                ParameterKind::Real | ParameterKind::Word | ParameterKind::Truth => 1,
                ParameterKind::Vector => 3,
            };
            start
        });
        let starts = starts.collect();
        assert_eq!(components, arguments.len(), "one argument a component");
        let values = vec![None; self.nodes()];
        let mut run = Run {
            function: self,
            buffers,
            arguments,
            starts,
            values,
        };
        run.block(&self.body);
        let outputs = self.outputs.iter().flat_map(|output| &output.values);
        outputs.map(|&id| run.value(id)).collect()
    }
}

impl Run<'_> {
    fn value(&self, id: Id) -> u32 {
        match self.function.node(id) {
            Node::Constant { bits, .. } => bits,
            Node::Parameter {
                parameter,
                component,
            } => {
                let start = self.starts[parameter as usize];
                self.arguments[start + usize::from(component.unwrap_or(0))]
            }
            node @ (Node::Apply { .. }
            | Node::Load { .. }
            | Node::Opaque(_)
            | Node::Branch(_)
            | Node::Choice { .. }) => {
                self.values[id.index()].unwrap_or_else(|| panic!("{node:?} is not in scope"))
            }
        }
    }

    fn set(&mut self, id: Id, value: u32) {
        let known = self.values[id.index()].replace(value);
        assert_eq!(known, None, "an expression is computed once");
    }

    fn block(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Let(id) => {
                    let value = match self.function.node(*id) {
                        Node::Apply { op, operands } => {
                            apply(op, operands.map(|operand| self.value(operand)))
                        }
                        Node::Load { buffer, index } => {
                            self.buffers.word(buffer, self.value(index))
                        }
                        Node::Opaque(constant) => self.value(constant),
                        node @ (Node::Constant { .. }
                        | Node::Parameter { .. }
                        | Node::Branch(_)
                        | Node::Choice { .. }) => panic!("{node:?} is no statement"),
                    };
                    self.set(*id, value);
                }
                Statement::If {
                    mask,
                    choices,
                    then,
                    otherwise,
                } => {
                    let holds = self.value(*mask) != 0;
                    let outside = self.values.clone();
                    self.block(if holds { then } else { otherwise });
                    let chosen = choices.iter().map(|choice| {
                        self.value(if holds { choice.then } else { choice.otherwise })
                    });
                    let chosen: Vec<u32> = chosen.collect();
                    self.values = outside;
                    for (choice, value) in choices.iter().zip(chosen) {
                        self.set(choice.id, value);
                    }
                }
            }
        }
    }
}
