//! Shading: a contiguous range of paths that hit the same program, in vector lanes.

use std::ops::Range;

use residual_render::domain::{Buffers, Lanes};
use residual_render::layer::Layers;
use residual_render::light::LightKinds;
use residual_render::material::Material;
use residual_render::renderer::MaterialVisitor;
use residual_render::tracer::{self, Features, Tracer};

use crate::ahead;
use crate::samples::Samples;
use crate::stream::{PathStream, ShadowStream, SortedHits};

/// The shading of a stream: what it reads, and where what comes of it goes.
pub(crate) struct Shading<'a, 's, D, T, L: ?Sized> {
    pub(crate) d: D,
    pub(crate) buffers: &'a Buffers<'a>,
    pub(crate) tracer: &'a T,
    pub(crate) lights: &'a L,
    pub(crate) paths: &'a PathStream,
    pub(crate) hits: &'a SortedHits,
    pub(crate) next: &'a mut PathStream,
    pub(crate) shadows: &'a mut ShadowStream,
    pub(crate) samples: &'a mut Samples<'s>,
}

impl<'a, 's, D, T, L> Shading<'a, 's, D, T, L>
where
    D: Lanes,
    T: Tracer<D>,
    L: LightKinds<D> + ?Sized,
{
    /// The shading of the paths in a range of the sorted hits, all on the same material.
    pub(crate) fn of(&mut self, range: Range<usize>) -> ShadeRange<'_, 'a, 's, D, T, L> {
        ShadeRange {
            shading: self,
            range,
        }
    }

    #[inline(always)]
    fn hits<M: Material<D>>(&mut self, range: Range<usize>, material: &M) {
        let d = self.d;
        let attributes = material.attributes();
        for (rest, valid) in lanes::<D>(range) {
            let [soon, later] = [1, 2].map(|groups| rest.start + groups * D::LANES);
            for triangle in self.hits.triangles::<D>(later) {
                ahead::triangle(self.buffers, triangle);
            }
            for triangle in self.hits.triangles::<D>(soon) {
                ahead::vertices(self.buffers, triangle, attributes);
            }
            let members = self.hits.members(rest);
            let (path, sample) = self.paths.load(d, &members);
            let hit = self.hits.load(d, &members);
            let step = tracer::shade(d, self.tracer, &path, &hit, material, self.lights);
            if let Some(seen) = step.seen {
                self.samples.add(d, valid, sample, seen);
            }
            if let Some(features) = &step.features {
                let first = d.bits(features.first) & valid;
                self.samples
                    .set(d, first, sample, features.channels(self.tracer.layers()));
            }
            if let Some(shadow) = &step.shadow {
                let active = d.bits(shadow.active) & valid;
                let sample = match shadow.pixel {
                    None => sample,
                    Some(pixel) => sample + pixel,
                };
                self.shadows.push(d, active, shadow, sample);
            }
            if let Some(bounce) = &step.bounce {
                let active = d.bits(bounce.active) & valid;
                self.next.push(d, active, &bounce.path, sample);
            }
        }
    }

    /// Adds what the rays in a range see, which hit nothing.
    #[inline(always)]
    pub(crate) fn misses(&mut self, range: Range<usize>) {
        let d = self.d;
        for (rest, valid) in lanes::<D>(range) {
            let members = self.hits.members(rest);
            let (path, sample) = self.paths.load(d, &members);
            if let Some(seen) = self.tracer.on_miss(d, &path, self.lights) {
                self.samples.add(d, valid, sample, seen);
            }
            let layers = self.tracer.layers();
            if layers != Layers::NONE {
                let features = Features::of_miss(d, layers, &path);
                let first = d.bits(features.first) & valid;
                self.samples
                    .set(d, first, sample, features.channels(layers));
            }
        }
    }
}

/// The shading of one range.
pub(crate) struct ShadeRange<'x, 'a, 's, D, T, L: ?Sized> {
    shading: &'x mut Shading<'a, 's, D, T, L>,
    range: Range<usize>,
}

impl<D, T, L> MaterialVisitor<D> for ShadeRange<'_, '_, '_, D, T, L>
where
    D: Lanes,
    T: Tracer<D>,
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
trait Shade<D>: Material<D> + Sized
where
    D: Lanes,
{
    #[inline(never)]
    fn shade_range<T, L>(&self, of: ShadeRange<'_, '_, '_, D, T, L>)
    where
        T: Tracer<D>,
        L: LightKinds<D> + ?Sized,
    {
        let ShadeRange { shading, range } = of;
        shading.d.vectorize(
            #[inline(always)]
            || shading.hits(range, self),
        );
    }
}

impl<D: Lanes, M: Material<D>> Shade<D> for M {}

/// A range in steps of as many paths as there are lanes: what is left of it, and the lanes that are in it.
#[inline(always)]
fn lanes<D: Lanes>(range: Range<usize>) -> impl Iterator<Item = (Range<usize>, u32)> {
    let end = range.end;
    range.step_by(D::LANES).map(move |first| {
        let count = (end - first).min(D::LANES);
        (first..end, ((1_u64 << count) - 1) as u32)
    })
}
