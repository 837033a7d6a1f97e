//! One recorded function as WGSL.

use residual_render::domain::tape::{
    Choice, Function, Id, Node, Op, Output, ParameterKind, Statement,
};

use crate::arithmetic::{Arithmetic, Division, Fma, Helper, SquareRoot};
use crate::bindings::{self, Bindings};
use crate::names::{constant, kind_name, type_name};

/// Expressions that are used once and no longer than this are written where they are used.
const INLINE: usize = 72;
/// Lines are broken beyond this.
const WIDTH: usize = 100;

/// A function as text, and what it refers to.
pub(super) struct Printed {
    pub(super) text: String,
    pub(super) bindings: Bindings,
}

/// The text of an expression.
#[derive(Clone)]
struct Text {
    text: String,
    /// It may stand as an operand without parentheses.
    primary: bool,
}

struct Printer<'a> {
    function: &'a Function,
    arithmetic: Arithmetic,
    uses: Vec<u32>,
    texts: Vec<Option<Text>>,
    /// How many names have been given out.
    names: usize,
    indent: usize,
    printed: Printed,
}

/// Prints a function. Several outputs are returned as the structure `result`.
pub(super) fn print(function: &Function, result: &str, arithmetic: Arithmetic) -> Printed {
    let mut uses = vec![0; function.nodes()];
    count_uses(function, &function.body, &mut uses);
    for &value in function.outputs.iter().flat_map(|output| &output.values) {
        uses[value.index()] += 1;
    }
    let mut printer = Printer {
        function,
        arithmetic,
        uses,
        texts: vec![None; function.nodes()],
        names: 0,
        indent: 1,
        printed: Printed {
            text: String::new(),
            bindings: Bindings::default(),
        },
    };
    printer.function(result);
    printer.printed
}

fn count_uses(function: &Function, statements: &[Statement], uses: &mut [u32]) {
    for statement in statements {
        match statement {
            Statement::Let(id) => match function.node(*id) {
                Node::Apply { op, operands } => {
                    for operand in &operands[..op.arity()] {
                        uses[operand.index()] += 1;
                    }
                }
                Node::Load { index, .. } => uses[index.index()] += 1,
                Node::Constant { .. }
                | Node::Parameter { .. }
                | Node::Opaque(_)
                | Node::Branch(_)
                | Node::Choice { .. } => {}
            },
            Statement::If {
                mask,
                choices,
                then,
                otherwise,
            } => {
                uses[mask.index()] += 1;
                for choice in choices {
                    uses[choice.then.index()] += 1;
                    uses[choice.otherwise.index()] += 1;
                }
                count_uses(function, then, uses);
                count_uses(function, otherwise, uses);
            }
        }
    }
}

