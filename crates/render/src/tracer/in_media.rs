//! Paths through bodies: what is lost between two surfaces, and which of several bodies is where.

use super::forward::forward;
use super::{
    Bounce, CostMap, Crossing, Matter, MediumRecord, Nesting, Passage, Path, PathOrigin,
    Scattering, Shadow, Tracer, Vertex,
};
use crate::bsdf::{Bsdf, HenyeyGreenstein};
use crate::camera::Camera;
use crate::domain::{Bundle, Domain};
use crate::layer::Layers;
use crate::light::LightKinds;
use crate::math::{Color, Frame, Vec3};
use crate::surface::{PathRay, Surface};

/// A tracer in a scene with bodies that absorb or scatter light (KHR_materials_volume and _volume_scatter), or lie within each
/// other.
///
/// A path knows the media that it is in. Where a ray is scattered before it gets to the surface, that place is the path's
/// vertex, with a phase function for a BSDF, and the surface is none. Where a surface is hidden in a body that goes before its
/// own, the path goes straight on.
#[derive(Clone, Copy)]
pub struct InMedia<T, N, M> {
    /// What is done otherwise.
    pub tracer: T,
    /// How bodies lie to each other.
    pub nesting: N,
    /// What media do.
    pub matter: M,
}

/// The surface that stands for a place at which a ray is scattered: without an error, facing the ray.
#[inline(always)]
fn place_of<D: Domain>(
    d: D,
    path: &Path<D>,
    surface: &Surface<D>,
    scattering: &Scattering<D>,
) -> Surface<D> {
    let back = -path.ray.dir;
    let frame = Frame::around(d, back);
    Surface {
        point: path.ray.org + path.ray.dir.scale(scattering.distance),
        error: Vec3::splat(d.lit(0.0)),
        geometric_normal: back,
        frame,
        mesh_frame: frame,
        untilted: [back; 2],
        ..*surface
    }
}

impl<T, N, M> InMedia<T, N, M> {
    /// What a shadow ray from a place in `medium` is worth.
    #[inline(always)]
    fn attenuated<D: Domain>(d: D, medium: D::U, shadow: Shadow<D>) -> Shadow<D> {
        // A ray without an end leaves the scene; bodies have a surface, which is in its way.
        let is_finite = d.le(shadow.ray.tmax, d.lit(1.0));
        let length = d.select(is_finite, shadow.ray.dir.length(d), d.lit(0.0));
        let share = MediumRecord::load(d, medium).transmittance(d, length);
        Shadow {
            contribution: shadow.contribution * share,
            ..shadow
        }
    }
}

/// Where a vertex is not that of its surface, and what stands there instead.
#[inline(always)]
fn only_at_the_surface<D: Domain, B>(vertex: &Vertex<'_, D, B>) -> Option<D::M> {
    let hidden = vertex.crossing.and_then(|crossing| crossing.hidden);
    let scattered = vertex.scattering.map(|scattering| scattering.happens);
    match (hidden, scattered) {
        (None, None) => None,
        (Some(mask), None) | (None, Some(mask)) => Some(!mask),
        (Some(a), Some(b)) => Some(!(a | b)),
    }
}

impl<D: Domain, T: Tracer<D>, N: Nesting<D>, M: Matter<D>> Tracer<D> for InMedia<T, N, M> {
    forward!(
        path_origin,
        wavelength,
        cone,
        on_miss,
        goes_on,
        layers,
        cost_map
    );

