//! Two BSDFs on one surface: mixed by a weight, or added.

use super::{Bsdf, BsdfKind, BsdfProposal, BsdfValue};
use crate::domain::Domain;
use crate::math::{Color, Vec3};
use crate::surface::Surface;
use crate::texture::ScalarSource;

/// (1 − weight)·a + weight·b.
#[derive(Clone, Copy, Debug)]
pub struct Mix<A, B, W> {
    /// What is seen at weight 0.
    pub a: A,
    /// What is seen at weight 1.
    pub b: B,
    /// Weight in [0, 1].
    pub weight: W,
}

/// a + b. The caller sees to it that no more comes out than goes in.
#[derive(Clone, Copy, Debug)]
pub struct Sum<A, B, P> {
    /// First summand.
    pub a: A,
    /// Second summand.
    pub b: B,
    /// Probability of sampling `b`, strictly between 0 and 1. It changes the noise, never the mean.
    pub probability: P,
}

/// Factors on two BSDFs and the probability of sampling the second.
pub(super) struct Blend<F> {
    pub(super) factor_a: F,
    pub(super) factor_b: F,
    pub(super) probability_b: F,
}

impl<F: crate::domain::Real> Blend<F> {
    #[inline(always)]
    pub(super) fn eval<D: Domain<F = F>>(
        &self,
        d: D,
        a: BsdfValue<D>,
        b: BsdfValue<D>,
    ) -> BsdfValue<D> {
        let probability_a = d.lit(1.0) - self.probability_b;
        BsdfValue {
            value: a.value.scale(self.factor_a) + b.value.scale(self.factor_b),
            pdf: d.fma(a.pdf, probability_a, b.pdf * self.probability_b),
        }
    }

    /// A direction from either. What it is worth is asked of both: one-sample multiple importance sampling.
    #[inline(always)]
    pub(super) fn propose<D: Domain<F = F>, A: Bsdf<D>, B: Bsdf<D>>(
        &self,
        d: D,
        surface: &Surface<D>,
        wo: Vec3<F>,
        u: [F; 3],
        (a, b): (&A, &B),
    ) -> BsdfProposal<D> {
        let one = d.lit(1.0);
        let tiny = d.lit(1e-9);
        let p = self.probability_b;
        let second = d.lt(u[2], p);
        let probability = d.max(d.select(second, p, one - p), tiny);
        // The part of the interval that was chosen becomes the whole interval of the next choice.
        let rest = d.select(second, u[2], u[2] - p) / probability;
        let u = [u[0], u[1], d.min(rest, d.lit(1.0 - 1.0 / 16_777_216.0))];
        let chosen = d.branch(
            second,
            || b.propose(d, surface, wo, u),
            || a.propose(d, surface, wo, u),
        );
        let factor = d.select(second, self.factor_b, self.factor_a);
        BsdfProposal {
            weight: chosen.weight.scale(factor / probability),
            ..chosen
        }
    }
}

impl<A, B, W> Mix<A, B, W> {
    #[inline(always)]
    fn blend<D: Domain>(&self, d: D, surface: &Surface<D>) -> Blend<D::F>
    where
        W: ScalarSource<D>,
    {
        let weight = self.weight.scalar(d, surface);
        Blend {
            factor_a: d.lit(1.0) - weight,
            factor_b: weight,
            probability_b: weight,
        }
    }
}

impl<D: Domain, A: Bsdf<D>, B: Bsdf<D>, W: ScalarSource<D>> Bsdf<D> for Mix<A, B, W> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let (a, b) = (
            self.a.eval(d, surface, wo, wi),
            self.b.eval(d, surface, wo, wi),
        );
        self.blend(d, surface).eval(d, a, b)
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        self.blend(d, surface)
            .propose(d, surface, wo, u, (&self.a, &self.b))
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let (a, b) = (self.a.albedo(d, surface, wo), self.b.albedo(d, surface, wo));
        a.lerp(b, self.weight.scalar(d, surface))
    }

    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        let of_a = self.a.radiance_scale(d, surface, wi);
        of_a.or_else(|| self.b.radiance_scale(d, surface, wi))
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        self.a.kind().union(self.b.kind())
    }
}

impl<A, B, P> Sum<A, B, P> {
    #[inline(always)]
    fn blend<D: Domain>(&self, d: D, surface: &Surface<D>) -> Blend<D::F>
    where
        P: ScalarSource<D>,
    {
        let one = d.lit(1.0);
        Blend {
            factor_a: one,
            factor_b: one,
            probability_b: self.probability.scalar(d, surface),
        }
    }
}

impl<D: Domain, A: Bsdf<D>, B: Bsdf<D>, P: ScalarSource<D>> Bsdf<D> for Sum<A, B, P> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let (a, b) = (
            self.a.eval(d, surface, wo, wi),
            self.b.eval(d, surface, wo, wi),
        );
        self.blend(d, surface).eval(d, a, b)
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        self.blend(d, surface)
            .propose(d, surface, wo, u, (&self.a, &self.b))
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let sum = self.a.albedo(d, surface, wo) + self.b.albedo(d, surface, wo);
        sum.map(|c| d.min(c, d.lit(1.0)))
    }

    #[inline(always)]
    fn radiance_scale(&self, d: D, surface: &Surface<D>, wi: Vec3<D::F>) -> Option<D::F> {
        let of_a = self.a.radiance_scale(d, surface, wi);
        of_a.or_else(|| self.b.radiance_scale(d, surface, wi))
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        self.a.kind().union(self.b.kind())
    }
}
