//! Every domain gives the answers of the suite, and the suite would notice one that does not.

use fearless_simd::{Level, dispatch};
use residual_render::domain::operations::{Answer, Expression, Operation};
use residual_render::domain::tape::{Function, Kind, Node, Op, Outputs, Record, Statement, Tape};
use residual_render::domain::{
    Buffers, Domain, Lanes, Lanes4, Lanes8, Lanes16, MAX_LANES, Precise, Scalar, Uint,
};

#[track_caller]
fn expect(what: impl std::fmt::Debug, operands: [u32; 3], answer: Answer, result: u32) {
    let reals = operands.map(f32::from_bits);
    assert!(
        answer.admits(result),
        "{what:?} of {operands:x?} {reals:?}: {answer:x?}, not {result:x}"
    );
}

/// Evaluates in lanes, and hands on operands and results.
fn in_lanes<D: Lanes>(
    d: D,
    operands: &[[u32; 3]],
    evaluate: impl Fn([D::U; 3]) -> D::U,
    check: impl Fn([u32; 3], u32),
) {
    for chunk in operands.chunks(D::LANES) {
        let lane = |k: usize| chunk[k.min(chunk.len() - 1)];
        let columns = [0, 1, 2].map(|column| {
            let words: [u32; MAX_LANES] = std::array::from_fn(|k| lane(k)[column]);
            d.word(&words[..D::LANES])
        });
        let mut results = [0; MAX_LANES];
        d.store_word(evaluate(columns), &mut results[..D::LANES]);
        for (&operands, result) in chunk.iter().zip(results) {
            check(operands, result);
        }
    }
}

fn answers_suite<D: Lanes>(d: D) {
    for operation in Operation::ALL {
        in_lanes(
            d,
            &operation.operands(),
            |operands| operation.evaluate(d, operands),
            |operands, result| {
                let what = (operation, D::LANES);
                expect(what, operands, operation.answer(operands), result);
            },
        );
    }
    for expression in Expression::ALL {
        in_lanes(
            d,
            &Expression::operands(),
            |operands| expression.evaluate(d, operands.map(|bits| d.from_bits(bits))),
            |operands, result| {
                let what = (expression, D::LANES);
                expect(what, operands, expression.answer(operands), result);
            },
        );
    }
}

#[test]
fn scalars_and_lanes_answer_the_suite() {
    answers_suite(Scalar::new(&Buffers::EMPTY));
    dispatch!(Level::new(), simd => {
        answers_suite(Lanes4::new(simd, &Buffers::EMPTY));
        answers_suite(Lanes8::new(simd, &Buffers::EMPTY));
        answers_suite(Lanes16::new(simd, &Buffers::EMPTY));
    });
}

/// But for `fma`, whose sum it rounds before the one rounding more.
#[test]
fn more_than_twice_the_bits_answer_the_suite_once_rounded() {
    let d = Precise::new(&Buffers::EMPTY);
    for operation in Operation::ALL.into_iter().filter(|o| o.op != Op::Fma) {
        for operands in operation.operands() {
            let Uint(result) = operation.evaluate(d, operands.map(Uint));
            expect(operation, operands, operation.answer(operands), result);
        }
    }
}

/// The operation, recorded; `constant` says which operands are constants.
fn recorded(operation: Operation, operands: [u32; 3], constant: [bool; 3]) -> Function {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let parameters = ["a", "b", "c"].map(|name| tape.word(name));
    let operands = [0, 1, 2].map(|k| match constant[k] {
        true => d.uint(operands[k]),
        false => parameters[k],
    });
    let result = operation.evaluate(d, operands);
    tape.function("operation", Outputs::new().word("result", result))
}

fn result(function: &Function, operands: [u32; 3]) -> u32 {
    function.evaluate(&Buffers::EMPTY, &operands)[0]
}

#[test]
fn a_tape_answers_the_suite() {
    for operation in Operation::ALL {
        let function = recorded(operation, [0; 3], [false; 3]);
        for operands in operation.operands() {
            let result = result(&function, operands);
            expect(operation, operands, operation.answer(operands), result);
        }
    }
}

#[test]
fn a_tape_holds_the_operation() {
    for operation in Operation::ALL {
        let function = recorded(operation, [0; 3], [false; 3]);
        let is_computed = function.body.iter().any(|statement| match statement {
            Statement::Let(id) => {
                matches!(function.node(*id), Node::Apply { op, .. } if op == operation.op)
            }
            Statement::If { .. } => false,
        });
        // These leave bits as they are, or a select exchanges its operands.
        let is_simplified = matches!(
            operation.op,
            Op::ToBits | Op::FromBits | Op::Not | Op::ShlU(0) | Op::ShrU(0)
        );
        assert_eq!(is_computed, !is_simplified, "{operation:?}");
    }
}

/// Bits of this kind that a tape promises to reckon with.
fn is_finite(kind: Kind, bits: u32) -> bool {
    kind != Kind::Real || f32::from_bits(bits).is_finite()
}

