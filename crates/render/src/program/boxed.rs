//! Material programs as boxed nodes, over any domain.

use super::{AlphaNode, BsdfNode, ColorNode, NormalNode, Program, ScalarNode, SourceNode};
use crate::alpha::{AlphaTest, covers};
use crate::bsdf::{
    Black, Bsdf, BsdfKind, BsdfSample, BsdfValue, Conductor, Dielectric, Diffuse, Glossy, Mix,
    Phong, Solid, Sum, Thin,
};
use crate::domain::Domain;
use crate::material::{Material, Shading, decode_normal, front_only};
use crate::math::{Color, Vec3};
use crate::surface::{Attributes, Hit, MAX_INPUTS, Surface};
use crate::texture::{ColorSource, Const, Gray, Param, Product, ScalarSource, VertexColor};

/// A node behind a vtable: entering it re-establishes the domain's instruction set.
struct Node<T>(T);

pub(super) type BoxedColor<'a, D> = Box<dyn ColorSource<D> + Send + Sync + 'a>;
pub(super) type BoxedScalar<'a, D> = Box<dyn ScalarSource<D> + Send + Sync + 'a>;
type BoxedBsdf<'a, D> = Box<dyn Bsdf<D> + Send + Sync + 'a>;

impl<D: Domain, T: ColorSource<D>> ColorSource<D> for Node<T> {
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        d.vectorize(
            #[inline(always)]
            || self.0.color(d, surface),
        )
    }
}
impl<D: Domain, T: ScalarSource<D>> ScalarSource<D> for Node<T> {
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        d.vectorize(
            #[inline(always)]
            || self.0.scalar(d, surface),
        )
    }
}
impl<D: Domain, T: Bsdf<D>> Bsdf<D> for Node<T> {
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        d.vectorize(
            #[inline(always)]
            || self.0.eval(d, surface, wo, wi),
        )
    }
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        d.vectorize(
            #[inline(always)]
            || self.0.sample(d, surface, wo, u),
        )
    }
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        d.vectorize(
            #[inline(always)]
            || self.0.albedo(d, surface, wo),
        )
    }
    fn kind(&self) -> BsdfKind {
        self.0.kind()
    }
}

impl<D: Domain> ColorSource<D> for BoxedColor<'_, D> {
    #[inline(always)]
    fn color(&self, d: D, surface: &Surface<D>) -> Color<D::F> {
        (**self).color(d, surface)
    }
}
impl<D: Domain> ScalarSource<D> for BoxedScalar<'_, D> {
    #[inline(always)]
    fn scalar(&self, d: D, surface: &Surface<D>) -> D::F {
        (**self).scalar(d, surface)
    }
}
impl<D: Domain> Bsdf<D> for BoxedBsdf<'_, D> {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        (**self).eval(d, surface, wo, wi)
    }
    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        (**self).sample(d, surface, wo, u)
    }
    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        (**self).albedo(d, surface, wo)
    }
    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        (**self).kind()
    }
}

pub(super) fn color<'a, D: Domain + 'a>(node: &ColorNode) -> BoxedColor<'a, D> {
    match node {
        ColorNode::Const(value) => Box::new(Node(Const(*value))),
        ColorNode::Param(offset) => Box::new(Node(Param(*offset))),
        ColorNode::VertexColor => Box::new(Node(VertexColor)),
        ColorNode::Image(image) => Box::new(Node(*image)),
        ColorNode::Gray(node) => Box::new(Node(Gray(scalar::<D>(node)))),
        ColorNode::Product(a, b) => Box::new(Node(Product(color::<D>(a), color::<D>(b)))),
    }
}

pub(super) fn scalar<'a, D: Domain + 'a>(node: &ScalarNode) -> BoxedScalar<'a, D> {
    match node {
        ScalarNode::Const(value) => Box::new(Node(Const(*value))),
        ScalarNode::Param(offset) => Box::new(Node(Param(*offset))),
        ScalarNode::VertexAlpha => Box::new(Node(VertexColor)),
        ScalarNode::Image(image) => Box::new(Node(*image)),
        ScalarNode::Product(a, b) => Box::new(Node(Product(scalar::<D>(a), scalar::<D>(b)))),
    }
}

