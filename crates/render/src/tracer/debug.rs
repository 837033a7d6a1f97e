//! Pictures for those who look for mistakes: what is seen first, and what it took to find it.

use super::{CostMap, Path, Settings, Tracer, Vertex};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::math::vec3::vec3;
use crate::math::{Color, Vec3};
use crate::sampler::{Sampler, hash, unit};
use crate::triangle::program_of;

/// What a debug picture shows. What is not there is black.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum DebugView {
    /// Shading normals in world space, [−1, 1] shown as [0, 1].
    Normals,
    /// The first set of texture coordinates, without their whole parts, as red and green.
    TextureCoordinates,
    /// A colour for each material program.
    Programs,
    /// Distance from the eye: white is near, black is [`reach`](super::TracerOptions::reach) and beyond.
    Depth,
    /// Nodes and triangle packets that traversal visited, as a heat map.
    TraversalCost,
}

impl DebugView {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Normals,
        Self::TextureCoordinates,
        Self::Programs,
        Self::Depth,
        Self::TraversalCost,
    ];
}

/// The tracer of a debug picture.
#[derive(Clone, Copy)]
pub struct Debug<D: Domain, S> {
    /// Where random numbers come from.
    pub sampler: S,
    /// Where the depth view ends.
    pub settings: Settings<D>,
    /// What is shown.
    pub view: DebugView,
}

impl<D: Domain, S: Sampler<D>> Tracer<D> for Debug<D, S> {
    #[inline(always)]
    fn on_emit<C: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        camera: &C,
        _: &L,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        self.settings
            .camera_path(d, camera, &self.sampler, pixel, sample)
    }

    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        _: &L,
    ) -> Option<Color<D::F>> {
        let surface = vertex.surface;
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        Some(match self.view {
            DebugView::Normals => {
                let half = d.lit(0.5);
                surface.frame.normal.map(|c| d.fma(c, half, half))
            }
            DebugView::TextureCoordinates => {
                let [u, v] = surface.uv[0].map(|c| c - d.floor(c));
                vec3(u, v, zero)
            }
            DebugView::Programs => {
                let program = program_of(d, vertex.triangle);
                let channel = |salt: u32| unit(d, hash(d, program * d.uint(3) + d.uint(salt)));
                // Never as dark as what is not there.
                vec3(channel(1), channel(2), channel(3)).map(|c| d.fma(c, d.lit(0.8), d.lit(0.2)))
            }
            DebugView::Depth => {
                let distance = (surface.point - path.ray.org).length(d);
                Vec3::splat(one - d.min(distance / self.settings.reach, one))
            }
            DebugView::TraversalCost => return None,
        })
    }

    #[inline(always)]
    fn goes_on(&self, d: D, _: &Path<D>) -> D::M {
        d.truth(false)
    }

    #[inline(always)]
    fn cost_map(&self) -> Option<CostMap> {
        (self.view == DebugView::TraversalCost).then_some(CostMap)
    }
}
