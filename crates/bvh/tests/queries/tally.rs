//! What the comparison of kernels with brute force has found.

use std::ops::AddAssign;

/// The kernels that are compared.
pub(crate) const KERNELS: [&str; 6] = [
    "single",
    "packets",
    "hybrid",
    "one by one",
    "phased",
    "columns",
];

/// What was found; `[kind of ray]` is random or aimed.
#[derive(Clone, Copy, Default)]
pub(crate) struct Tally {
    /// For each precision.
    pub(crate) precisions: [Counts; 3],
}

#[derive(Clone, Copy, Default)]
pub(crate) struct Counts {
    /// Rays, and those that must hit, and those of them that brute force misses.
    pub(crate) rays: [usize; 2],
    pub(crate) inside: [usize; 2],
    pub(crate) misses: [usize; 2],
    /// Answers of hierarchies, `[kernel][kind of ray]`, and those unlike brute force's.
    pub(crate) answers: [[usize; 2]; KERNELS.len()],
    pub(crate) disagreements: [[usize; 2]; KERNELS.len()],
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Tally) {
        for (ours, theirs) in self.precisions.iter_mut().zip(other.precisions) {
            for kind in 0..2 {
                ours.rays[kind] += theirs.rays[kind];
                ours.inside[kind] += theirs.inside[kind];
                ours.misses[kind] += theirs.misses[kind];
                for kernel in 0..KERNELS.len() {
                    ours.answers[kernel][kind] += theirs.answers[kernel][kind];
                    ours.disagreements[kernel][kind] += theirs.disagreements[kernel][kind];
                }
            }
        }
    }
}

fn report(tally: &Tally) {
    for (name, counts) in ["Fast", "Watertight", "Exact"]
        .iter()
        .zip(&tally.precisions)
    {
        for (kind, rays) in ["random", "aimed"].iter().enumerate() {
            println!(
                "{name:10} {rays:6}: {} rays, {} from inside, of which {} miss",
                counts.rays[kind], counts.inside[kind], counts.misses[kind],
            );
            for (kernel, name) in KERNELS.iter().enumerate() {
                let (answers, disagreements) = (
                    counts.answers[kernel][kind],
                    counts.disagreements[kernel][kind],
                );
                if answers == 0 {
                    continue;
                }
                println!(
                    "    {name:8} {answers:12} answers, {disagreements} disagree{}",
                    if disagreements == 0 {
                        format!(" (less than {:.1e} at 95 %)", 3.0 / answers as f64)
                    } else {
                        format!(" ({:.2e})", disagreements as f64 / answers as f64)
                    }
                );
            }
        }
    }
}

pub(crate) fn check(tally: &Tally) {
    report(tally);
    let [fast, watertight, exact] = &tally.precisions;
    for counts in [watertight, exact] {
        assert_eq!(counts.disagreements, [[0; 2]; KERNELS.len()]);
        assert_eq!(counts.misses, [0; 2]);
    }
    for kernel in 0..KERNELS.len() {
        assert_eq!(fast.disagreements[kernel][0], 0);
        // None in five million answers was measured.
        assert!(fast.disagreements[kernel][1] * 100_000 <= fast.answers[kernel][1]);
    }
}
