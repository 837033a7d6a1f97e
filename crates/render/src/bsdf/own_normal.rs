//! A lobe whose normal is not that of the surface it is on: clear coats over bumpy bases, or with bumps of their own.

use super::{Bsdf, BsdfKind, BsdfProposal, BsdfSample, BsdfValue};
use crate::domain::Domain;
use crate::math::{Color, Frame, Vec3};
use crate::surface::{Surface, decode_normal};
use crate::texture::{ColorSource, ScalarSource};

/// Gives the shading frame of a layer.
pub trait LayerFrame<D: Domain> {
    /// The frame, seen from `wo`, world space.
    fn frame(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Frame<D::F>;
}

/// The mesh's own frame.
#[derive(Clone, Copy, Debug)]
pub struct MeshFrame;

/// The mesh's frame with the normal of a map.
#[derive(Clone, Copy, Debug)]
pub struct MappedFrame<T, S> {
    /// The texel.
    pub texel: T,
    /// Factor on x and y.
    pub scale: S,
}

impl<D: Domain> LayerFrame<D> for MeshFrame {
    #[inline(always)]
    fn frame(&self, _: D, surface: &Surface<D>, _: Vec3<D::F>) -> Frame<D::F> {
        surface.mesh_frame
    }
}

impl<D: Domain, T: ColorSource<D>, S: ScalarSource<D>> LayerFrame<D> for MappedFrame<T, S> {
    #[inline(always)]
    fn frame(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Frame<D::F> {
        let scale = self.scale.scalar(d, surface);
        let local = decode_normal(d, self.texel.color(d, surface), scale);
        surface.mapped_frame(d, local, wo)
    }
}

/// A BSDF in a frame of its own.
#[derive(Clone, Copy, Debug)]
pub struct OwnNormal<B, N> {
    /// The BSDF.
    pub bsdf: B,
    /// Its frame.
    pub normal: N,
}

impl<B, N> OwnNormal<B, N> {
    /// The frame, and `wo` in it.
    #[inline(always)]
    fn turned<D: Domain>(
        &self,
        d: D,
        surface: &Surface<D>,
        wo: Vec3<D::F>,
    ) -> (Frame<D::F>, Vec3<D::F>)
    where
        N: LayerFrame<D>,
    {
        let world = surface.frame.to_world(wo);
        let frame = self.normal.frame(d, surface, world);
        (frame, frame.to_local(d, world))
    }
}

impl<D: Domain, B: Bsdf<D>, N: LayerFrame<D>> Bsdf<D> for OwnNormal<B, N> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        let (frame, wo) = self.turned(d, surface, wo);
        let wi = frame.to_local(d, surface.frame.to_world(wi));
        self.bsdf.eval(d, surface, wo, wi)
    }

    #[inline(always)]
    fn propose(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfProposal<D> {
        let (frame, wo) = self.turned(d, surface, wo);
        let proposal = self.bsdf.propose(d, surface, wo, u);
        let wi = surface.frame.to_local(d, frame.to_world(proposal.wi));
        BsdfProposal { wi, ..proposal }
    }

    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        let (frame, wo) = self.turned(d, surface, wo);
        let sample = self.bsdf.sample(d, surface, wo, u);
        let wi = surface.frame.to_local(d, frame.to_world(sample.wi));
        BsdfSample { wi, ..sample }
    }

    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        let (_, wo) = self.turned(d, surface, wo);
        self.bsdf.albedo(d, surface, wo)
    }

    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        self.bsdf.kind()
    }
}
