//! Independent random numbers: the baseline.

use super::hash::{hash, unit};
use super::key::{SampleKey, Sampler};
use crate::domain::Domain;

/// Hashes pixel, sample and dimension.
#[derive(Clone, Copy, Debug, Default)]
pub struct Independent;

impl<D: Domain> Sampler<D> for Independent {
    #[inline(always)]
    fn pair(&self, d: D, key: SampleKey<D::U>, dimension: D::U) -> [D::F; 2] {
        let x = hash(d, key.pixel ^ hash(d, key.index ^ hash(d, dimension)));
        let y = hash(d, x + d.uint(0x9e37_79b9));
        [unit(d, x), unit(d, y)]
    }
}