    /// Paths from the camera begin in the media that it is in; those from lights, outside.
    #[inline(always)]
    fn on_emit<C: Camera<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        camera: &C,
        lights: &L,
        pixel: [D::U; 2],
        sample: D::U,
    ) -> Path<D> {
        let path = self.tracer.on_emit(d, camera, lights, pixel, sample);
        if self.path_origin() == Some(PathOrigin::Lights) {
            return path;
        }
        let around = MediumRecord::load(d, d.uint(0)).around_camera;
        Path {
            state: path.state.in_media(d, around),
            ..path
        }
    }

    #[inline(always)]
    fn crossing(
        &self,
        d: D,
        path: &Path<D>,
        surface: &Surface<D>,
        interior: D::U,
    ) -> Option<Crossing<D>> {
        let media = path.state.media(d);
        Some(self.nesting.crossing(d, media, surface.front, interior))
    }

    #[inline(always)]
    fn passage(&self, d: D, path: &Path<D>, surface: &Surface<D>) -> Option<Passage<D>> {
        let length = (surface.point - path.ray.org).length(d);
        let medium = MediumRecord::load(d, self.nesting.medium(d, path.state));
        Some(self.matter.passage(d, path, &medium, length))
    }

    #[inline(always)]
    fn on_hit<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Color<D::F>> {
        let seen = self.tracer.on_hit(d, path, vertex, lights)?;
        Some(match only_at_the_surface(vertex) {
            None => seen,
            Some(there) => seen.only(d, there),
        })
    }

    #[inline(always)]
    fn on_shadow<B: Bsdf<D>, L: LightKinds<D> + ?Sized>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
        lights: &L,
    ) -> Option<Shadow<D>> {
        let medium = self.nesting.medium(d, path.state);
        let at_surface = self
            .tracer
            .on_shadow(d, path, vertex, lights)
            .map(|shadow| {
                let medium = match &vertex.crossing {
                    None => medium,
                    Some(crossing) => {
                        let dir = shadow.ray.dir;
                        let state = crossing.towards(d, path.state, vertex.surface, dir);
                        self.nesting.medium(d, state)
                    }
                };
                let mut shadow = Self::attenuated(d, medium, shadow);
                if let Some(there) = only_at_the_surface(vertex) {
                    shadow.active = shadow.active & there;
                }
                shadow
            });
        let Some(scattering) = &vertex.scattering else {
            return at_surface;
        };
        let place = place_of(d, path, vertex.surface, scattering);
        let phase = HenyeyGreenstein(scattering.anisotropy);
        let scattered = vertex.scattered(&place, &phase);
        let mut shadow = self.tracer.on_shadow(d, path, &scattered, lights)?;
        shadow.active = shadow.active & scattering.happens;
        let shadow = Self::attenuated(d, medium, shadow);
        Some(match at_surface {
            None => shadow,
            Some(other) => Shadow::choose(d, scattering.happens, shadow, other),
        })
    }

    #[inline(always)]
    fn on_bounce<B: Bsdf<D>>(
        &self,
        d: D,
        path: &Path<D>,
        vertex: &Vertex<'_, D, B>,
    ) -> Option<Bounce<D>> {
        let surface = vertex.surface;
        let mut bounce = self.tracer.on_bounce(d, path, vertex);
        if let (Some(bounce), Some(crossing)) = (&mut bounce, &vertex.crossing) {
            let dir = bounce.path.ray.dir;
            bounce.path.state = crossing.towards(d, bounce.path.state, surface, dir);
            if let Some(hidden) = crossing.hidden {
                let straight = straight_on(d, path, surface, crossing);
                *bounce = Bounce::choose(d, hidden, straight, *bounce);
            }
        }
        let Some(scattering) = &vertex.scattering else {
            return bounce;
        };
        let place = place_of(d, path, surface, scattering);
        let phase = HenyeyGreenstein(scattering.anisotropy);
        let scattered = vertex.scattered(&place, &phase);
        let scattered = self.tracer.on_bounce(d, path, &scattered)?;
        let Some(bounce) = bounce else {
            let active = scattered.active & scattering.happens;
            return Some(Bounce {
                active,
                ..scattered
            });
        };
        Some(Bounce::choose(d, scattering.happens, scattered, bounce))
    }
}

/// The way through a surface that is not there. No light was sampled beyond it, for which it is one.
#[inline(always)]
fn straight_on<D: Domain>(
    d: D,
    path: &Path<D>,
    surface: &Surface<D>,
    crossing: &Crossing<D>,
) -> Bounce<D> {
    let dir = path.ray.dir;
    Bounce {
        path: Path {
            ray: PathRay::unbounded(d, surface.spawn(d, dir), dir),
            pdf: d.lit(0.0),
            state: path.state.next(d).in_media(d, crossing.beyond),
            ..*path
        },
        active: d.truth(true),
    }
}
