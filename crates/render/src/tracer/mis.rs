//! How light is weighed that two strategies can find: sampling lights, and following the BSDF (Veach 1997, section 9.2).
//!
//! All of these give the same image on average. The last two leave one strategy out wherever the other one can do it alone;
//! they are for comparison: where two strategies agree, neither has a mistake of its own.

use crate::domain::Domain;
use crate::light::power_heuristic;

/// Weights of the two strategies, where both can find the same light: they add up to 1.
pub trait Mis<D: Domain>: Copy {
    /// The weight of a light sample of this density, in a direction of this density of the BSDF.
    fn of_light(self, d: D, light: D::F, bsdf: D::F) -> D::F;

    /// The weight of light that a BSDF sample of this density has found, which light sampling finds with that density, or
    /// not at all.
    fn of_bsdf(self, d: D, bsdf: D::F, light: D::F) -> D::F;
}

/// The power heuristic with exponent 2.
#[derive(Clone, Copy, Debug)]
pub struct PowerHeuristic;

/// The balance heuristic.
#[derive(Clone, Copy, Debug)]
pub struct BalanceHeuristic;

/// Light sampling alone, wherever it can find the light.
#[derive(Clone, Copy, Debug)]
pub struct LightsOnly;

/// BSDF sampling alone, wherever it can find the light: points, spots and suns are sampled all the same.
#[derive(Clone, Copy, Debug)]
pub struct BsdfOnly;

impl<D: Domain> Mis<D> for PowerHeuristic {
    #[inline(always)]
    fn of_light(self, d: D, light: D::F, bsdf: D::F) -> D::F {
        power_heuristic(d, light, bsdf)
    }

    #[inline(always)]
    fn of_bsdf(self, d: D, bsdf: D::F, light: D::F) -> D::F {
        power_heuristic(d, bsdf, light)
    }
}

impl<D: Domain> Mis<D> for BalanceHeuristic {
    #[inline(always)]
    fn of_light(self, _d: D, light: D::F, bsdf: D::F) -> D::F {
        light / (light + bsdf)
    }

    #[inline(always)]
    fn of_bsdf(self, _d: D, bsdf: D::F, light: D::F) -> D::F {
        bsdf / (bsdf + light)
    }
}

impl<D: Domain> Mis<D> for LightsOnly {
    #[inline(always)]
    fn of_light(self, d: D, _light: D::F, _bsdf: D::F) -> D::F {
        d.lit(1.0)
    }

    #[inline(always)]
    fn of_bsdf(self, d: D, _bsdf: D::F, light: D::F) -> D::F {
        let zero = d.lit(0.0);
        d.select(d.lt(zero, light), zero, d.lit(1.0))
    }
}

impl<D: Domain> Mis<D> for BsdfOnly {
    #[inline(always)]
    fn of_light(self, d: D, _light: D::F, _bsdf: D::F) -> D::F {
        d.lit(0.0)
    }

    #[inline(always)]
    fn of_bsdf(self, d: D, _bsdf: D::F, _light: D::F) -> D::F {
        d.lit(1.0)
    }
}

/// Weights chosen at run time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AnyMis {
    /// [`PowerHeuristic`].
    #[default]
    PowerHeuristic,
    /// [`BalanceHeuristic`].
    BalanceHeuristic,
    /// [`LightsOnly`].
    LightsOnly,
    /// [`BsdfOnly`].
    BsdfOnly,
}

macro_rules! each {
    ($any:expr, $mis:ident => $call:expr) => {
        match $any {
            AnyMis::PowerHeuristic => {
                let $mis = PowerHeuristic;
                $call
            }
            AnyMis::BalanceHeuristic => {
                let $mis = BalanceHeuristic;
                $call
            }
            AnyMis::LightsOnly => {
                let $mis = LightsOnly;
                $call
            }
            AnyMis::BsdfOnly => {
                let $mis = BsdfOnly;
                $call
            }
        }
    };
}

impl<D: Domain> Mis<D> for AnyMis {
    #[inline(always)]
    fn of_light(self, d: D, light: D::F, bsdf: D::F) -> D::F {
        each!(self, mis => mis.of_light(d, light, bsdf))
    }

    #[inline(always)]
    fn of_bsdf(self, d: D, bsdf: D::F, light: D::F) -> D::F {
        each!(self, mis => mis.of_bsdf(d, bsdf, light))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{Buffers, Scalar};

    #[test]
    fn weights_add_up_to_one() {
        let d = Scalar::new(&Buffers::EMPTY);
        let all = [
            AnyMis::PowerHeuristic,
            AnyMis::BalanceHeuristic,
            AnyMis::LightsOnly,
            AnyMis::BsdfOnly,
        ];
        for mis in all {
            for (light, bsdf) in [(1.0, 1.0), (0.25, 3.0), (1e6, 1e-3), (2e-7, 5e8)] {
                let sum = mis.of_light(d, light, bsdf) + mis.of_bsdf(d, bsdf, light);
                assert!((sum - 1.0).abs() < 1e-6, "{mis:?} {light} {bsdf}: {sum}");
            }
            // What light sampling cannot find is all of the other's.
            assert_eq!(mis.of_bsdf(d, 0.5, 0.0), 1.0, "{mis:?}");
        }
    }
}
