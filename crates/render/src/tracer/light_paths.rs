//! Paths from lights: light tracing, or particle tracing (Arvo 1986; Dutré, Lafortune and Willems 1993; Veach 1997, section 4.4).
//! A pixel gets light from each vertex that the camera sees.

use super::camera_pairs::{EMISSION_DIRECTION, EMISSION_PLACE, EMISSION_TEXEL};
use super::rivals::{Reversed, Turn, carried_on, cosine, reversed, shared};
use super::vertex_pairs::{LIGHT, pair};
use super::way_on::WayOn;
use super::{Bounce, Path, PathState, Settings, Shadow, Sharing, Tracer, Vertex, consistent};
use crate::bsdf::Bsdf;
use crate::camera::Camera;
use crate::domain::{Bundle, Domain};
use crate::light::{self, EmissionNumbers, LightKinds};
use crate::math::{Color, Vec3};
use crate::sampler::{SampleKey, Sampler, hash};
use crate::surface::{Cone, PathRay};

/// Paths that begin at lights. What arrives at a vertex is what a path tracer's path brings there the other way round, with the
/// same BSDF for the same pair of directions, so that both find the same image (Veach 1997, chapter 5: radiance in glass, and
/// shading normals, are not symmetric).
#[derive(Clone, Copy)]
pub(super) struct LightPaths<D: Domain, S, C, W> {
    pub(super) sampler: S,
    pub(super) settings: Settings<D>,
    pub(super) camera: C,
    pub(super) sharing: W,
}

/// What becomes of a light path's flux at a vertex.
struct Scattered<D: Domain> {
    weight: Color<D::F>,
    /// Density with which a path from the other side would turn the other way; 1 for delta lobes.
    back: D::F,
    /// It could.
    is_consistent: D::M,
}

/// The density with which the path got to its first vertex, per area across its ray, and of a light sample back, per steradian.
struct Beginning<D: Domain> {
    density: D::F,
    found: D::F,
}

impl<D: Domain> Beginning<D> {
    #[inline(always)]
    fn of<B>(d: D, path: &Path<D>, vertex: &Vertex<'_, D, B>) -> Self {
        let way = vertex.surface.point - path.ray.org;
        let is_far = d.lt(path.pdf, d.lit(0.0));
        let squared = d.max(way.dot(d, way), d.lit(1e-36));
        let squared = d.select(is_far, d.lit(1.0), squared);
        Self {
            density: d.abs(path.pdf) / squared,
            found: path.rivals * squared,
        }
    }
}

impl<D: Domain, S: Sampler<D>, C: Camera<D>, W: Sharing> LightPaths<D, S, C, W> {
    /// What paths from the camera are worth that would have come the way from `out` through the vertex, with density `back` for
    /// that turn. At the path's first vertex they then find the light with a sample of it, if the turn is no delta lobe's, or meet it
    /// with their next ray.
    #[inline(always)]
    fn onward<B>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        out: Vec3<D::F>,
        (back, is_delta): (D::F, D::M),
    ) -> D::F {
        let (zero, one) = (d.lit(0.0), d.lit(1.0));
        let begin = Beginning::of(d, path, vertex);
        let met = back / begin.found;
        let sampled = d.select(is_delta, zero, one);
        let turn = Turn {
            first: d.sqrt(d.fma(met, met, sampled)) / begin.density,
            is_first: path.state.is_first(d),
            carried: path.rivals,
            back,
            cosines: [vertex.wo, out].map(|dir| cosine(d, vertex, dir)),
        };
        turn.onward(d)
    }

    /// The factor that a BSDF the other way round leaves of flux: shading normals tell lengths of paths from widths of beams
    /// (Veach 1997, section 5.3.2).
    #[inline(always)]
    fn slant<B>(d: D, vertex: &Vertex<'_, D, B>, out: Vec3<D::F>) -> D::F {
        cosine(d, vertex, out) / cosine(d, vertex, vertex.wo)
    }

    /// What a sampled direction leaves of flux.
    #[inline(always)]
    fn scattered<B: Bsdf<D>>(d: D, vertex: &Vertex<'_, D, B>, way: &WayOn<D>) -> Scattered<D> {
        let Vertex { surface, bsdf, .. } = *vertex;
        let WayOn {
            wo,
            sample,
            dir: out,
            ..
        } = *way;
        let one = d.lit(1.0);
        let slant = Self::slant(d, vertex, out);
        let kind = bsdf.kind();
        let by_density = kind.scatters.then(|| {
            let Reversed {
                value,
                is_consistent,
            } = reversed(d, vertex, out);
            let is_possible =
                d.lt(d.lit(0.0), sample.pdf) & d.lt(d.lit(0.0), sample.weight.max_component(d));
            let density = d.select(is_possible, sample.pdf, one);
            Scattered {
                weight: value.value.only(d, is_possible).scale(slant / density),
                back: value.pdf,
                is_consistent,
            }
        });
        let by_delta = kind.delta.then(|| {
            // Flux is not squeezed into narrower cones as radiance is.
            let scales = [sample.wi, wo].map(|dir| bsdf.radiance_scale(d, surface, dir));
            let scale = match scales {
                [Some(there), Some(here)] => there / here,
                _ => one,
            };
            let cosines = wo.z / d.max(d.abs(sample.wi.z), d.lit(1e-6));
            Scattered {
                weight: sample.weight.scale(scale * cosines * slant),
                back: one,
                is_consistent: consistent(d, surface, out, sample.wi),
            }
        });
        match (by_density, by_delta) {
            (Some(a), None) | (None, Some(a)) => a,
            (Some(a), Some(b)) => Scattered {
                weight: Vec3::choose(d, sample.delta, b.weight, a.weight),
                back: d.select(sample.delta, b.back, a.back),
                is_consistent: d.select_mask(sample.delta, b.is_consistent, a.is_consistent),
            },
            (None, None) => Scattered {
                weight: Vec3::splat(d.lit(0.0)),
                back: one,
                is_consistent: d.truth(false),
            },
        }
    }
}

