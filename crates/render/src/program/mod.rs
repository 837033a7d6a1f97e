//! The structure of a scene as data: what the plan decides, emitters print and interpreters build.

mod boxed;
mod interpreted;

pub use boxed::{BoxedAlpha, BoxedMaterial};
pub use interpreted::Interpreted;

use crate::alpha::AlphaTest;
use crate::camera::AnyCamera;
use crate::layer::Layers;
use crate::sampler::AnySampler;
use crate::surface::Attributes;
use crate::texture::{AnyFilter, AnyFormat, AnyWrap, Image, Input};
use crate::tracer::TracerNode;

/// An image source whose kinds are values.
pub type ImageNode = Image<AnyWrap, AnyWrap, AnyFilter, AnyFormat>;

/// A colour source. Each variant is the type of the same name in `texture`.
#[derive(Clone, Debug, PartialEq)]
pub enum ColorNode {
    /// Printed into the program.
    Const([f32; 3]),
    /// A row of the parameter block.
    Param(u32),
    /// The vertex colour.
    VertexColor,
    /// An image.
    Image(ImageNode),
    /// A number as a grey.
    Gray(Box<ScalarNode>),
    /// A product.
    Product(Box<ColorNode>, Box<ColorNode>),
}

/// A scalar source. Each variant is the type of the same name in `texture`.
#[derive(Clone, Debug, PartialEq)]
pub enum ScalarNode {
    /// Printed into the program.
    Const(f32),
    /// A word of the parameter block.
    Param(u32),
    /// The vertex alpha.
    VertexAlpha,
    /// One channel of an image.
    Image(ImageNode),
    /// A product.
    Product(Box<ScalarNode>, Box<ScalarNode>),
}

/// An input of a program, evaluated once per point.
#[derive(Clone, Debug, PartialEq)]
pub struct InputNode {
    /// A name for readers of emitted programs, `snake_case`.
    pub name: &'static str,
    /// Where it comes from.
    pub source: SourceNode,
}

/// A source of either type.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceNode {
    /// A colour.
    Color(ColorNode),
    /// A number.
    Scalar(ScalarNode),
}

/// A BSDF. Each variant is the type of the same name in `bsdf`, each [`Input`] an input of the program.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the fields are those of the types in `bsdf`")]
pub enum BsdfNode {
    Black,
    Diffuse {
        albedo: Input,
    },
    Conductor {
        color: Input,
        roughness: Input,
    },
    Glossy {
        albedo: Input,
        roughness: Input,
        reflectance: Input,
        grazing: Input,
    },
    Dielectric {
        transmittance: Input,
        ior: Input,
        solid: bool,
    },
    Phong {
        color: Input,
        exponent: Input,
    },
    Mix {
        a: Box<BsdfNode>,
        b: Box<BsdfNode>,
        weight: Input,
    },
    Sum {
        a: Box<BsdfNode>,
        b: Box<BsdfNode>,
        probability: Input,
    },
}

/// Emission of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissionNode {
    /// The emitted radiance.
    pub radiance: Input,
    /// Both sides emit.
    pub double_sided: bool,
}

/// A normal map of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NormalNode {
    /// The texel.
    pub texel: Input,
    /// The scale of x and y.
    pub scale: Input,
}

/// Alpha of a program; evaluated by traversal, apart from the other inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct AlphaNode {
    /// Alpha.
    pub alpha: ScalarNode,
    /// What it is compared with.
    pub test: AlphaTest<ScalarNode>,
    /// What the two read.
    pub attributes: Attributes,
}

/// A material program.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// What the inputs read.
    pub attributes: Attributes,
    /// Inputs, evaluated in order.
    pub inputs: Vec<InputNode>,
    /// Replaces the shading normal before the BSDF is used.
    pub normal: Option<NormalNode>,
    /// Emitted light.
    pub emission: Option<EmissionNode>,
    /// Scattering.
    pub bsdf: BsdfNode,
    /// Alpha.
    pub alpha: Option<AlphaNode>,
}

/// A kind of light. Each variant is the type of the same name in `light`.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the fields are those of the types in `light`")]
pub enum LightNode {
    Area {
        emission: ColorNode,
        attributes: Attributes,
    },
    Point,
    Spot,
    Directional,
    Environment,
}

/// The structure of a whole scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Material programs, by number.
    pub programs: Vec<Program>,
    /// Kinds of lights, by number.
    pub lights: Vec<LightNode>,
    /// The camera's kind.
    pub camera: AnyCamera,
    /// The sampler's kind.
    pub sampler: AnySampler,
    /// The tracer's kind.
    pub tracer: TracerNode,
    /// The layers that are filled beside radiance.
    pub layers: Layers,
}
