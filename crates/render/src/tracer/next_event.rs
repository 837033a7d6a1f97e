//! Next-event estimation: light that arrives at a vertex from a sampled place (thesis, section 3.3; PBRT 4, section 13.4).

use super::vertex_pairs::{LIGHT, LIGHT_TEXEL_AND_MEDIUM, pair};
use super::{Path, Shadow, Vertex, consistent};
use crate::bsdf::{Bsdf, BsdfValue};
use crate::domain::Domain;
use crate::light::{self, LightKinds, LightSample};
use crate::math::Vec3;
use crate::sampler::Sampler;
use crate::surface::PathRay;

/// A sampled light, as a vertex sees it.
pub(super) struct NextEvent<D: Domain> {
    /// The light.
    pub(super) sample: LightSample<D>,
    /// What the BSDF makes of it.
    pub(super) value: BsdfValue<D>,
    /// Its direction, in the shading frame.
    wi: Vec3<D::F>,
}

impl<D: Domain> NextEvent<D> {
    /// Samples a light; nothing where there are none, or where the BSDF has only delta lobes.
    #[inline(always)]
    pub(super) fn new<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        d: D,
        sampler: &impl Sampler<D>,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Self> {
        let Vertex { surface, bsdf, .. } = *vertex;
        if !bsdf.kind().scatters || lights.is_empty() {
            return None;
        }
        let [x, y] = pair(d, sampler, path, LIGHT);
        let third = match lights.takes_three() {
            true => pair(d, sampler, path, LIGHT_TEXEL_AND_MEDIUM)[0],
            false => d.lit(0.0),
        };
        let sample = light::sample(d, lights, surface.point, [x, y, third]);
        let wo = surface.frame.to_local(d, vertex.wo);
        let wi = surface.frame.to_local(d, sample.wi);
        let value = bsdf.eval(d, surface, wo, wi);
        Some(Self { sample, value, wi })
    }

    /// The shadow ray to the light, which counts with this weight.
    #[inline(always)]
    pub(super) fn shadow<B>(
        self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        weight: D::F,
    ) -> Shadow<D> {
        let Self { sample, value, wi } = self;
        let surface = vertex.surface;
        let contribution =
            path.throughput * value.value * sample.radiance.scale(weight / sample.pdf);
        let org = surface.spawn(d, sample.wi);
        let dir = sample.position - org;
        let pick = |a: D::F, b: D::F| d.select(sample.infinite, a, b);
        Shadow {
            ray: PathRay {
                org,
                dir: Vec3 {
                    x: pick(sample.wi.x, dir.x),
                    y: pick(sample.wi.y, dir.y),
                    z: pick(sample.wi.z, dir.z),
                },
                tmax: pick(d.lit(f64::from(f32::MAX)), d.lit(1.0)),
            },
            contribution,
            pixel: None,
            active: consistent(d, surface, sample.wi, wi)
                & d.lt(d.lit(0.0), contribution.max_component(d)),
        }
    }
}
