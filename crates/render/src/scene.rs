//! What a device needs of a renderer: the seam along which specialisation replaces one by another.

use residual_bvh::HitFilter;

use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKinds;
use crate::material::Material;
use crate::sampler::Sampler;

/// Code to be run with a scene's material, whose type only the scene knows.
pub trait MaterialVisitor<D: Domain> {
    /// What the visit yields.
    type Output;
    /// Called with the material.
    fn visit<M: Material<D>>(self, material: &M) -> Self::Output;
}

/// The structure of a scene, as code. Emitted scenes are made of concrete types; `program::Interpreted` of boxes.
///
/// As a [`HitFilter`] it says which triangles are seen from which side, and what alpha lets through.
pub trait Scene<D: Domain>: HitFilter + Sync {
    /// The camera's kind.
    type Camera: Camera<D>;
    /// The sampler's kind.
    type Sampler: Sampler<D> + Copy;
    /// The kinds of lights.
    type Lights: LightKinds<D> + ?Sized;

    /// The camera.
    fn camera(&self) -> &Self::Camera;
    /// The sampler.
    fn sampler(&self) -> Self::Sampler;
    /// The lights.
    fn lights(&self) -> &Self::Lights;
    /// How many material programs there are.
    fn programs(&self) -> usize;
    /// Runs `visitor` with program number `program`.
    fn visit_material<V: MaterialVisitor<D>>(&self, program: usize, visitor: V) -> V::Output;
}
