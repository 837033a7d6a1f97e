//! Shading: a contiguous range of paths that hit the same program, in vector lanes.

use std::ops::Range;

use residual_render::bsdf::Bsdf;
use residual_render::domain::Lanes;
use residual_render::light::LightKinds;
use residual_render::material::Material;
use residual_render::math::Color;
use residual_render::sampler::Sampler;
use residual_render::scene::MaterialVisitor;
use residual_render::surface::Surface;
use residual_render::tracer::{PathTracer, Tracer, Vertex};

use crate::stream::{PathStream, ShadowStream, SortedHits};

/// Everything that shading one range needs.
pub(crate) struct Shade<'a, D, S, L: ?Sized> {
    pub(crate) d: D,
    pub(crate) tracer: &'a PathTracer<S>,
    pub(crate) lights: &'a L,
    pub(crate) range: Range<usize>,
    pub(crate) paths: &'a PathStream,
    pub(crate) hits: &'a SortedHits,
    pub(crate) depth: u32,
    /// No path goes on from here.
    pub(crate) last: bool,
    pub(crate) next: &'a mut PathStream,
    pub(crate) shadows: &'a mut ShadowStream,
    pub(crate) radiance: &'a mut [f32],
}

impl<D, S, L> MaterialVisitor<D> for Shade<'_, D, S, L>
where
    D: Lanes,
    S: Sampler<D>,
    L: LightKinds<D> + ?Sized,
{
    type Output = ();

    #[inline(always)]
    fn visit<M: Material<D>>(self, material: &M) {
        let d = self.d;
        d.vectorize(
            #[inline(always)]
            || self.run(material),
        );
    }
}

impl<D, S, L: ?Sized> Shade<'_, D, S, L> {
    #[inline(always)]
    fn run<M: Material<D>>(self, material: &M)
    where
        D: Lanes,
        S: Sampler<D>,
        L: LightKinds<D>,
    {
        let d = self.d;
        for i in self.range.clone().step_by(D::LANES) {
            let count = (self.range.end - i).min(D::LANES);
            let valid = ((1_u64 << count) - 1) as u32;
            let (path, ids) = self.paths.load(d, i);
            let hit = self.hits.load(d, i);
            let wo = -path.ray.dir;
            let mut surface = Surface::new(d, material.attributes(), &hit, path.ray.dir);
            let shading = material.shade(d, &mut surface, wo);

            if let Some(emission) = shading.emission {
                let seen = self
                    .tracer
                    .on_hit(d, &path, &surface, emission, surface.light);
                add(d, &ids[..count], seen, self.radiance);
            }
            let kind = shading.bsdf.kind();
            if self.last || !(kind.scatters || kind.delta) {
                continue;
            }
            let bsdf = &shading.bsdf;
            let vertex = Vertex {
                surface: &surface,
                bsdf,
                wo,
                depth: d.uint(self.depth),
            };
            let id = d.word(ids);
            if kind.scatters && !self.lights.is_empty() {
                let shadow = self.tracer.on_shadow(d, &path, &vertex, self.lights);
                self.shadows
                    .push(d, d.bits(shadow.active) & valid, &shadow, id);
            }
            let bounce = self.tracer.on_bounce(d, &path, &vertex);
            self.next
                .push(d, d.bits(bounce.active) & valid, &bounce.path, id);
        }
    }
}

/// Adds what rays that hit nothing see.
#[inline(always)]
pub(crate) fn shade_misses<D, S, L>(
    d: D,
    tracer: &PathTracer<S>,
    lights: &L,
    range: &Range<usize>,
    paths: &PathStream,
    radiance: &mut [f32],
) where
    D: Lanes,
    S: Sampler<D>,
    L: LightKinds<D> + ?Sized,
{
    for i in range.clone().step_by(D::LANES) {
        let count = (range.end - i).min(D::LANES);
        let (path, ids) = paths.load(d, i);
        let seen = tracer.on_miss(d, &path, lights);
        add(d, &ids[..count], seen, radiance);
    }
}

/// Adds colours to the pixels `ids`.
#[inline(always)]
fn add<D: Lanes>(d: D, ids: &[u32], color: Color<D::F>, radiance: &mut [f32]) {
    let mut lanes = [[0.0; 16]; 3];
    for (lanes, value) in lanes.iter_mut().zip([color.x, color.y, color.z]) {
        d.store(value, &mut lanes[..D::LANES]);
    }
    for (lane, &id) in ids.iter().enumerate() {
        for (channel, lanes) in lanes.iter().enumerate() {
            radiance[id as usize * 3 + channel] += lanes[lane];
        }
    }
}
