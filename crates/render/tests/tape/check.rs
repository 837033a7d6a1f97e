//! A formula, recorded, against itself.

use residual_render::domain::tape::{Function, Outputs, Record, Tape};
use residual_render::domain::{Scalar, Uint};

use crate::common::{Formula, Random, scene};

const RUNS: usize = 1000;

/// Names of parameters, as many as any formula needs.
const NAMES: [&str; 24] = [
    "a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "o", "p", "q", "r", "s",
    "t", "u", "v", "w", "x",
];

pub(crate) fn record<F: Formula>(formula: &F) -> Function {
    let (reals, words) = formula.arguments(&mut Random(1));
    let tape = Tape::new();
    let mut names = NAMES.into_iter();
    let reals: Vec<_> = reals
        .iter()
        .map(|_| tape.real(names.next().unwrap()))
        .collect();
    let words: Vec<_> = words
        .iter()
        .map(|_| tape.word(names.next().unwrap()))
        .collect();
    let results = formula.run(Record::new(&tape), &reals, &words);
    let mut outputs = Outputs::new();
    for real in results.reals {
        outputs = outputs.real("real", real);
    }
    for word in results.words {
        outputs = outputs.word("word", word);
    }
    for truth in results.truths {
        outputs = outputs.truth("truth", truth);
    }
    tape.function(formula.name(), outputs)
}

/// The same bits; zeros of either sign and all NaN are one.
fn same(a: u32, b: u32) -> bool {
    let (x, y) = (f32::from_bits(a), f32::from_bits(b));
    a == b || (x == 0.0 && y == 0.0) || (x.is_nan() && y.is_nan())
}

/// Runs the recorded function and the formula on the same random arguments.
#[track_caller]
pub(crate) fn check<F: Formula>(formula: &F) -> Function {
    let data = scene();
    let buffers = data.buffers();
    let function = record(formula);
    let mut random = Random(99);
    for run in 0..RUNS {
        let (reals, words) = formula.arguments(&mut random);
        let bits: Vec<u32> = reals
            .iter()
            .map(|r| r.to_bits())
            .chain(words.iter().copied())
            .collect();
        let words: Vec<Uint> = words.into_iter().map(Uint).collect();
        let expected = formula.run(Scalar::new(&buffers), &reals, &words);
        let real_count = expected.reals.len();
        let expected: Vec<u32> = expected
            .reals
            .iter()
            .map(|r| r.to_bits())
            .chain(expected.words.iter().map(|w| w.0))
            .chain(expected.truths.iter().map(|&t| t.into()))
            .collect();
        let got = function.evaluate(&buffers, &bits);
        assert_eq!(got.len(), expected.len());
        for (place, (&got, &expected)) in got.iter().zip(&expected).enumerate() {
            let equal = if place < real_count {
                same(got, expected)
            } else {
                got == expected
            };
            assert!(
                equal,
                "{}, run {run}, output {place}: {} recorded, {} scalar; arguments {reals:?} {words:?}",
                formula.name(),
                f32::from_bits(got),
                f32::from_bits(expected),
            );
        }
    }
    function
}
