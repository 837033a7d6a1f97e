//! What an adapter makes of arithmetic, measured when it is opened.
//!
//! No driver says what it contracts, reassociates or rounds, so each is asked for its answers to expressions that reveal
//! it, and the answers are compared with the processor's. The expressions are recorded and printed like everything else.

use std::fmt;

use residual_render::domain::tape::{Outputs, Record, Tape};
use residual_render::domain::{Buffers, Domain, Scalar, Uint};
use residual_wgsl::{Arithmetic, Division, Fma, Module, Recorded, SquareRoot};
use wgpu::{BufferUsages, Features};

use crate::bindings::{Access, group, layout, pipeline_layout};
use crate::error::Error;
use crate::gpu::Gpu;
use crate::shader::{Dialect, Mode, pipeline};

/// What is asked, each a function of three numbers.
const QUESTIONS: [Question; 11] = [
    Question::TwoSum,
    Question::Difference,
    Question::Factoring,
    Question::Order,
    Question::Fused,
    Question::Quotient,
    Question::Root,
    Question::Least,
    Question::Denormal,
    Question::Floor,
    Question::Conversion,
];

/// An expression whose value reveals a liberty that compilers and drivers take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// What a sum loses by rounding: 0 where sums are reassociated.
    TwoSum,
    /// a·b − c, which contraction rounds once.
    Difference,
    /// a·b + a·c, which some make a·(b + c).
    Factoring,
    /// Whether a·b ≥ b·c, by rounded products.
    Order,
    /// A fused multiply-add.
    Fused,
    /// a ÷ b.
    Quotient,
    /// √|a|.
    Root,
    /// The smaller of two numbers, the second where either is NaN.
    Least,
    /// The product with a power of two that makes it denormal.
    Denormal,
    /// ⌊a⌋.
    Floor,
    /// The bits of `a` as an integer, made a number.
    Conversion,
}

impl Question {
    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::TwoSum => "two-sum",
            Self::Difference => "a·b − c",
            Self::Factoring => "a·b + a·c",
            Self::Order => "a·b ≥ b·c",
            Self::Fused => "fma",
            Self::Quotient => "division",
            Self::Root => "square root",
            Self::Least => "min with NaN",
            Self::Denormal => "denormals",
            Self::Floor => "floor",
            Self::Conversion => "conversion",
        }
    }

    fn answer<D: Domain>(self, d: D, [a, b, c]: [D::F; 3]) -> D::F {
        match self {
            Self::TwoSum => {
                let sum = a + b;
                let rest = sum - a;
                (a - (sum - rest)) + (b - rest)
            }
            Self::Difference => a * b - c,
            Self::Factoring => a * b + a * c,
            Self::Order => d.select(d.le(b * c, a * b), d.lit(1.0), d.lit(0.0)),
            Self::Fused => d.fma(a, b, c),
            Self::Quotient => a / b,
            Self::Root => d.sqrt(d.abs(a)),
            Self::Least => d.min(a, b),
            Self::Denormal => a * d.lit(2_f64.powi(-126)),
            Self::Floor => d.floor(a),
            Self::Conversion => d.to_real(d.to_bits(a)),
        }
    }
}

/// How many of the answers differ from the processor's, by question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answers {
    wrong: [u32; QUESTIONS.len()],
    /// Of how many.
    pub asked: u32,
}

impl Answers {
    /// The questions with how many answers are wrong.
    pub fn iter(&self) -> impl Iterator<Item = (Question, u32)> {
        QUESTIONS.into_iter().zip(self.wrong)
    }

    fn wrong(&self, question: Question) -> u32 {
        let found = self.iter().find(|(asked, _)| *asked == question);
        found.expect("every question is asked").1
    }

    /// Every answer has the processor's bits.
    pub fn are_exact(&self) -> bool {
        self.wrong.iter().all(|&wrong| wrong == 0)
    }
}

impl fmt::Display for Answers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let wrong = self.iter().filter(|(_, wrong)| *wrong > 0);
        let wrong: Vec<String> = wrong
            .map(|(question, wrong)| {
                let part = 100.0 * f64::from(wrong) / f64::from(self.asked);
                format!("{} in {part:.2} %", question.name())
            })
            .collect();
        match wrong.is_empty() {
            true => f.write_str("as the processor"),
            false => write!(f, "differs from the processor: {}", wrong.join(", ")),
        }
    }
}

/// The dialect that suits an adapter, and what its answers are in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Probe {
    /// How kernels are to compute.
    pub dialect: Dialect,
    /// What comes of it.
    pub answers: Answers,
    /// What comes of plain WGSL.
    pub plain: Answers,
}

impl Probe {
    /// Samples will have the processor's bits.
    pub fn is_exact(&self) -> bool {
        self.dialect.mode == Mode::Exact && self.answers.are_exact()
    }
}

