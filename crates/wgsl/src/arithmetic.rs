//! Operations that WGSL leaves open, spelled out so that they do what the domain promises.
//!
//! `min` and `max` are undefined for NaN; `fma` may or may not be fused; division and square roots may be off by a few
//! units in the last place on Vulkan. An adapter that is known to round as IEEE 754 says needs none of it.

use std::collections::BTreeSet;

/// How a fused multiply-add is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Fma {
    /// By the built-in function.
    #[default]
    Native,
    /// In `f64`, whose sum is rounded once more only where that makes no difference: a sum that lies in the middle between
    /// two `f32` goes to the side on which the exact sum is (Boldo, Melquiond, "Emulation of a FMA and correctly rounded
    /// sums", 2008, with another way to see the middle).
    Double,
    /// As a product and a sum, each rounded: for processors that do not fuse.
    Unfused,
}

/// How quotients are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Division {
    /// By the operator.
    #[default]
    Native,
    /// In `f64`: the second rounding changes nothing, for 53 ≥ 2·24 + 2 (Figueroa, "When is double rounding innocuous?",
    /// 1995).
    Double,
}

/// How square roots are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum SquareRoot {
    /// By the built-in function.
    #[default]
    Native,
    /// In `f64`: see [`Division::Double`].
    Double,
}

/// How operations are spelled that adapters may round in different ways.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Arithmetic {
    /// Fused multiply-adds.
    pub fma: Fma,
    /// Quotients.
    pub division: Division,
    /// Square roots.
    pub square_root: SquareRoot,
}

/// The product is exact; `rest` is what the sum has lost (Knuth's two-sum).
const FUSED_IN_DOUBLE: &str = "\
fn fused(a: f32, b: f32, c: f32) -> f32 {
    let product = f64(a) * f64(b);
    let term = f64(c);
    let sum = product + term;
    let of_term = sum - product;
    let rest = (product - (sum - of_term)) + (term - of_term);
    let nearest = f32(sum);
    let beyond = sum - f64(nearest);
    // The neighbour that is as near, if there is one.
    let other = f64(nearest) + 2.0lf * beyond;
    let is_between = beyond != 0.0lf && f64(f32(other)) == other;
    let is_other = is_between && rest != 0.0lf && (rest > 0.0lf) == (beyond > 0.0lf);
    return select(nearest, f32(other), is_other);
}
";

/// A function that printed text refers to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Helper {
    Least,
    Greatest,
    Copysign,
    Fused,
    Quotient,
    Root,
}

impl Helper {
    const ALL: [Self; 6] = [
        Self::Least,
        Self::Greatest,
        Self::Copysign,
        Self::Fused,
        Self::Quotient,
        Self::Root,
    ];

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Least => "least",
            Self::Greatest => "greatest",
            Self::Copysign => "copysign",
            Self::Fused => "fused",
            Self::Quotient => "quotient",
            Self::Root => "root",
        }
    }

    /// What it computes, in a scene's arithmetic.
    pub(crate) fn definition(self, arithmetic: Arithmetic) -> String {
        if self == Self::Fused && arithmetic.fma == Fma::Double {
            return FUSED_IN_DOUBLE.to_owned();
        }
        let (parameters, value) = match self {
            // The second where either is NaN.
            Self::Least => ("a: f32, b: f32", "select(b, a, a < b)"),
            Self::Greatest => ("a: f32, b: f32", "select(b, a, a > b)"),
            Self::Copysign => (
                "magnitude: f32, sign: f32",
                "bitcast<f32>((bitcast<u32>(magnitude) & 0x7fffffffu) | (bitcast<u32>(sign) & 0x80000000u))",
            ),
            Self::Fused => (
                "a: f32, b: f32, c: f32",
                match arithmetic.fma {
                    Fma::Native => "fma(a, b, c)",
                    Fma::Double => unreachable!("it takes more than a line"),
                    Fma::Unfused => "a * b + c",
                },
            ),
            Self::Quotient => (
                "a: f32, b: f32",
                match arithmetic.division {
                    Division::Native => "a / b",
                    Division::Double => "f32(f64(a) / f64(b))",
                },
            ),
            Self::Root => (
                "a: f32",
                match arithmetic.square_root {
                    SquareRoot::Native => "sqrt(a)",
                    SquareRoot::Double => "f32(sqrt(f64(a)))",
                },
            ),
        };
        let name = self.name();
        format!("fn {name}({parameters}) -> f32 {{\n    return {value};\n}}\n")
    }

    /// Those whose names a text calls.
    pub(crate) fn called_in(text: &str) -> BTreeSet<Self> {
        let calls = |helper: &Self| {
            let call = format!("{}(", helper.name());
            let mut places = text.match_indices(&call);
            places.any(|(at, _)| {
                let before = text[..at].chars().next_back();
                before.is_none_or(|c| !c.is_alphanumeric() && c != '_')
            })
        };
        Self::ALL.into_iter().filter(calls).collect()
    }
}
