//! Recorded elementary functions and branches.

use residual_render::domain::{Bundle, Domain};
use residual_render::math::elementary;

use crate::check::check;
use crate::common::{Formula, Random, Yield, ifs};

/// Elementary functions of two numbers.
struct Elementary;

impl Formula for Elementary {
    fn name(&self) -> String {
        "elementary".to_owned()
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        (
            vec![random.between(-4.0, 4.0), random.between(-4.0, 4.0)],
            vec![],
        )
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], _: &[D::U]) -> Yield<D> {
        let mut out = Yield::new();
        let (sin, cos) = elementary::sincos_turns(d, r[0]);
        out.reals.extend([
            sin,
            cos,
            elementary::atan2(d, r[0], r[1]),
            elementary::exp2(d, r[1]),
        ]);
        let positive = d.abs(r[0]);
        out.reals.extend([
            elementary::log2(d, positive),
            elementary::pow(d, positive, r[1]),
        ]);
        // Constants fold to the scalar domain's bits.
        let c = d.lit(0.7);
        out.reals.extend([
            elementary::pow(d, c, d.lit(2.2)),
            elementary::atan2(d, c, -c),
        ]);
        out
    }
}

#[test]
fn elementary_functions() {
    check(&Elementary);
}

/// Nested branches with everything that could leave its scope.
struct Branches;

/// A number, a word and a truth value.
#[derive(Clone, Copy)]
struct Triple<D: Domain>(D::F, D::U, D::M);

impl<D: Domain> Bundle<D> for Triple<D> {
    fn choose(d: D, mask: D::M, a: Self, b: Self) -> Self {
        Self(
            // What `choose` computes itself is of neither side.
            d.select(mask, a.0 + a.0, b.0 + b.0) * d.lit(0.25)
                + d.select(mask, a.0, b.0) * d.lit(0.5),
            d.select_u(mask, a.1, b.1),
            d.select_mask(mask, a.2, b.2),
        )
    }
}

impl Formula for Branches {
    fn name(&self) -> String {
        "branches".to_owned()
    }
    fn arguments(&self, random: &mut Random) -> (Vec<f32>, Vec<u32>) {
        let reals = [0; 4].map(|_| random.between(-1.0, 1.0));
        (reals.to_vec(), vec![random.word() % 16, random.word() % 16])
    }
    fn run<D: Domain>(&self, d: D, r: &[D::F], words: &[D::U]) -> Yield<D> {
        let zero = d.lit(0.0);
        let (p, q) = (d.lt(r[0], zero), d.lt(r[1], zero));
        let inner = |x: D::F| {
            d.branch(
                q,
                || {
                    Triple(
                        x * r[2] + d.sqrt(d.abs(r[3])),
                        words[0] + words[1],
                        d.lt(x, r[3]),
                    )
                },
                || {
                    Triple(
                        x / (d.abs(r[2]) + d.lit(0.1)),
                        words[0] * words[1],
                        d.truth(true),
                    )
                },
            )
        };
        // `shared` is recorded in one side, and used in the other and after both.
        let shared = || d.sqrt(d.abs(r[0] * r[1]));
        let first = d.branch(
            p,
            || inner(shared()),
            || Triple(shared() * r[3], words[1], q),
        );
        // The same branch again: expressions of the first are known, but were not computed here.
        let second = d.branch(p, || inner(shared() + r[2]), || inner(r[2]));
        let third = d.branch(!q & p, || (first, second), || (second, inner(first.0)));
        let constant = d.branch(d.truth(true), || inner(r[0]), || unreachable!());
        let mut out = Yield::new();
        for Triple(real, word, truth) in [first, second, third.0, third.1, constant] {
            out.real(real + shared());
            out.words.push(word);
            out.truths.push(truth);
        }
        out
    }
}

#[test]
fn branches_and_scopes() {
    let function = check(&Branches);
    assert!(ifs(&function) >= 6);
}