fn are_finite(operation: Operation, operands: [u32; 3]) -> bool {
    let mut operands = operation.kinds().into_iter().zip(operands);
    operands.all(|(kind, bits)| is_finite(kind, bits))
}

#[test]
fn a_tape_folds_constants_to_the_answers() {
    for operation in Operation::ALL {
        for operands in operation.operands() {
            if are_finite(operation, operands) {
                let result = result(&recorded(operation, operands, [true; 3]), operands);
                expect(operation, operands, operation.answer(operands), result);
            }
        }
    }
}

#[test]
fn a_tape_keeps_all_but_the_sign_of_zero_where_some_are_constant() {
    for operation in Operation::ALL {
        let unsigned_zero = |bits| match (operation.kind(), bits) {
            (Kind::Real, 0x8000_0000) => 0,
            _ => bits,
        };
        for operands in operation.operands().into_iter().step_by(3) {
            let Answer::Bits(bits) = operation.answer(operands) else {
                continue;
            };
            if !is_finite(operation.kind(), bits) || !are_finite(operation, operands) {
                continue;
            }
            for constants in 1..(1 << operation.op.arity()) - 1 {
                let constant = [0, 1, 2].map(|k| constants >> k & 1 != 0);
                let result = result(&recorded(operation, operands, constant), operands);
                let answer = Answer::Bits(unsigned_zero(bits));
                expect(
                    (operation, constant),
                    operands,
                    answer,
                    unsigned_zero(result),
                );
            }
        }
    }
}

/// What a compiler may make of an expression.
fn liberty(expression: Expression, [a, b, c]: [f32; 3]) -> u32 {
    let value = match expression {
        Expression::SumError => 0.0,
        Expression::SumLessTerm => b,
        Expression::CollectedConstants => a + 2.0,
        Expression::ProductLessTerm => a.mul_add(b, -c),
        Expression::ProductLessProduct => a.mul_add(b, -(b * c)),
        Expression::CommonFactor => a * (b + c),
        Expression::CommonDivisor => (a + b) * (1.0 / c),
        Expression::QuotientTimesDivisor => a,
        Expression::RootSquared => a.abs(),
        Expression::ProductsInOrder => return u32::from(b.mul_add(-c, a * b) >= 0.0),
        Expression::Lesser => a.min(b),
        Expression::EqualToItself => return 1,
    };
    value.to_bits()
}

#[test]
fn liberties_show() {
    for expression in Expression::ALL {
        let shows = |operands: &&[u32; 3]| {
            let reals = operands.map(f32::from_bits);
            let is_finite = reals.iter().all(|x| x.is_finite());
            let needs_nan = matches!(expression, Expression::Lesser | Expression::EqualToItself);
            let result = liberty(expression, reals);
            (is_finite || needs_nan) && !expression.answer(**operands).admits(result)
        };
        let shown = Expression::operands().iter().filter(shows).count();
        assert!(shown >= 50, "{expression:?} shows in {shown} cases only");
    }
}

/// A few answers that do not come from the scalar domain.
#[test]
fn answers_are_those_of_ieee_754() {
    let answer = |op, operands: [f32; 3]| {
        let operation = Operation::ALL.into_iter().find(|known| known.op == op);
        operation
            .expect("all operations are there")
            .answer(operands.map(f32::to_bits))
    };
    let real = |value: f32| Answer::Bits(value.to_bits());
    let (nan, inf) = (f32::NAN, f32::INFINITY);
    assert_eq!(answer(Op::Sub, [3.0, 1.0, 0.0]), real(2.0));
    // A tie goes to even.
    assert_eq!(
        answer(Op::Add, [16_777_216.0, 1.0, 0.0]),
        real(16_777_216.0)
    );
    assert_eq!(answer(Op::Div, [1.0, -0.0, 0.0]), real(-inf));
    assert_eq!(answer(Op::Sub, [inf, inf, 0.0]), Answer::NaN);
    assert_eq!(answer(Op::Sqrt, [-0.0; 3]), real(-0.0));
    assert_eq!(answer(Op::Min, [nan, 1.0, 0.0]), real(1.0));
    assert_eq!(answer(Op::Max, [1.0, nan, 0.0]), Answer::NaN);
    assert_eq!(answer(Op::Min, [-0.0, 0.0, 0.0]), real(0.0));
    assert_eq!(answer(Op::Max, [0.0, -0.0, 0.0]), real(-0.0));
    assert_eq!(answer(Op::Eq, [nan, nan, 0.0]), Answer::Bits(0));
    assert_eq!(
        answer(Op::ToUint, [4_294_967_040.0; 3]),
        Answer::Bits(0xffff_ff00)
    );
    assert_eq!(answer(Op::ToUint, [-1.0; 3]), Answer::Unspecified);
    assert_eq!(answer(Op::ToBits, [nan; 3]), Answer::NaN);
}