impl Gpu {
    /// Measures the adapter's arithmetic, and chooses: exact where kernels can be passed through, and each operation as the
    /// adapter gets it right.
    ///
    /// # Errors
    /// If the device fails.
    pub fn probe(&self) -> Result<Probe, Error> {
        let native = Arithmetic::default();
        let plain = self.ask(Dialect {
            mode: Mode::Plain,
            arithmetic: native,
        })?;
        if !self.is_exact() {
            let dialect = Dialect {
                mode: Mode::Plain,
                arithmetic: native,
            };
            return Ok(Probe {
                dialect,
                answers: plain,
                plain,
            });
        }
        let mode = Mode::Exact;
        let first = self.ask(Dialect {
            mode,
            arithmetic: native,
        })?;
        let has_f64 = self.has(Features::SHADER_F64);
        let is_right = |question| first.wrong(question) == 0;
        let arithmetic = Arithmetic {
            fma: match (is_right(Question::Fused), FUSES, has_f64) {
                (true, ..) => Fma::Native,
                (false, false, _) => Fma::Unfused,
                (false, true, true) => Fma::Double,
                (false, true, false) => Fma::Native,
            },
            division: match is_right(Question::Quotient) || !has_f64 {
                true => Division::Native,
                false => Division::Double,
            },
            square_root: match is_right(Question::Root) || !has_f64 {
                true => SquareRoot::Native,
                false => SquareRoot::Double,
            },
        };
        let dialect = Dialect { mode, arithmetic };
        let answers = match arithmetic == native {
            true => first,
            false => self.ask(dialect)?,
        };
        Ok(Probe {
            dialect,
            answers,
            plain,
        })
    }

    /// The answers to all questions.
    fn ask(&self, dialect: Dialect) -> Result<Answers, Error> {
        let inputs = inputs();
        let count = inputs.len() as u32;
        let words: Vec<u32> = inputs.iter().flatten().copied().collect();
        let from = self.upload("inputs", &words);
        let to = self.buffer(
            "answers",
            4 * u64::from(count) * QUESTIONS.len() as u64,
            BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        );
        let bindings = layout(self, &[Access::Read, Access::Write]);
        let group = group(self, &bindings, &[&from, &to]);
        let layout = pipeline_layout(self, &[&bindings]);
        let kernel = pipeline(
            self,
            dialect.mode,
            &layout,
            &text(dialect.arithmetic),
            "ask",
        )?;
        let mut encoder = self.device.create_command_encoder(&Default::default());
        {
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&kernel);
            pass.set_bind_group(0, &group, &[]);
            pass.dispatch_workgroups(count.div_ceil(WORKGROUP), 1, 1);
        }
        self.queue.submit([encoder.finish()]);
        let mut answers = vec![0_u32; inputs.len() * QUESTIONS.len()];
        self.download(&to, bytemuck::cast_slice_mut(&mut answers))?;
        let mut wrong = [0; QUESTIONS.len()];
        for (input, answers) in inputs.iter().zip(answers.chunks(QUESTIONS.len())) {
            for ((question, answer), wrong) in QUESTIONS.iter().zip(answers).zip(&mut wrong) {
                *wrong += u32::from(!is_right(*question, *input, *answer));
            }
        }
        Ok(Answers {
            wrong,
            asked: count,
        })
    }
}

/// Whether the processor's domains fuse.
const FUSES: bool = cfg!(any(target_feature = "fma", target_arch = "aarch64"));
/// Threads of a workgroup.
const WORKGROUP: u32 = 64;

/// Whether an answer is the processor's; NaN has no bits of its own.
fn is_right(question: Question, input: [u32; 3], answer: u32) -> bool {
    let d = Scalar::new(&Buffers::EMPTY);
    let expected = question.answer(d, input.map(|bits| d.from_bits(Uint(bits))));
    expected.to_bits() == answer || (expected.is_nan() && f32::from_bits(answer).is_nan())
}

/// Triples of numbers: half of neighbouring sizes, so that sums cancel, half of any bits, and special values among them.
fn inputs() -> Vec<[u32; 3]> {
    const COUNT: u64 = 1 << 16;
    const SPECIAL: [f32; 8] = [
        0.0,
        -0.0,
        1.0,
        f32::MAX,
        f32::MIN_POSITIVE,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::NAN,
    ];
    // SplitMix64 (Steele, Lea, Flood 2014).
    let mut state = 0_u64;
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 32) as u32
    };
    let mut number = |of: u64| {
        let word = next();
        match of % 32 {
            0 if word % 4 == 0 => SPECIAL[word as usize / 4 % SPECIAL.len()].to_bits(),
            1..16 => word & 0x807f_ffff | (120 + (word >> 23) % 16) << 23,
            _ => word,
        }
    };
    (0..COUNT)
        .map(|index| [number(index), number(index), number(index)])
        .collect()
}

fn text(arithmetic: Arithmetic) -> String {
    let mut module = Module::new(arithmetic);
    let mut lines = String::new();
    for (place, question) in QUESTIONS.into_iter().enumerate() {
        let tape = Tape::new();
        let numbers = ["a", "b", "c"].map(|name| tape.real(name));
        let answer = question.answer(Record::new(&tape), numbers);
        let name = format!("ask_{question:?}").to_lowercase();
        lines += &format!(
            "    answers[id.x * {}u + {place}u] = bitcast<u32>({name}(a, b, c));\n",
            QUESTIONS.len()
        );
        module.add(&Recorded {
            function: tape.function(name, Outputs::new().real("answer", answer)),
            result: "",
            comment: question.name().to_owned(),
        });
    }
    module.add_text(&format!(
        "\
@group(0) @binding(0) var<storage, read> numbers: array<u32>;
@group(0) @binding(1) var<storage, read_write> answers: array<u32>;

@compute @workgroup_size({WORKGROUP})
fn ask(@builtin(global_invocation_id) id: vec3u) {{
    let a = bitcast<f32>(numbers[id.x * 3u]);
    let b = bitcast<f32>(numbers[id.x * 3u + 1u]);
    let c = bitcast<f32>(numbers[id.x * 3u + 2u]);
{lines}}}
"
    ));
    module.finish()
}
