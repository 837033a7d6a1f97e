//! What a tape leaves out: constants, what changes nothing, what is not used, and branches without need.

use residual_render::domain::tape::{Op, Outputs, Record, Statement, Tape};
use residual_render::domain::{Buffers, Domain};

use crate::common::{ifs, ops};

#[test]
fn branches_on_constants_are_not_recorded() {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let x = tape.real("x");
    let one = |value| residual_render::domain::One(value);
    let mask = d.lt(d.lit(1.0), d.lit(2.0));
    let taken = d.branch(mask, || one(x + x), || unreachable!("the mask is constant"));
    // Nor branches whose sides agree, nor those that say again what their mask says.
    let agree = d.branch(d.lt(x, d.lit(0.0)), || one(x + x), || one(x + x));
    let function = tape.function("f", Outputs::new().real("a", taken.0).real("b", agree.0));
    assert_eq!(ifs(&function), 0);
    assert_eq!(function.body.len(), 1);
}

#[test]
fn equal_expressions_are_one_and_unused_ones_none() {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let (x, y) = (tape.real("x"), tape.real("y"));
    let _unused = d.sqrt(x + y);
    let sum = d.abs(x * y) + d.abs(y * x);
    let function = tape.function("f", Outputs::new().real("sum", sum));
    assert_eq!(ops(&function, Op::Mul), 1);
    assert_eq!(ops(&function, Op::Abs), 1);
    assert_eq!(ops(&function, Op::Sqrt), 0);
    assert_eq!(function.body.len(), 3);
}

#[test]
fn what_only_one_side_needs_is_computed_there() {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let x = tape.real("x");
    let root = d.sqrt(x);
    let one = |value| residual_render::domain::One(value);
    let value = d.branch(d.lt(x, d.lit(1.0)), || one(root), || one(x));
    let function = tape.function("f", Outputs::new().real("value", value.0));
    let [
        Statement::Let(_),
        Statement::If {
            then, otherwise, ..
        },
    ] = &function.body[..]
    else {
        panic!("{:?}", function.body)
    };
    assert_eq!((then.len(), otherwise.len()), (1, 0));
}

#[test]
fn identities() {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let (x, n) = (tape.real("x"), tape.word("n"));
    let (zero, one) = (d.lit(0.0), d.lit(1.0));
    let outputs = Outputs::new()
        .real("add", x + zero)
        .real("sub", x - zero)
        .real("mul", one * x)
        .real("div", x / one)
        .real("neg", -(-x))
        .real("nothing", zero * x)
        .real("fma", d.fma(x, one, zero))
        .real("fma_nothing", d.fma(zero, x, x))
        .real("bits", d.from_bits(d.to_bits(x)))
        .real("select", d.select(d.truth(true), x, one))
        .word("add_u", n + d.uint(0))
        .word("mul_u", n * d.uint(1))
        .word("and_u", n & d.uint(u32::MAX))
        .word("shift", n << 0)
        .word("folded", (d.uint(7) << 2) ^ d.uint(1))
        .truth("not", !d.truth(false));
    let function = tape.function("f", outputs);
    assert_eq!(function.body, []);
    let bits = function.evaluate(&Buffers::EMPTY, &[2.5_f32.to_bits(), 9]);
    let real = 2.5_f32.to_bits();
    let expected = [
        real, real, real, real, real, 0, real, real, real, real, 9, 9, 9, 9, 29, 1,
    ];
    assert_eq!(bits, expected);
}

#[test]
fn sums_of_constants_are_gathered() {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let n = tape.word("n");
    let sum = (n + d.uint(3)) + d.uint(u32::MAX);
    let function = tape.function("f", Outputs::new().word("sum", sum));
    assert_eq!(function.body.len(), 1);
    assert_eq!(function.evaluate(&Buffers::EMPTY, &[5]), [7]);
}

#[test]
fn operations_without_finite_value_are_not_folded() {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let (one, zero) = (d.lit(1.0), d.lit(0.0));
    let outputs = Outputs::new()
        .real("infinite", one / zero)
        .real("huge", d.lit(f64::from(f32::MAX)) * d.lit(2.0))
        .real("root", d.sqrt(-one));
    let function = tape.function("f", outputs);
    assert_eq!(
        ops(&function, Op::Div) + ops(&function, Op::Mul) + ops(&function, Op::Sqrt),
        3
    );
    let values = function
        .evaluate(&Buffers::EMPTY, &[])
        .into_iter()
        .map(f32::from_bits);
    let values: Vec<f32> = values.collect();
    assert!(values[0] == f32::INFINITY && values[1] == f32::INFINITY && values[2].is_nan());
}

#[test]
#[should_panic(expected = "constants are finite")]
fn infinite_constants_are_refused() {
    let tape = Tape::new();
    Record::new(&tape).lit(f64::INFINITY);
}
