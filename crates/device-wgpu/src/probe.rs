//! What an adapter makes of arithmetic, measured when it is opened.
//!
//! No driver says what it contracts, reassociates or rounds, so each is asked for its answers to the suite that holds every
//! domain to its contract. The questions are recorded and printed like everything else.

use std::fmt;

use residual_render::domain::operations::{Answer, Expression, Operation};
use residual_render::domain::tape::{Op, Outputs, Record, Tape};
use residual_render::domain::{Domain as _, FUSES};
use residual_wgsl::{Arithmetic, Division, Fma, Module, Recorded, SquareRoot, WORKGROUP};
use wgpu::{BufferUsages, Features};

use crate::bindings::{Access, group, layout, pipeline_layout};
use crate::error::Error;
use crate::exact::FloatControls;
use crate::gpu::Gpu;
use crate::shader::{Dialect, Mode, pipeline};

/// One operation, or a few that reveal a liberty which compilers and drivers take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// One operation.
    Operation(Operation),
    /// A formula.
    Expression(Expression),
}

impl fmt::Display for Question {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Operation(operation) => write!(f, "{:?}", operation.op),
            Self::Expression(expression) => write!(f, "{expression:?}"),
        }
    }
}

impl Question {
    /// Everything: each operation and each expression of the suite.
    pub fn all() -> Vec<Self> {
        let operations = Operation::ALL.into_iter().map(Self::Operation);
        let expressions = Expression::ALL.into_iter().map(Self::Expression);
        operations.chain(expressions).collect()
    }

    /// What has to be known before kernels are made: rounding, fusion, denormals, NaN, and liberties.
    fn of_a_start() -> Vec<Self> {
        let is_asked = |operation: &Operation| {
            let ops = [
                Op::Add,
                Op::Mul,
                Op::Div,
                Op::Sqrt,
                Op::Fma,
                Op::Min,
                Op::Lt,
            ];
            ops.contains(&operation.op)
        };
        let operations = Operation::ALL.into_iter().filter(is_asked);
        let expressions = Expression::ALL.into_iter().map(Self::Expression);
        operations.map(Self::Operation).chain(expressions).collect()
    }

    fn operands(self) -> Vec<[u32; 3]> {
        match self {
            Self::Operation(operation) => operation.operands(),
            Self::Expression(_) => Expression::operands(),
        }
    }

    fn answer(self, operands: [u32; 3]) -> Answer {
        match self {
            Self::Operation(operation) => operation.answer(operands),
            Self::Expression(expression) => expression.answer(operands),
        }
    }

    /// The question as a function of three words.
    fn recorded(self, name: String) -> Recorded {
        let tape = Tape::new();
        let d = Record::new(&tape);
        let words = ["a", "b", "c"].map(|name| tape.word(name));
        let answer = match self {
            Self::Operation(operation) => operation.evaluate(d, words),
            Self::Expression(expression) => {
                expression.evaluate(d, words.map(|word| d.from_bits(word)))
            }
        };
        Recorded {
            function: tape.function(name, Outputs::new().word("answer", answer)),
            result: "",
            comment: self.to_string(),
        }
    }
}

/// How many answers are not what the domain's contract says, by question.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answers(Vec<Tally>);

/// The answers to one question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tally {
    /// What was asked.
    pub question: Question,
    /// Wrong answers.
    pub wrong: usize,
    /// All answers.
    pub asked: usize,
}

impl Answers {
    /// Question by question.
    pub fn tallies(&self) -> &[Tally] {
        &self.0
    }

    /// How many answers to questions about this operation are wrong.
    fn wrong_of(&self, op: Op) -> usize {
        let of = |tally: &&Tally| match tally.question {
            Question::Operation(operation) => operation.op == op,
            Question::Expression(_) => false,
        };
        self.0.iter().filter(of).map(|tally| tally.wrong).sum()
    }

    fn has_right(&self, op: Op) -> bool {
        self.wrong_of(op) == 0
    }

    /// How many answers are wrong.
    fn wrong(&self) -> usize {
        self.0.iter().map(|tally| tally.wrong).sum()
    }

    /// Every answer is right.
    pub fn are_exact(&self) -> bool {
        self.0.iter().all(|tally| tally.wrong == 0)
    }
}

impl fmt::Display for Answers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let wrong = self.0.iter().filter(|tally| tally.wrong > 0);
        let wrong: Vec<String> = wrong
            .map(|tally| {
                let part = 100.0 * tally.wrong as f64 / tally.asked as f64;
                format!("{} in {part:.2} %", tally.question)
            })
            .collect();
        match wrong.is_empty() {
            true => f.write_str("as the processor"),
            false => write!(f, "differs from the processor: {}", wrong.join(", ")),
        }
    }
}

/// The dialect that suits an adapter, and what its answers are in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Probe {
    /// How kernels are to compute.
    pub dialect: Dialect,
    /// What comes of it.
    pub answers: Answers,
}

impl Probe {
    /// Samples will have the processor's bits.
    pub fn is_exact(&self) -> bool {
        self.dialect.mode != Mode::Plain && self.answers.are_exact()
    }
}

