//! The node table: every BSDF, source, light, camera and alpha test that a scene can be made of.
//!
//! To add one, write its type in the module of its kind, and its row here. Emission, the interpreted renderer and the
//! walks over a program follow from the row; what it means is said by a line in scenegen's `effects`, and by the plan where
//! a file calls for it.

use super::boxed::{Boxing, Entered};
use super::table::{form, nodes, value};
use crate::alpha::AlphaTest;
use crate::bsdf::{AnyInterface, Bsdf, Fresnel, LayerFrame, Roughness};
use crate::camera::Camera;
use crate::domain::Domain;
use crate::light::LightKind;
use crate::surface::Attributes;
use crate::texture::{
    AnyFilter, AnyFormat, AnyWrap, ColorSource, Image, Input, ScalarSource, UvMap,
};

nodes! {
    /// A BSDF.
    BsdfNode: Bsdf in bsdf {
        Black,
        Diffuse { albedo: Input },
        RoughDiffuse { albedo: Input, roughness: Input },
        DiffuseTransmission { color: Input },
        Glossy { fresnel: FresnelNode, roughness: RoughnessNode },
        Sheen { color: Input, roughness: Input },
        OwnNormal { bsdf: Box<BsdfNode>, normal: LayerFrameNode },
        Coated { coat: Box<BsdfNode>, base: Box<BsdfNode> },
        Dielectric { transmittance: Input, ior: Input, interface: AnyInterface },
        RoughDielectric {
            transmittance: Input,
            ior: Input,
            roughness: RoughnessNode,
            interface: AnyInterface,
            albedos: u32,
        },
        RoughSheet { transmittance: Input, ior: Input, roughness: RoughnessNode },
        Phong { color: Input, exponent: Input },
        Mirror { reflectance: Input },
        Mix { a: Box<BsdfNode>, b: Box<BsdfNode>, weight: Input },
        Sum { a: Box<BsdfNode>, b: Box<BsdfNode>, probability: Input },
    }

    /// How much facets reflect.
    FresnelNode: Fresnel in bsdf {
        Schlick { normal: Input, grazing: Input },
        ThinFilm { normal: Input, grazing: Input, strength: Input, ior: Input, thickness: Input },
    }

    /// How facets are turned.
    RoughnessNode: Roughness in bsdf {
        Isotropic { roughness: Input },
        Anisotropic { roughness: Input, anisotropy: Input },
    }

    /// The shading frame of a layer.
    LayerFrameNode: LayerFrame in bsdf {
        MeshFrame,
        MappedFrame { texel: Input, scale: Input },
    }

    /// A source of colours.
    ColorNode: ColorSource in texture {
        Const(value: [f32; 3]),
        Param(offset: u32),
        VertexColor,
        Image = image: ImageNode,
        Gray(number: Box<ScalarNode>),
        Product(a: Box<ColorNode>, b: Box<ColorNode>),
        UnderCoat { color: Box<ColorNode>, normal: Box<ScalarNode>, grazing: Box<ScalarNode> },
        Checkerboard { even: Box<ColorNode>, odd: Box<ColorNode>, uv: UvMap },
    }

    /// A source of numbers.
    ScalarNode: ScalarSource in texture {
        Const(value: f32),
        Param(offset: u32),
        VertexColor,
        Image = image: ImageNode,
        Product(a: Box<ScalarNode>, b: Box<ScalarNode>),
        AtLeast(a: Box<ScalarNode>, b: Box<ScalarNode>),
        Dispersive { ior: Box<ScalarNode>, dispersion: Box<ScalarNode> },
        Between { low: Box<ScalarNode>, high: Box<ScalarNode>, at: Box<ScalarNode> },
    }

    /// A kind of light.
    LightNode: LightKind in light {
        Area { emission: ColorNode, attributes: Attributes },
        AreaBySolidAngle { emission: ColorNode, attributes: Attributes },
        Point,
        Spot,
        Directional,
        SphericalPoint,
        SphericalSpot,
        Sun,
        Environment,
    }

    /// A kind of camera.
    CameraNode: Camera in camera {
        Perspective,
        ThinLens,
        Orthographic,
        Panorama,
    }

    /// A test of alpha; traversal makes it, apart from the other inputs.
    AlphaTestNode: AlphaTest in alpha {
        AlphaMask { alpha: ScalarNode, cutoff: ScalarNode, attributes: Attributes },
        AlphaBlend { alpha: ScalarNode, attributes: Attributes },
    }
}

/// An image whose kinds are chosen at run time.
pub type ImageNode = Image<AnyWrap, AnyWrap, AnyFilter, AnyFormat>;

/// A node as it is written: a type with its fields.
#[derive(Clone, Debug)]
pub struct Literal<'a> {
    /// The module of this crate that has the type.
    pub module: &'static str,
    /// The type's name.
    pub name: &'static str,
    /// How its fields are written.
    pub form: Form,
    /// The fields with their names, in order.
    pub fields: Vec<(&'static str, Field<'a>)>,
}

/// How the fields of a node are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// There are none.
    Unit,
    /// By their places: `Param(4)`.
    Tuple,
    /// By their names: `Diffuse { albedo }`.
    Struct,
    /// The only field is the node itself.
    Value,
}

/// A field of a node.
///
/// The node's type has a parameter for each field that holds an input, a node, a kind or a constant, in their order.
/// Offsets, coordinates and attributes have types of their own.
#[derive(Clone, Copy, Debug)]
pub enum Field<'a> {
    /// An input of the program.
    Input(Input),
    /// A BSDF within.
    Bsdf(&'a BsdfNode),
    /// How much its facets reflect.
    Fresnel(&'a FresnelNode),
    /// How its facets are turned.
    Roughness(&'a RoughnessNode),
    /// Its shading frame.
    LayerFrame(&'a LayerFrameNode),
    /// A source of colours within.
    ColorSource(&'a ColorNode),
    /// A source of numbers within.
    ScalarSource(&'a ScalarNode),
    /// An image.
    Image(&'a ImageNode),
    /// What lies behind a surface.
    Interface(AnyInterface),
    /// A constant number.
    Number(f32),
    /// A constant colour.
    Color([f32; 3]),
    /// A word's offset in the parameter block.
    Offset(u32),
    /// Texture coordinates.
    Coordinates(UvMap),
    /// What is read of vertices.
    Attributes(Attributes),
}

/// What rows of the table hold.
trait AsField {
    fn field(&self) -> Field<'_>;
}

macro_rules! fields {
    ($($Type:ty => $Field:ident $(($copy:tt))?),* $(,)?) => {$(
        impl AsField for $Type {
            fn field(&self) -> Field<'_> {
                Field::$Field($($copy)? self)
            }
        }
    )*};
}
fields! {
    Input => Input(*),
    BsdfNode => Bsdf,
    FresnelNode => Fresnel,
    RoughnessNode => Roughness,
    LayerFrameNode => LayerFrame,
    ColorNode => ColorSource,
    ScalarNode => ScalarSource,
    ImageNode => Image,
    AnyInterface => Interface(*),
    f32 => Number(*),
    [f32; 3] => Color(*),
    u32 => Offset(*),
    UvMap => Coordinates(*),
    Attributes => Attributes(*),
}

impl<N: AsField> AsField for Box<N> {
    fn field(&self) -> Field<'_> {
        (**self).field()
    }
}
