//! What a device needs of a renderer: the seam along which specialisation replaces one by another.

use crate::alpha::Candidate;
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::material::Material;
use crate::tracer::{Settings, Tracer};

/// Code to be run with a scene's material, whose type only the scene knows.
pub trait MaterialVisitor<D: Domain> {
    /// What the visit yields.
    type Output;
    /// Called with the material.
    fn visit<M: Material<D>>(self, material: &M) -> Self::Output;
}

/// The structure of a scene, as code. Emitted scenes are made of concrete types; `program::Interpreted` of boxes.
pub trait Renderer<D: Domain>: Sync {
    /// The camera's kind.
    type Camera: Camera<D>;
    /// The tracer, which has the sampler.
    type Tracer: Tracer<D>;
    /// The kinds of lights.
    type Lights: LightKinds<D> + ?Sized;

    /// The camera.
    fn camera(&self) -> &Self::Camera;
    /// The tracer with these settings.
    fn tracer(&self, settings: Settings<D>) -> Self::Tracer;
    /// The lights.
    fn lights(&self) -> &Self::Lights;
    /// How many material programs there are.
    fn programs(&self) -> usize;
    /// Whether any surface has an alpha test: whether [`alpha_test`](Renderer::alpha_test) is ever false.
    fn has_alpha_tests(&self) -> bool {
        false
    }
    /// Whether the surface is there for this hit: a pure function.
    fn alpha_test(&self, _candidate: &Candidate) -> bool {
        true
    }
    /// Runs `visitor` with program number `program`.
    fn visit_material<V: MaterialVisitor<D>>(&self, program: usize, visitor: V) -> V::Output;
}
