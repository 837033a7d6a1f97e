//! Material programs as boxed nodes, over any domain.

use super::{EmissionNode, NormalNode, Program, SourceNode, TangentNode};
use crate::bsdf::Bsdf;
use crate::domain::Domain;
use crate::material::{Material, Shading, front_only, medium};
use crate::math::Vec3;
use crate::surface::{Attributes, MAX_INPUTS, Surface, decode_normal, decode_tangent};
use crate::texture::{ColorSource, ScalarSource};

enum BoxedInput<'a, D: Domain> {
    Color(Box<dyn ColorSource<D> + Send + Sync + 'a>),
    Scalar(Box<dyn ScalarSource<D> + Send + Sync + 'a>),
}

/// A material program as boxed nodes.
pub struct BoxedMaterial<'a, D: Domain> {
    attributes: Attributes,
    inputs: Vec<BoxedInput<'a, D>>,
    normal: Option<NormalNode>,
    tangent: Option<TangentNode>,
    interior: Option<u32>,
    disperses: bool,
    filters: bool,
    emission: Option<EmissionNode>,
    bsdf: Box<dyn Bsdf<D> + Send + Sync + 'a>,
}

impl<'a, D: Domain + 'a> BoxedMaterial<'a, D> {
    /// Builds the nodes of a program.
    ///
    /// # Panics
    /// If the program has more than [`MAX_INPUTS`] inputs, which no plan makes.
    pub fn new(program: &Program) -> Self {
        assert!(
            program.inputs.len() <= MAX_INPUTS,
            "a program has at most {MAX_INPUTS} inputs"
        );
        let inputs = program.inputs.iter().map(|input| match &input.source {
            SourceNode::Color(node) => BoxedInput::Color(node.boxed()),
            SourceNode::Scalar(node) => BoxedInput::Scalar(node.boxed()),
        });
        Self {
            attributes: program.attributes,
            inputs: inputs.collect(),
            normal: program.normal,
            tangent: program.tangent,
            interior: program.interior,
            disperses: program.disperses(),
            filters: program.filters(),
            emission: program.emission,
            bsdf: program.bsdf.boxed(),
        }
    }
}

impl<D: Domain> Material<D> for BoxedMaterial<'_, D> {
    #[inline(always)]
    fn attributes(&self) -> Attributes {
        self.attributes
    }

    #[inline(always)]
    fn interior(&self, d: D, surface: &Surface<D>) -> Option<D::U> {
        self.interior.map(|offset| medium(d, surface, offset))
    }

    #[inline(always)]
    fn disperses(&self) -> bool {
        self.disperses
    }

    #[inline(always)]
    fn filters(&self) -> bool {
        self.filters
    }

    #[inline(always)]
    fn shade<'a>(
        &'a self,
        d: D,
        surface: &mut Surface<D>,
        wo: Vec3<D::F>,
    ) -> Shading<D::F, impl Bsdf<D> + 'a>
    where
        D: 'a,
    {
        for (index, input) in self.inputs.iter().enumerate() {
            surface.inputs[index] = match input {
                BoxedInput::Color(source) => source.color(d, surface),
                BoxedInput::Scalar(source) => Vec3::splat(source.scalar(d, surface)),
            };
        }
        if let Some(normal) = self.normal {
            let scale = normal.scale.scalar(d, surface);
            let local = decode_normal(d, normal.texel.color(d, surface), scale);
            *surface = surface.with_normal(d, local, wo);
        }
        if let Some(tangent) = self.tangent {
            let turn = [tangent.cos, tangent.sin].map(|input| input.scalar(d, surface));
            let local = decode_tangent(d, tangent.texel.color(d, surface), turn);
            *surface = surface.with_tangent(d, local);
        }
        let emission = self.emission.map(|emission| {
            let radiance = emission.radiance.color(d, surface);
            if emission.double_sided {
                radiance
            } else {
                front_only(d, surface, radiance)
            }
        });
        Shading {
            emission,
            bsdf: &*self.bsdf,
        }
    }
}
