//! The truth ladder: what accuracy switches cost, and what they remove.

use residual_accuracy::Estimate;

use super::finding::Finding;
use super::level::Level;
use super::measured::{Measured, Study, last};
use crate::configuration::{Removes, SWITCHES, Switch};
use crate::probe::sums::NAMED;

/// A switch between time and truth, with its price and what that buys.
#[derive(Clone, Debug)]
pub struct Rung {
    /// The switch.
    pub switch: &'static Switch,
    /// Time with it ÷ time without it − 1; none where it costs nothing that could be measured.
    pub time: Estimate,
    /// What is wrong without it.
    pub without: Level,
    /// What is wrong with it.
    pub with: Level,
}

/// The switches between configurations that were measured.
pub(super) fn ladder(study: &Study, findings: &[Finding]) -> Vec<Rung> {
    let measured = |name: &str| {
        let is = |m: &&Measured| m.configuration.name == name;
        study.measured.iter().find(is)
    };
    let found = |name: &str| findings.iter().find(|f| f.configuration.name == name);
    let rung = |switch: &'static Switch| {
        let (without, with) = (measured(switch.without)?, measured(switch.with)?);
        let ratios = with.seconds().zip(without.seconds());
        let time = Estimate::of(ratios.map(|(with, without)| with / without - 1.0).collect());
        let (time, without, with) = match switch.removes {
            Removes::Bias => (
                time,
                found(switch.without)?.relative_bias(),
                found(switch.with)?.relative_bias(),
            ),
            Removes::Misses(without, with) => {
                let level = |precision| {
                    let (_, rate) = study.misses.iter().find(|(of, _)| *of == precision)?;
                    Some(Level::of_rate(*rate))
                };
                (time, level(without)?, level(with)?)
            }
            Removes::Stagnation => {
                let sums = study.sums.as_ref()?;
                let pixels = study.reference.image.len() as f64;
                let samples = last(&with.runs[0]).samples as f64;
                // Both are sums of the samples; what a sample takes in all is measured, and has both in it.
                let parts = with
                    .seconds()
                    .map(|seconds| sums.seconds * pixels * samples / seconds);
                let unit = f64::EPSILON / 2.0;
                let value = sums.named_error();
                let without = Level::Seen {
                    value,
                    interval: [value; 2],
                };
                // The bound of a sum of as many numbers of one sign, n·u (Higham 2002, 4.2).
                let bound = NAMED as f64 * unit;
                (Estimate::of(parts.collect()), without, Level::Below(bound))
            }
        };
        Some(Rung {
            switch,
            time,
            without,
            with,
        })
    };
    SWITCHES.iter().filter_map(rung).collect()
}
