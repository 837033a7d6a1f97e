//! Any of the samplers.

use super::independent::Independent;
use super::key::{SampleKey, Sampler};
use super::sobol::Sobol;
use crate::domain::Domain;

/// A sampler chosen at run time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum AnySampler {
    /// [`Independent`].
    Independent,
    /// [`Sobol`].
    Sobol,
}

impl<D: Domain> Sampler<D> for AnySampler {
    #[inline(always)]
    fn pair(&self, d: D, key: SampleKey<D::U>, dimension: D::U) -> [D::F; 2] {
        match self {
            Self::Independent => Independent.pair(d, key, dimension),
            Self::Sobol => Sobol.pair(d, key, dimension),
        }
    }
}