impl Gpu {
    /// Measures the adapter's arithmetic, and chooses: exact where kernels can be passed through, and each operation as the
    /// adapter gets it right.
    ///
    /// # Errors
    /// If the device fails.
    pub fn probe(&self) -> Result<Probe, Error> {
        let questions = Question::of_a_start();
        let ask = |mode, arithmetic| {
            let dialect = Dialect { mode, arithmetic };
            let answers = self.ask(&questions, dialect)?;
            Ok(Probe { dialect, answers })
        };
        let native = Arithmetic::default();
        if !self.is_exact() {
            return ask(Mode::Plain, native);
        }
        let mut best = ask(Mode::Exact(FloatControls::Unstated), native)?;
        if !best.answers.has_right(Op::Mul) || !best.answers.has_right(Op::Min) {
            let preserved = ask(Mode::Exact(FloatControls::Preserve), native)?;
            if preserved.answers.wrong() < best.answers.wrong() {
                best = preserved;
            }
        }
        if best.is_exact() {
            return Ok(best);
        }
        // What is wrong may be right in other words.
        let mut arithmetic = native;
        if !FUSES {
            arithmetic.fma = Fma::Unfused;
        }
        if self.has(Features::SHADER_F64) {
            let double = Arithmetic {
                fma: if FUSES { Fma::Double } else { Fma::Unfused },
                division: Division::Double,
                square_root: SquareRoot::Double,
            };
            let double_answers = ask(best.dialect.mode, double)?.answers;
            let is_better = |op| double_answers.wrong_of(op) < best.answers.wrong_of(op);
            if is_better(Op::Fma) {
                arithmetic.fma = double.fma;
            }
            if is_better(Op::Div) {
                arithmetic.division = double.division;
            }
            if is_better(Op::Sqrt) {
                arithmetic.square_root = double.square_root;
            }
        }
        if arithmetic != native {
            let other = ask(best.dialect.mode, arithmetic)?;
            if other.answers.wrong() < best.answers.wrong() {
                best = other;
            }
        }
        Ok(best)
    }

    /// The adapter's answers to some questions.
    ///
    /// # Errors
    /// If the device fails, or refuses the kernel.
    pub fn ask(&self, questions: &[Question], dialect: Dialect) -> Result<Answers, Error> {
        let operands: Vec<_> = questions.iter().map(|q| q.operands()).collect();
        let most = operands.iter().map(Vec::len).max().unwrap_or(0);
        let rows = (most as u32).next_multiple_of(WORKGROUP);
        let mut words = vec![0; 3 * rows as usize * questions.len()];
        for (words, operands) in words.chunks_exact_mut(3 * rows as usize).zip(&operands) {
            words[..3 * operands.len()].copy_from_slice(operands.as_flattened());
        }
        let from = self.upload("operands", &words, BufferUsages::STORAGE);
        let to = self.buffer(
            "answers",
            4 * u64::from(rows) * questions.len() as u64,
            BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        );
        let bindings = layout(self, &[Access::Read, Access::Write]);
        let group = group(self, &bindings, &[&from, &to]);
        let layout = pipeline_layout(self, &[&bindings]);
        let text = text(questions, rows, dialect.arithmetic);
        let kernel = pipeline(self, dialect.mode, &layout, &text, "ask")?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&kernel);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(rows / WORKGROUP, questions.len() as u32, 1);
        }
        self.queue.submit([encoder.finish()]);
        let mut answers = vec![0_u32; rows as usize * questions.len()];
        self.download(&to, bytemuck::cast_slice_mut(&mut answers))?;
        let of_questions = questions.iter().zip(&operands);
        let tallies = of_questions.zip(answers.chunks_exact(rows as usize));
        let tally = |((&question, operands), answers): ((&Question, &Vec<_>), &[u32])| Tally {
            question,
            wrong: operands
                .iter()
                .zip(answers)
                .filter(|&(&operands, &answer)| !question.answer(operands).admits(answer))
                .count(),
            asked: operands.len(),
        };
        Ok(Answers(tallies.map(tally).collect()))
    }
}

/// A kernel whose workgroups answer one question each, by their second number.
fn text(questions: &[Question], rows: u32, arithmetic: Arithmetic) -> String {
    let mut module = Module::new(arithmetic);
    let mut cases = String::new();
    for (index, question) in questions.iter().enumerate() {
        let name = format!("question_{index}");
        cases += &format!(
            "        case {index}u: {{\n            answer = {name}(a, b, c);\n        }}\n"
        );
        module.add(&question.recorded(name));
    }
    module.add_text(&format!(
        "\
@group(0) @binding(0) var<storage, read> operands: array<u32>;
@group(0) @binding(1) var<storage, read_write> answers: array<u32>;

@compute @workgroup_size({WORKGROUP})
fn ask(@builtin(global_invocation_id) id: vec3u) {{
    let place = id.y * {rows}u + id.x;
    let a = operands[place * 3u];
    let b = operands[place * 3u + 1u];
    let c = operands[place * 3u + 2u];
    var answer = 0u;
    switch id.y {{
{cases}        default: {{
        }}
    }}
    answers[place] = answer;
}}
"
    ));
    module.finish()
}
