//! Shading: a contiguous range of paths that hit the same program, in vector lanes.

use std::ops::Range;

use residual_render::bsdf::Bsdf;
use residual_render::domain::{Lanes, MAX_LANES};
use residual_render::light::LightKinds;
use residual_render::material::Material;
use residual_render::math::Color;
use residual_render::sampler::Sampler;
use residual_render::scene::MaterialVisitor;
use residual_render::surface::Surface;
use residual_render::tracer::{PathTracer, Tracer, Vertex};

use crate::stream::{PathStream, Place, ShadowStream, SortedHits, add_to_pixel};

/// Everything that shading one range needs.
pub(crate) struct Shade<'a, D, S, L: ?Sized> {
    pub(crate) d: D,
    pub(crate) tracer: &'a PathTracer<S>,
    pub(crate) lights: &'a L,
    pub(crate) range: Range<usize>,
    pub(crate) paths: &'a PathStream,
    pub(crate) hits: &'a SortedHits,
    pub(crate) max_depth: u32,
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
        material.shade_range(self);
    }
}

/// Shading as a method of the material: the compiler puts methods beside their types, and emitted programs are modules
/// of their own, so that they are compiled in parallel.
trait ShadeRange<D>: Material<D> + Sized
where
    D: Lanes,
{
    #[inline(never)]
    fn shade_range<S, L>(&self, shade: Shade<'_, D, S, L>)
    where
        S: Sampler<D>,
        L: LightKinds<D> + ?Sized,
    {
        let d = shade.d;
        d.vectorize(
            #[inline(always)]
            || shade.run(self),
        );
    }
}

impl<D: Lanes, M: Material<D>> ShadeRange<D> for M {}

impl<D, S, L: ?Sized> Shade<'_, D, S, L> {
    #[inline(always)]
    fn run<M: Material<D>>(self, material: &M)
    where
        D: Lanes,
        S: Sampler<D>,
        L: LightKinds<D>,
    {
        let d = self.d;
        for (places, valid) in lanes::<D>(self.range.clone()) {
            let members = self.hits.members(places);
            let (path, place) = self.paths.load(d, &members);
            let hit = self.hits.load(d, &members);
            let wo = -path.ray.dir;
            let mut surface = Surface::new(d, material.attributes(), &hit, path.ray.dir);
            let shading = material.shade(d, &mut surface, wo);

            if let Some(emission) = shading.emission {
                let seen = self
                    .tracer
                    .on_hit(d, &path, &surface, emission, surface.light);
                add(d, valid, place.pixel, seen, self.radiance);
            }
            let kind = shading.bsdf.kind();
            let goes_on = valid & d.bits(d.lt_u(place.depth, d.uint(self.max_depth)));
            if goes_on == 0 || !(kind.scatters || kind.delta) {
                continue;
            }
            let bsdf = &shading.bsdf;
            let vertex = Vertex {
                surface: &surface,
                bsdf,
                wo,
                depth: place.depth,
            };
            if kind.scatters && !self.lights.is_empty() {
                let shadow = self.tracer.on_shadow(d, &path, &vertex, self.lights);
                let active = d.bits(shadow.active) & goes_on;
                self.shadows.push(d, active, &shadow, place.pixel);
            }
            let bounce = self.tracer.on_bounce(d, &path, &vertex);
            let next = Place {
                depth: place.depth + d.uint(1),
                ..place
            };
            let active = d.bits(bounce.active) & goes_on;
            self.next.push(d, active, &bounce.path, next);
        }
    }
}

/// Adds what rays that hit nothing see.
#[inline(always)]
pub(crate) fn shade_misses<D, S, L>(
    d: D,
    tracer: &PathTracer<S>,
    lights: &L,
    (paths, hits): (&PathStream, &SortedHits),
    range: Range<usize>,
    radiance: &mut [f32],
) where
    D: Lanes,
    S: Sampler<D>,
    L: LightKinds<D> + ?Sized,
{
    for (places, valid) in lanes::<D>(range) {
        let members = hits.members(places);
        let (path, place) = paths.load(d, &members);
        let seen = tracer.on_miss(d, &path, lights);
        add(d, valid, place.pixel, seen, radiance);
    }
}

/// A range in steps of as many places as there are lanes: what is left of it, and the lanes that are in it.
#[inline(always)]
fn lanes<D: Lanes>(range: Range<usize>) -> impl Iterator<Item = (Range<usize>, u32)> {
    let end = range.end;
    range.step_by(D::LANES).map(move |first| {
        let count = (end - first).min(D::LANES);
        (first..end, ((1_u64 << count) - 1) as u32)
    })
}

/// Adds colours to pixels in the lanes whose bit is set.
#[inline(always)]
fn add<D: Lanes>(d: D, bits: u32, pixel: D::U, color: Color<D::F>, radiance: &mut [f32]) {
    let [r, g, b] = [d.to_bits(color.x), d.to_bits(color.y), d.to_bits(color.z)];
    let rows = d.rows([r, g, b, pixel]);
    let mut bits = bits;
    while bits != 0 {
        add_to_pixel(radiance, rows[bits.trailing_zeros() as usize % MAX_LANES]);
        bits &= bits - 1;
    }
}