fn bsdf<'a, D: Domain + 'a>(node: &BsdfNode) -> BoxedBsdf<'a, D> {
    match *node {
        BsdfNode::Black => Box::new(Node(Black)),
        BsdfNode::Diffuse { albedo } => Box::new(Node(Diffuse { albedo })),
        BsdfNode::Conductor { color, roughness } => Box::new(Node(Conductor { color, roughness })),
        BsdfNode::Glossy {
            albedo,
            roughness,
            reflectance,
            grazing,
        } => Box::new(Node(Glossy {
            albedo,
            roughness,
            reflectance,
            grazing,
        })),
        BsdfNode::Dielectric {
            transmittance,
            ior,
            solid: true,
        } => Box::new(Node(Dielectric::new(transmittance, ior, Solid))),
        BsdfNode::Dielectric {
            transmittance,
            ior,
            solid: false,
        } => Box::new(Node(Dielectric::new(transmittance, ior, Thin))),
        BsdfNode::Phong { color, exponent } => Box::new(Node(Phong { color, exponent })),
        BsdfNode::Mix {
            ref a,
            ref b,
            weight,
        } => Box::new(Node(Mix {
            a: bsdf::<D>(a),
            b: bsdf::<D>(b),
            weight,
        })),
        BsdfNode::Sum {
            ref a,
            ref b,
            probability,
        } => Box::new(Node(Sum {
            a: bsdf::<D>(a),
            b: bsdf::<D>(b),
            probability,
        })),
    }
}

enum BoxedInput<'a, D: Domain> {
    Color(BoxedColor<'a, D>),
    Scalar(BoxedScalar<'a, D>),
}

/// A material program as boxed nodes.
pub struct BoxedMaterial<'a, D: Domain> {
    attributes: Attributes,
    inputs: Vec<BoxedInput<'a, D>>,
    normal: Option<NormalNode>,
    emission: Option<super::EmissionNode>,
    bsdf: BoxedBsdf<'a, D>,
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
            SourceNode::Color(node) => BoxedInput::Color(color(node)),
            SourceNode::Scalar(node) => BoxedInput::Scalar(scalar(node)),
        });
        Self {
            attributes: program.attributes,
            inputs: inputs.collect(),
            normal: program.normal,
            emission: program.emission,
            bsdf: bsdf(&program.bsdf),
        }
    }
}

impl<D: Domain> Material<D> for BoxedMaterial<'_, D> {
    #[inline(always)]
    fn attributes(&self) -> Attributes {
        self.attributes
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
        for (place, input) in self.inputs.iter().enumerate() {
            surface.inputs[place] = match input {
                BoxedInput::Color(source) => source.color(d, surface),
                BoxedInput::Scalar(source) => Vec3::splat(source.scalar(d, surface)),
            };
        }
        if let Some(normal) = self.normal {
            let scale = normal.scale.scalar(d, surface);
            let local = decode_normal(d, normal.texel.color(d, surface), scale);
            *surface = surface.with_normal(d, local, wo);
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

impl<'a, D: Domain> Bsdf<D> for &'a (dyn Bsdf<D> + Send + Sync + 'a) {
    #[inline(always)]
    fn eval(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, wi: Vec3<D::F>) -> BsdfValue<D> {
        (**self).eval(d, surface, wo, wi)
    }
    #[inline(always)]
    fn sample(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>, u: [D::F; 3]) -> BsdfSample<D> {
        (**self).sample(d, surface, wo, u)
    }
    #[inline(always)]
    fn albedo(&self, d: D, surface: &Surface<D>, wo: Vec3<D::F>) -> Color<D::F> {
        (**self).albedo(d, surface, wo)
    }
    #[inline(always)]
    fn kind(&self) -> BsdfKind {
        (**self).kind()
    }
}

/// The alpha of a material program as boxed nodes.
pub struct BoxedAlpha<'a, D> {
    pub(super) attributes: Attributes,
    pub(super) alpha: BoxedScalar<'a, D>,
    pub(super) test: AlphaTest<BoxedScalar<'a, D>>,
}

impl<'a, D: Domain + 'a> BoxedAlpha<'a, D> {
    /// Builds the nodes of a program's alpha.
    pub fn new(node: &AlphaNode) -> Self {
        Self {
            attributes: node.attributes,
            alpha: scalar(&node.alpha),
            test: match &node.test {
                AlphaTest::Mask(cutoff) => AlphaTest::Mask(scalar(cutoff)),
                AlphaTest::Blend => AlphaTest::Blend,
            },
        }
    }

    /// Whether the surface is there for this hit of a ray, given by origin and direction.
    pub fn covers(&self, d: D, ray: [Vec3<D::F>; 2], hit: &Hit<D>) -> D::M {
        covers(d, self.attributes, &self.alpha, &self.test, ray, hit)
    }
}
