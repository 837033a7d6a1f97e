//! Alias tables (Walker 1974, Vose 1991): outcomes drawn with given probabilities by reading one entry.

use crate::domain::{Buffer, Domain};
use crate::record::record;

record! {
    /// A slot of a table: it yields the outcome of its own index, or its alias.
    pub struct AliasEntry {
        row {
            /// The part of the slot, from 0 on, in which it yields its own index.
            threshold: real,
            /// Index of the other outcome.
            alias: word,
            /// Density of the outcome that has the slot's index.
            density: real,
            /// Density of the alias.
            alias_density: real,
        }
    }
}

/// The largest number below 1 that samplers give.
pub const BELOW_ONE: f64 = 1.0 - 1.0 / (1 << 24) as f64;

/// What was drawn.
#[derive(Clone, Copy, Debug)]
pub struct Outcome<D: Domain> {
    /// Its index.
    pub index: D::U,
    /// Its density.
    pub density: D::F,
    /// What is left of the number that decided, stretched to [0, 1): uniform again, whatever was drawn, and as evenly spread
    /// over each outcome as the numbers were over all.
    pub rest: D::F,
}

/// A table in a buffer: its entries go on to the buffer's end.
#[derive(Clone, Copy, Debug)]
pub struct AliasTable {
    /// The buffer.
    pub buffer: Buffer,
    /// The word at which the first entry starts.
    pub first: u32,
}

impl AliasTable {
    /// The first word of an entry.
    #[inline(always)]
    fn entry<D: Domain>(self, d: D, index: D::U) -> D::U {
        index * d.uint(AliasEntry::WORDS) + d.uint(self.first)
    }

    /// The outcome for a slot and a number in [0, 1): the slot itself or its alias.
    #[inline(always)]
    pub fn resolve<D: Domain>(self, d: D, slot: D::U, u: D::F) -> Outcome<D> {
        let entry = AliasEntry::load_at(d, self.buffer, self.entry(d, slot));
        let stays = d.lt(u, entry.threshold);
        let within = d.select(stays, u, u - entry.threshold);
        let width = d.select(stays, entry.threshold, d.lit(1.0) - entry.threshold);
        Outcome {
            index: d.select_u(stays, slot, entry.alias),
            density: d.select(stays, entry.density, entry.alias_density),
            rest: d.min(within / width, d.lit(BELOW_ONE)),
        }
    }

    /// The density of an outcome.
    #[inline(always)]
    pub fn density<D: Domain>(self, d: D, outcome: D::U) -> D::F {
        let offset = AliasEntry::offsets().density;
        d.load_real(self.buffer, self.entry(d, outcome) + d.uint(offset))
    }
}

/// The entries of a table over `weights`, which are finite, not negative, and not all zero; none, if there are none. A density is a weight in terms of
/// `unit`.
pub fn alias_entries(weights: &[f64], unit: f64) -> impl ExactSizeIterator<Item = AliasEntry> {
    let density = move |outcome: usize| (weights[outcome] / unit) as f32;
    let entry = move |(index, slot): (usize, Slot)| AliasEntry {
        threshold: slot.threshold,
        alias: slot.alias,
        density: density(index),
        alias_density: density(slot.alias as usize),
    };
    table(weights).into_iter().enumerate().map(entry)
}

/// One slot: its threshold, and the outcome on the other side of it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Slot {
    threshold: f32,
    alias: u32,
}

/// A table over `weights`, which are finite, not negative, and not all zero.
fn table(weights: &[f64]) -> Vec<Slot> {
    let sum: f64 = weights.iter().sum();
    let scale = weights.len() as f64 / sum;
    let mut left: Vec<f64> = weights.iter().map(|w| w * scale).collect();
    let mut slots: Vec<Slot> = (0..weights.len() as u32)
        .map(|alias| Slot {
            threshold: 1.0,
            alias,
        })
        .collect();
    let (mut small, mut large): (Vec<usize>, Vec<usize>) =
        (0..weights.len()).partition(|&i| left[i] < 1.0);
    while let (Some(s), Some(&l)) = (small.pop(), large.last()) {
        slots[s] = Slot {
            threshold: left[s] as f32,
            alias: l as u32,
        };
        left[l] -= 1.0 - left[s];
        if left[l] < 1.0 {
            large.pop();
            small.push(l);
        }
    }
    // What rounding leaves over among the small ones is full up to rounding; but weight 0 stays 0.
    for s in small {
        if weights[s] == 0.0 {
            let heaviest = (0..weights.len()).max_by(|&a, &b| weights[a].total_cmp(&weights[b]));
            slots[s] = Slot {
                threshold: 0.0,
                alias: heaviest.unwrap_or(s) as u32,
            };
        }
    }
    slots
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The probability of each outcome, enumerated from the table.
    fn probabilities(slots: &[Slot]) -> Vec<f64> {
        let n = slots.len() as f64;
        let mut p = vec![0.0; slots.len()];
        for (i, slot) in slots.iter().enumerate() {
            p[i] += f64::from(slot.threshold) / n;
            p[slot.alias as usize] += (1.0 - f64::from(slot.threshold)) / n;
        }
        p
    }

    #[test]
    fn the_table_has_exactly_the_probabilities() {
        // L-06 by enumeration: log-normal weights, zeros, one outlier.
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(state) / 4_294_967_296.0
        };
        let mut weights: Vec<f64> = (0..10_000)
            .map(|_| {
                ((-2.0 * next().max(1e-12).ln()).sqrt()
                    * (next() * std::f64::consts::TAU).cos()
                    * 4.0)
                    .exp()
            })
            .collect();
        weights[17] = 0.0;
        weights[4711] = 1e6;
        let sum: f64 = weights.iter().sum();
        for (w, p) in weights.iter().zip(probabilities(&table(&weights))) {
            let error = (p - w / sum).abs();
            assert!(error <= 1e-5 * w / sum + 2f64.powi(-32), "{w} {p}");
        }
    }

    #[test]
    fn zero_weights_are_never_drawn() {
        for weights in [vec![0.0, 1.0], vec![1.0, 0.0], vec![0.0, 0.0, 3.0, 0.0]] {
            for (w, p) in weights.iter().zip(probabilities(&table(&weights))) {
                assert_eq!(*w == 0.0, p == 0.0);
            }
        }
    }
}
