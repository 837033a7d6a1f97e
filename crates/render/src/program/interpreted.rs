//! The interpreted renderer: a scene's structure as boxed nodes. It starts at once and needs no compiler.

use super::any_camera::AnyCamera;
use super::boxed::Boxing;
use super::{BoxedLights, BoxedMaterial, Structure};
use crate::alpha::{AlphaTest, Candidate, alpha_test};
use crate::domain::{Buffers, Domain, Scalar};
use crate::layer::Layers;
use crate::renderer::{MaterialVisitor, Renderer};
use crate::sampler::AnySampler;
use crate::tracer::{AnyTracer, Between, Layered, Settings, TracerNode};
use crate::triangle::program_in;

/// A scene as boxed nodes over a domain.
pub struct Interpreted<'a, D: Domain> {
    buffers: &'a Buffers<'a>,
    materials: Vec<BoxedMaterial<'a, D>>,
    alpha_tests: Vec<Option<Box<dyn AlphaTest<Scalar<'a>> + Send + Sync + 'a>>>,
    lights: BoxedLights<'a, D>,
    camera: AnyCamera,
    sampler: AnySampler,
    tracer: TracerNode,
    between: Between,
    layers: Layers,
}

impl<'a, D: Domain + 'a> Interpreted<'a, D> {
    /// Builds the nodes of a structure whose data are in `buffers`.
    pub fn new(structure: &Structure, buffers: &'a Buffers<'a>) -> Self {
        let programs = structure.programs.iter();
        let alpha_tests = programs.map(|program| program.alpha_test.as_ref().map(Boxing::boxed));
        Self {
            buffers,
            materials: structure.programs.iter().map(BoxedMaterial::new).collect(),
            alpha_tests: alpha_tests.collect(),
            lights: BoxedLights::new(structure),
            camera: AnyCamera::from(&structure.camera),
            sampler: structure.sampler,
            tracer: structure.tracer,
            between: structure.between,
            layers: structure.layers,
        }
    }
}

impl<'a, D: Domain + 'a> Renderer<D> for Interpreted<'a, D> {
    type Camera = AnyCamera;
    type Tracer = Layered<AnyTracer<D, AnySampler, AnyCamera>, Layers>;
    type Lights = BoxedLights<'a, D>;

    fn camera(&self) -> &Self::Camera {
        &self.camera
    }
    fn tracer(&self, settings: Settings<D>) -> Self::Tracer {
        Layered {
            tracer: self
                .tracer
                .tracer(self.between, self.sampler, settings, self.camera),
            layers: self.layers,
        }
    }
    fn lights(&self) -> &Self::Lights {
        &self.lights
    }
    fn programs(&self) -> usize {
        self.materials.len()
    }
    fn has_alpha_tests(&self) -> bool {
        self.alpha_tests.iter().any(Option::is_some)
    }
    fn alpha_test(&self, candidate: &Candidate) -> bool {
        let program = program_in(self.buffers, candidate.triangle) as usize;
        self.alpha_tests[program]
            .as_ref()
            .is_none_or(|test| alpha_test(self.buffers, test, candidate))
    }
    fn visit_material<V: MaterialVisitor<D>>(&self, program: usize, visitor: V) -> V::Output {
        visitor.visit(&self.materials[program])
    }
}
