//! Reasons not to trust a stated error.

/// Why a stated interval may not hold the truth as often as it says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distrust {
    /// Few bright samples carry the error: there may be others that no path has found yet.
    HeavyTails {
        /// Over how many pixels the error is spread, in effect: (Σ c)² ÷ Σ c² of the pixels' contributions.
        pixels: f64,
    },
    /// The pixels' means are too noisy to say what a relative error is relative to.
    NoisyMeans,
    /// Too few pixels were sampled a second time.
    FewReplicates {
        /// How many were.
        replicates: usize,
    },
    /// The second samples say too little of how well the points are distributed.
    WideInterval {
        /// Standard error of the estimate, relative to it.
        relative: f64,
    },
}

impl std::fmt::Display for Distrust {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::HeavyTails { pixels } => write!(
                f,
                "few bright samples carry the error, that of {pixels:.0} pixels in effect; \
                 there may be others that no path has found yet"
            ),
            Self::NoisyMeans => {
                f.write_str("the pixels are too noisy to say what their error is relative to; more samples say more")
            }
            Self::FewReplicates { replicates } => {
                write!(f, "only {replicates} pixels were sampled twice")
            }
            Self::WideInterval { relative } => write!(
                f,
                "its own standard error is {:.0} % of it; larger images say more",
                100.0 * relative
            ),
        }
    }
}
