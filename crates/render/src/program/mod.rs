//! The structure of a scene as data: what the plan decides, emitters print and interpreters build.

mod any_camera;
mod boxed;
mod interpreted;
mod lights;
mod material;
mod nodes;
mod table;
mod walk;

pub use any_camera::AnyCamera;
pub use interpreted::Interpreted;
pub use lights::BoxedLights;
pub use material::BoxedMaterial;
pub use nodes::{
    AlphaTestNode, BsdfNode, CameraNode, ColorNode, Field, Form, FresnelNode, ImageNode,
    LayerFrameNode, LightNode, Literal, RoughnessNode, ScalarNode,
};
pub use walk::{Leaf, Source};

use crate::layer::Layers;
use crate::light::LightTree;
use crate::sampler::AnySampler;
use crate::surface::Attributes;
use crate::texture::Input;
use crate::tracer::{Between, TracerNode};

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

/// The direction along which a program's surface is brushed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TangentNode {
    /// The texel: the direction in its red and green.
    pub texel: Input,
    /// Cosine of the angle by which it is turned.
    pub cos: Input,
    /// Sine of that angle.
    pub sin: Input,
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
    /// Replaces the tangent, after the normal.
    pub tangent: Option<TangentNode>,
    /// The word of the parameter block with the index of the medium behind the surface, if it is the surface of a body and
    /// the scene has media.
    pub interior: Option<u32>,
    /// Emitted light.
    pub emission: Option<EmissionNode>,
    /// Scattering.
    pub bsdf: BsdfNode,
    /// Whether the surface is there at all.
    pub alpha_test: Option<AlphaTestNode>,
}

/// The structure of a whole scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    /// Material programs, by index.
    pub programs: Vec<Program>,
    /// Kinds of lights, by index.
    pub lights: Vec<LightNode>,
    /// The tree from which lights are picked; from the table, if there is none.
    pub light_tree: Option<LightTree>,
    /// The camera's kind.
    pub camera: CameraNode,
    /// The sampler's kind.
    pub sampler: AnySampler,
    /// The tracer's kind.
    pub tracer: TracerNode,
    /// What its paths meet beside surfaces.
    pub between: Between,
    /// The layers that are filled beside radiance.
    pub layers: Layers,
}