impl Printer<'_> {
    fn line(&mut self, text: &str) {
        for _ in 0..self.indent {
            self.printed.text.push_str("    ");
        }
        self.printed.text.push_str(text);
        self.printed.text.push('\n');
    }

    /// `head(item, item)` in one line, or one item a line.
    fn list(&mut self, head: &str, items: &[String], tail: &str) {
        let line = format!("{head}({}){tail}", items.join(", "));
        if line.len() + 4 * self.indent <= WIDTH {
            return self.line(&line);
        }
        self.line(&format!("{head}("));
        self.indent += 1;
        for item in items {
            self.line(&format!("{item},"));
        }
        self.indent -= 1;
        self.line(&format!("){tail}"));
    }

    fn function(&mut self, result: &str) {
        let function = self.function;
        let parameters = function
            .parameters
            .iter()
            .map(|parameter| format!("{}: {}", parameter.name, type_name(parameter.kind)));
        let parameters: Vec<String> = parameters.collect();
        let result = match &function.outputs[..] {
            [only] => type_name(only.kind),
            _ => result,
        };
        self.indent = 0;
        self.list(
            &format!("fn {}", function.name),
            &parameters,
            &format!(" -> {result} {{"),
        );
        self.indent = 1;
        self.block(&function.body);
        let outputs: Vec<String> = function.outputs.iter().map(|o| self.output(o)).collect();
        match &outputs[..] {
            [only] => self.line(&format!("return {only};")),
            _ => self.list(&format!("return {result}"), &outputs, ";"),
        }
        self.indent = 0;
        self.line("}");
    }

    fn output(&self, output: &Output) -> String {
        let values: Vec<String> = output.values.iter().map(|&id| self.text(id).text).collect();
        match output.kind {
            ParameterKind::Real | ParameterKind::Word | ParameterKind::Truth => values[0].clone(),
            ParameterKind::Vector => format!("vec3f({})", values.join(", ")),
        }
    }

    /// A name for an expression from here on.
    fn name(&mut self, id: Id) -> String {
        let text = format!("v{}", self.names);
        self.names += 1;
        self.texts[id.index()] = Some(Text {
            text: text.clone(),
            primary: true,
        });
        text
    }

    fn block(&mut self, statements: &[Statement]) {
        for statement in statements {
            match statement {
                Statement::Let(id) => self.let_(*id),
                Statement::If {
                    mask,
                    choices,
                    then,
                    otherwise,
                } => {
                    self.if_(*mask, choices, then, otherwise);
                }
            }
        }
    }

    fn let_(&mut self, id: Id) {
        if let Node::Opaque(of) = self.function.node(id) {
            let value = self.text(of).text;
            let name = self.name(id);
            // A variable's value is not a constant expression, which would have to be finite.
            return self.line(&format!("var {name} = {value};"));
        }
        let text = self.expression(id);
        if self.uses[id.index()] == 1 && text.text.len() <= INLINE {
            self.texts[id.index()] = Some(text);
        } else {
            let name = self.name(id);
            self.line(&format!("let {name} = {};", text.text));
        }
    }

    fn if_(&mut self, mask: Id, choices: &[Choice], then: &[Statement], otherwise: &[Statement]) {
        let names: Vec<String> = choices
            .iter()
            .map(|choice| {
                let name = self.name(choice.id);
                self.line(&format!(
                    "var {name}: {};",
                    kind_name(self.function.kind(choice.id))
                ));
                name
            })
            .collect();
        self.line(&format!("if {} {{", self.text(mask).text));
        self.side(then, &names, choices.iter().map(|choice| choice.then));
        self.line("} else {");
        self.side(
            otherwise,
            &names,
            choices.iter().map(|choice| choice.otherwise),
        );
        self.line("}");
    }

    fn side(
        &mut self,
        statements: &[Statement],
        names: &[String],
        values: impl Iterator<Item = Id>,
    ) {
        self.indent += 1;
        self.block(statements);
        for (name, value) in names.iter().zip(values) {
            let value = self.text(value).text;
            self.line(&format!("{name} = {value};"));
        }
        self.indent -= 1;
    }

    /// How an expression is referred to.
    fn text(&self, id: Id) -> Text {
        let primary = |text| Text {
            text,
            primary: true,
        };
        match self.function.node(id) {
            Node::Constant { kind, bits } => primary(constant(kind, bits)),
            Node::Parameter {
                parameter,
                component,
            } => {
                let name = self.function.parameters[parameter as usize].name;
                primary(match component {
                    None => name.to_owned(),
                    Some(k) => format!("{name}.{}", ["x", "y", "z"][usize::from(k)]),
                })
            }
            Node::Apply { .. }
            | Node::Load { .. }
            | Node::Opaque(_)
            | Node::Branch(_)
            | Node::Choice { .. } => self.texts[id.index()]
                .clone()
                .expect("operands are printed first"),
        }
    }

    fn operand(&self, id: Id) -> String {
        let Text { text, primary } = self.text(id);
        if primary { text } else { format!("({text})") }
    }

    /// What computes an expression.
    fn expression(&mut self, id: Id) -> Text {
        match self.function.node(id) {
            Node::Apply { op, operands } => self.apply(op, operands),
            Node::Load { buffer, index } => {
                self.printed.bindings.insert(buffer);
                let text = bindings::load(buffer, &self.operand(index));
                Text {
                    text,
                    primary: true,
                }
            }
            node @ (Node::Constant { .. }
            | Node::Parameter { .. }
            | Node::Opaque(_)
            | Node::Branch(_)
            | Node::Choice { .. }) => unreachable!("{node:?} is not computed"),
        }
    }

    fn apply(&self, op: Op, operands: [Id; 3]) -> Text {
        let call = |name: &str| {
            let arguments = operands[..op.arity()].iter().map(|&id| self.text(id).text);
            let text = format!("{name}({})", arguments.collect::<Vec<_>>().join(", "));
            Text {
                text,
                primary: true,
            }
        };
        let [a, b, c] = operands;
        let infix = |sign: &str| {
            let text = format!("{} {sign} {}", self.operand(a), self.operand(b));
            Text {
                text,
                primary: false,
            }
        };
        let shift = |sign: &str, by: u32| {
            let text = format!("{} {sign} {by}u", self.operand(a));
            Text {
                text,
                primary: false,
            }
        };
        let prefix = |sign: &str| {
            let text = format!("{sign}{}", self.operand(a));
            Text {
                text,
                primary: false,
            }
        };
        let helper = |helper: Helper| call(helper.name());
        match op {
            Op::Add | Op::AddU => infix("+"),
            Op::Sub | Op::SubU => infix("-"),
            Op::Mul | Op::MulU => infix("*"),
            Op::Div => match self.arithmetic.division {
                Division::Native => infix("/"),
                Division::Double => helper(Helper::Quotient),
            },
            Op::Neg => prefix("-"),
            Op::Sqrt => match self.arithmetic.square_root {
                SquareRoot::Native => call("sqrt"),
                SquareRoot::Double => helper(Helper::Root),
            },
            Op::Min => helper(Helper::Least),
            Op::Max => helper(Helper::Greatest),
            Op::Abs => call("abs"),
            Op::Floor => call("floor"),
            Op::Fma => match self.arithmetic.fma {
                Fma::Native => call("fma"),
                Fma::Double | Fma::Unfused => helper(Helper::Fused),
            },
            Op::Copysign => helper(Helper::Copysign),
            Op::Lt | Op::LtU => infix("<"),
            Op::Le => infix("<="),
            Op::Eq | Op::EqU => infix("=="),
            Op::AndU | Op::And => infix("&"),
            Op::OrU | Op::Or => infix("|"),
            Op::XorU => infix("^"),
            Op::ShlU(by) => shift("<<", by),
            Op::ShrU(by) => shift(">>", by),
            Op::ReverseBits => call("reverseBits"),
            Op::ToUint => call("u32"),
            Op::ToReal => call("f32"),
            Op::ToBits => call("bitcast<u32>"),
            Op::FromBits => call("bitcast<f32>"),
            Op::Not => prefix("!"),
            Op::Select => {
                let [mask, a, b] = [a, b, c].map(|id| self.text(id).text);
                Text {
                    text: format!("select({b}, {a}, {mask})"),
                    primary: true,
                }
            }
        }
    }
}
