//! One step of a path, from a hit to what a device has to do about it (thesis, section 3.2.6): the same on every device.

use super::{Bounce, Features, Path, Shadow, Tracer, Vertex};
use crate::domain::Domain;
use crate::layer::Layers;
use crate::light::LightKinds;
use crate::material::Material;
use crate::math::Color;
use crate::surface::{Surface, SurfaceHit};

/// What becomes of a hit. What is `None` never happens with this material, and takes no code.
#[derive(Clone, Copy)]
pub struct Step<D: Domain> {
    /// Contribution of the vertex itself.
    pub seen: Option<Color<D::F>>,
    /// What layers keep of it.
    pub features: Option<Features<D>>,
    /// A ray that counts if it is not occluded.
    pub shadow: Option<Shadow<D>>,
    /// The way on.
    pub bounce: Option<Bounce<D>>,
}

/// Takes the step of a path whose ray found `hit` on a surface of `material`.
#[inline(always)]
pub fn shade<D, T, M, L>(
    d: D,
    tracer: &T,
    path: &Path<D>,
    hit: &SurfaceHit<D>,
    material: &M,
    lights: &L,
) -> Step<D>
where
    D: Domain,
    T: Tracer<D>,
    M: Material<D>,
    L: LightKinds<D> + ?Sized,
{
    let wo = -path.ray.dir;
    let mut surface = Surface::new(d, material.attributes(), hit, path.ray.dir);
    if let Some(wavelength) = tracer.wavelength(d, path) {
        surface.wavelength = wavelength;
    }
    if material.filters()
        && let Some(cone) = tracer.cone(d, path)
    {
        surface.see_through(d, cone, path.ray.org, material.attributes(), hit.prim);
    }
    let crossing = material
        .interior(d, &surface)
        .and_then(|interior| tracer.crossing(d, path, &surface, interior));
    if let Some(ior) = crossing.and_then(|crossing| crossing.around) {
        surface.around = ior;
    }
    let passage = tracer.passage(d, path, &surface);
    let path = &match passage {
        None => *path,
        Some(passage) => Path {
            throughput: path.throughput * passage.weight,
            ..*path
        },
    };
    let shading = material.shade(d, &mut surface, wo);
    let vertex = Vertex {
        surface: &surface,
        triangle: hit.prim,
        emission: shading.emission,
        bsdf: &shading.bsdf,
        crossing,
        is_in_medium: false,
        scattering: passage.and_then(|passage| passage.scattering),
        disperses: material.disperses(),
        wo,
    };
    let layers = tracer.layers();
    let mut step = Step {
        seen: tracer.on_hit(d, path, &vertex, lights),
        features: (layers != Layers::NONE).then(|| Features::new(d, layers, path, &vertex)),
        shadow: None,
        bounce: None,
    };
    let goes_on = tracer.goes_on(d, path);
    if d.holds_nowhere(goes_on) {
        return step;
    }
    step.shadow = tracer.on_shadow(d, path, &vertex, lights);
    step.bounce = tracer.on_bounce(d, path, &vertex);
    if let Some(shadow) = &mut step.shadow {
        shadow.active = shadow.active & goes_on;
    }
    if let Some(bounce) = &mut step.bounce {
        bounce.active = bounce.active & goes_on;
    }
    step
}
