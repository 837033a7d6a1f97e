//! Exact sums and products of `f64`, as expansions: sums of numbers that do not overlap.
//!
//! J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
//! Predicates", Discrete & Computational Geometry 18, 1997.
//!
//! None of it under- or overflows for what it is asked: coordinates in `f32` are multiples of
//! 2⁻¹⁴⁹ below 2¹²⁸, so all parts of products of three of their differences are multiples of 2⁻⁴⁴⁷
//! below 2³⁹⁰, far inside the range of `f64`. Nothing is fused.

/// A number as the sum of a rounded number and what the rounding lost.
pub(super) type Pair = [f64; 2];

/// `a + b`.
#[inline]
fn sum(a: f64, b: f64) -> Pair {
    let rounded = a + b;
    let b_part = rounded - a;
    let a_part = rounded - b_part;
    [rounded, (a - a_part) + (b - b_part)]
}

/// `a - b`.
#[inline]
pub(super) fn difference(a: f64, b: f64) -> Pair {
    sum(a, -b)
}

/// `a b`.
#[inline]
fn product(a: f64, b: f64) -> Pair {
    // Two halves of 26 bits or fewer, whose products are exact.
    let split = |x: f64| {
        let scaled = x * ((1u32 << 27) + 1) as f64;
        let high = scaled - (scaled - x);
        [high, x - high]
    };
    let rounded = a * b;
    let ([a_high, a_low], [b_high, b_low]) = (split(a), split(b));
    let rest = rounded - a_high * b_high - a_low * b_high - a_high * b_low;
    [rounded, a_low * b_low - rest]
}

/// A sum of terms that do not overlap, of growing size, none of them zero.
struct Expansion {
    terms: [f64; CAPACITY],
    len: usize,
}

/// Six products of three pairs, four terms for each choice of parts.
const CAPACITY: usize = 6 * 8 * 4;

impl Expansion {
    /// Adds a number. Each grows the expansion by one term at most.
    fn add(&mut self, x: f64) {
        let (mut carry, mut len) = (x, 0);
        for i in 0..self.len {
            let [rounded, lost] = sum(carry, self.terms[i]);
            carry = rounded;
            if lost != 0.0 {
                self.terms[len] = lost;
                len += 1;
            }
        }
        if carry != 0.0 {
            self.terms[len] = carry;
            len += 1;
        }
        self.len = len;
    }

    /// The number to within a few roundings, with the right sign: that of the greatest term.
    fn value(&self) -> f64 {
        self.terms[..self.len].iter().sum()
    }
}

/// `p · (q × r)`: its sign is exact, its value to within a few roundings.
pub(super) fn triple_product(p: [Pair; 3], q: [Pair; 3], r: [Pair; 3]) -> f64 {
    let mut total = Expansion {
        terms: [0.0; CAPACITY],
        len: 0,
    };
    let parts = |pair: Pair| pair.into_iter().filter(|&part| part != 0.0);
    for i in 0..3 {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        for (j, k, sign) in [(j, k, 1.0), (k, j, -1.0)] {
            for q in parts(q[j]) {
                for r in parts(r[k]) {
                    for qr in parts(product(q, r)) {
                        for p in parts(p[i]) {
                            for term in parts(product(sign * p, qr)) {
                                total.add(term);
                            }
                        }
                    }
                }
            }
        }
    }
    total.value()
}
