//! The interpreted renderer: a scene's structure as boxed nodes. It starts at once and needs no compiler.

use residual_bvh::{Hit, Ray};

use super::boxed::{self, BoxedAlpha, BoxedMaterial};
use super::{LightNode, Structure};
use crate::alpha::is_there;
use crate::camera::AnyCamera;
use crate::domain::{Buffers, Domain, Scalar};
use crate::layer::Layers;
use crate::light::{Area, Directional, Environment, LightKind, Point, Spot};
use crate::sampler::AnySampler;
use crate::scene::{MaterialVisitor, Scene};
use crate::tracer::{AnyTracer, Layered, Settings, TracerNode};
use crate::triangle::program_in;

/// A scene as boxed nodes over a domain.
pub struct Interpreted<'a, D: Domain> {
    buffers: &'a Buffers<'a>,
    materials: Vec<BoxedMaterial<'a, D>>,
    alphas: Vec<Option<BoxedAlpha<'a, Scalar<'a>>>>,
    lights: Vec<Box<dyn LightKind<D> + Send + Sync + 'a>>,
    camera: AnyCamera,
    sampler: AnySampler,
    tracer: TracerNode,
    layers: Layers,
}

impl<'a, D: Domain + 'a> Interpreted<'a, D> {
    /// Builds the nodes of a structure whose data are in `buffers`.
    pub fn new(structure: &Structure, buffers: &'a Buffers<'a>) -> Self {
        let light = |node: &LightNode| -> Box<dyn LightKind<D> + Send + Sync + 'a> {
            match node {
                LightNode::Area {
                    emission,
                    attributes,
                } => Box::new(Area {
                    emission: boxed::color(emission),
                    attributes: *attributes,
                }),
                LightNode::Point => Box::new(Point),
                LightNode::Spot => Box::new(Spot),
                LightNode::Directional => Box::new(Directional),
                LightNode::Environment => Box::new(Environment),
            }
        };
        let alphas = structure
            .programs
            .iter()
            .map(|program| program.alpha.as_ref().map(BoxedAlpha::new));
        Self {
            buffers,
            materials: structure.programs.iter().map(BoxedMaterial::new).collect(),
            alphas: alphas.collect(),
            lights: structure.lights.iter().map(light).collect(),
            camera: structure.camera,
            sampler: structure.sampler,
            tracer: structure.tracer,
            layers: structure.layers,
        }
    }
}

impl<'a, D: Domain + 'a> Scene<D> for Interpreted<'a, D> {
    type Camera = AnyCamera;
    type Tracer = Layered<AnyTracer<D, AnySampler>, Layers>;
    type Lights = [Box<dyn LightKind<D> + Send + Sync + 'a>];

    fn camera(&self) -> &AnyCamera {
        &self.camera
    }
    fn tracer(&self, settings: Settings<D>) -> Self::Tracer {
        Layered {
            tracer: self.tracer.tracer(self.sampler, settings),
            layers: self.layers,
        }
    }
    fn lights(&self) -> &Self::Lights {
        &self.lights
    }
    fn programs(&self) -> usize {
        self.materials.len()
    }
    fn has_alpha(&self) -> bool {
        self.alphas.iter().any(Option::is_some)
    }
    fn covers(&self, ray: &Ray, hit: &Hit) -> bool {
        let program = program_in(self.buffers, hit.prim) as usize;
        self.alphas[program].as_ref().is_none_or(|alpha| {
            is_there(
                self.buffers,
                alpha.attributes,
                &alpha.alpha,
                &alpha.test,
                ray,
                hit,
            )
        })
    }
    fn visit_material<V: MaterialVisitor<D>>(&self, program: usize, visitor: V) -> V::Output {
        visitor.visit(&self.materials[program])
    }
}