impl<D: Domain, S: Sampler<D>, C: Camera<D>, W: Sharing> Tracer<D> for LightPaths<D, S, C, W> {
    /// All light paths of an image have one sequence of points: what leaves the lights is well distributed as a whole, wherever it
    /// will be seen.
    #[inline(always)]
    fn on_emit<K: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        _: &K,
        lights: &L,
        [x, y]: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        let [width, height] = self.settings.image.map(|pixels| d.to_uint(pixels));
        let key = SampleKey {
            pixel: hash(d, self.settings.seed + d.uint(0x9e37_79b9)),
            index: (sample * height + y) * width + x,
        };
        let pair = |number: u32| self.sampler.pair(d, key, d.uint(number));
        let third = match lights.takes_three() {
            true => pair(EMISSION_TEXEL)[0],
            false => d.lit(0.0),
        };
        let numbers = EmissionNumbers {
            place: pair(EMISSION_PLACE),
            third,
            direction: pair(EMISSION_DIRECTION),
        };
        let emission = light::emit(d, lights, numbers);
        Path {
            ray: emission.ray,
            throughput: emission.flux,
            pdf: d.select(emission.infinite, -emission.spread, emission.spread),
            rivals: emission.found,
            key,
            state: PathState::first(d),
        }
    }

    /// Textures are read as they are: no pixel is known yet.
    #[inline(always)]
    fn cone(&self, d: D, _: &Path<D>) -> Option<Cone<D>> {
        let zero = d.lit(0.0);
        Some(Cone {
            width: zero,
            angle: zero,
            random: zero,
        })
    }

    #[inline(always)]
    fn goes_on(&self, d: D, path: &Path<D>) -> D::M {
        d.lt_u(path.state.depth(d), self.settings.max_depth)
    }

    /// The way to the camera.
    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        _: &L,
    ) -> Option<Shadow<D>> {
        let Vertex { surface, bsdf, .. } = *vertex;
        if !bsdf.kind().scatters {
            return None;
        }
        let (zero, one, half) = (d.lit(0.0), d.lit(1.0), d.lit(0.5));
        let lens = match self.camera.has_lens() {
            true => pair(d, &self.sampler, path, LIGHT),
            false => [zero; 2],
        };
        let sight = self.camera.sight(d, surface.point, lens);
        let towards = sight.from - surface.point;
        let distance = d.max(towards.length(d), d.lit(1e-18));
        let out = towards.scale(one / distance);
        let Reversed {
            value,
            is_consistent,
        } = reversed(d, vertex, out);
        let seen = self.camera.density(d, -out, distance);
        let weight = match self.sharing.is_shared() {
            true => {
                let turn = (value.pdf, d.truth(false));
                let ratio = self.onward(d, path, vertex, out, turn) * seen;
                shared(d, one, ratio)
            }
            false => one,
        };
        let scale = Self::slant(d, vertex, out) * seen * weight;
        let contribution = path.throughput * value.value.scale(scale);

        let [width, height] = self.settings.image;
        let column = (sight.film[0] + one) * half * width;
        let row = (one - sight.film[1]) * half * height;
        let is_inside = sight.is_before
            & d.le(zero, column)
            & d.lt(column, width)
            & d.le(zero, row)
            & d.lt(row, height);
        let [column, row] = [column, row].map(|x| d.to_uint(d.select(is_inside, x, zero)));
        let org = surface.spawn(d, out);
        Some(Shadow {
            ray: PathRay {
                org,
                dir: sight.from - org,
                tmax: one,
            },
            contribution,
            pixel: Some(row * d.to_uint(width) + column),
            active: is_inside & is_consistent & d.lt(zero, contribution.max_component(d)),
        })
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        let way = WayOn::new(d, &self.sampler, path, vertex)?;
        let WayOn { sample, dir, .. } = way;
        let surface = vertex.surface;
        let scattered = Self::scattered(d, vertex, &way);
        // What counts is what this vertex leaves: flux has no scale of its own.
        let worth = scattered.weight.max_component(d);
        let (alive, scale) = way.survives(d, &self.settings, path, vertex, worth);
        let onward = self.onward(d, path, vertex, dir, (scattered.back, sample.delta));
        Some(Bounce {
            path: Path {
                ray: PathRay::unbounded(d, surface.spawn(d, dir), dir),
                throughput: path.throughput * scattered.weight.scale(scale),
                pdf: sample.pdf,
                rivals: carried_on(d, onward, sample.pdf),
                key: path.key,
                state: path.state.next(d),
            },
            active: alive & scattered.is_consistent,
        })
    }
}
