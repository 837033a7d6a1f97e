//! Walks over nodes: what a tree of them is made of, and what it reads.

use super::nodes::{
    AlphaTestNode, BsdfNode, ColorNode, Field, ImageNode, LayerFrameNode, LightNode, Literal,
    ScalarNode,
};
use super::{Program, SourceNode};
use crate::surface::Attributes;
use crate::texture::{AnyFilter, UvMap};

/// Where the numbers of a source come from in the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Leaf<'a> {
    /// The program.
    Constant,
    /// The material's parameter block.
    Parameter,
    /// The vertices' colours and alpha.
    VertexColor,
    /// An image.
    Image(&'a ImageNode),
    /// Texture coordinates themselves.
    Coordinates(UvMap),
}

impl Leaf<'_> {
    /// The vertex attributes that are read for it.
    pub fn attributes(self) -> Attributes {
        match self {
            Self::Constant | Self::Parameter => Attributes::NONE,
            Self::VertexColor => Attributes {
                colors: true,
                ..Attributes::NONE
            },
            Self::Image(image) => Self::Coordinates(image.uv).attributes(),
            Self::Coordinates(uv) => Attributes {
                uv0: uv.set == 0,
                uv1: uv.set == 1,
                ..Attributes::NONE
            },
        }
    }
}

/// A node that is made of sources.
pub trait Source {
    /// Where its numbers come from, in the order of its fields.
    fn leaves(&self) -> Vec<Leaf<'_>>;

    /// The vertex attributes that it reads.
    fn attributes(&self) -> Attributes {
        let leaves = self.leaves().into_iter().map(Leaf::attributes);
        leaves.fold(Attributes::NONE, Attributes::union)
    }
}

fn leaves(literal: Literal<'_>) -> Vec<Leaf<'_>> {
    let fields = literal.fields.into_iter().map(|(_, field)| field);
    let leaves = fields.map(|field| match field {
        Field::ColorSource(node) => node.leaves(),
        Field::ScalarSource(node) => node.leaves(),
        Field::Number(_) | Field::Color(_) => vec![Leaf::Constant],
        Field::Offset(_) => vec![Leaf::Parameter],
        Field::Image(image) => vec![Leaf::Image(image)],
        Field::Coordinates(uv) => vec![Leaf::Coordinates(uv)],
        Field::Input(_)
        | Field::Bsdf(_)
        | Field::Fresnel(_)
        | Field::Roughness(_)
        | Field::LayerFrame(_)
        | Field::Interface(_)
        | Field::Attributes(_) => Vec::new(),
    });
    leaves.flatten().collect()
}

impl Source for ColorNode {
    fn leaves(&self) -> Vec<Leaf<'_>> {
        match self {
            Self::VertexColor => vec![Leaf::VertexColor],
            node => leaves(node.literal()),
        }
    }
}

impl Source for ScalarNode {
    fn leaves(&self) -> Vec<Leaf<'_>> {
        match self {
            Self::VertexColor => vec![Leaf::VertexColor],
            node => leaves(node.literal()),
        }
    }
}

impl Source for SourceNode {
    fn leaves(&self) -> Vec<Leaf<'_>> {
        match self {
            Self::Color(node) => node.leaves(),
            Self::Scalar(node) => node.leaves(),
        }
    }
}

impl Source for LightNode {
    fn leaves(&self) -> Vec<Leaf<'_>> {
        leaves(self.literal())
    }
}

impl Source for AlphaTestNode {
    fn leaves(&self) -> Vec<Leaf<'_>> {
        leaves(self.literal())
    }
}

/// The inputs of a program, then its alpha test.
impl Source for Program {
    fn leaves(&self) -> Vec<Leaf<'_>> {
        let inputs = self.inputs.iter().flat_map(|input| input.source.leaves());
        let alpha_test = self.alpha_test.iter().flat_map(Source::leaves);
        inputs.chain(alpha_test).collect()
    }
}

impl Program {
    /// Whether the surface bends wavelengths differently.
    pub fn disperses(&self) -> bool {
        let sources = self.inputs.iter().map(|input| &input.source);
        let disperses = |source: &SourceNode| {
            matches!(source, SourceNode::Scalar(ScalarNode::Dispersive { .. }))
        };
        sources.into_iter().any(disperses)
    }

    /// Whether textures are filtered over what a ray stands for.
    pub fn filters(&self) -> bool {
        let leaves = self.leaves();
        let is_filtered =
            |leaf| matches!(leaf, Leaf::Image(image) if image.filter == AnyFilter::Trilinear);
        leaves.into_iter().any(is_filtered)
    }
}

impl BsdfNode {
    /// The BSDFs that it combines.
    pub fn children(&self) -> impl Iterator<Item = &Self> {
        let fields = self.literal().fields.into_iter();
        fields.filter_map(|(_, field)| match field {
            Field::Bsdf(node) => Some(node),
            _ => None,
        })
    }

    /// Whether some layer's normals are those of a map.
    pub fn reads_tangents(&self) -> bool {
        let is_mapped = matches!(
            self,
            Self::OwnNormal {
                normal: LayerFrameNode::MappedFrame { .. },
                ..
            }
        );
        is_mapped || self.children().any(Self::reads_tangents)
    }

    /// Whether some light passes through the surface.
    pub fn transmits(&self) -> bool {
        matches!(
            self,
            Self::Dielectric { .. }
                | Self::RoughDielectric { .. }
                | Self::RoughSheet { .. }
                | Self::DiffuseTransmission { .. }
        ) || self.children().any(Self::transmits)
    }
}

impl AlphaTestNode {
    /// How much of the surface is there, from 0 to 1.
    pub fn coverage(&self) -> ScalarNode {
        match self {
            Self::AlphaMask { alpha, cutoff, .. } => {
                ScalarNode::AtLeast(Box::new(alpha.clone()), Box::new(cutoff.clone()))
            }
            Self::AlphaBlend { alpha, .. } => alpha.clone(),
        }
    }

    /// The vertex attributes that it is given.
    pub fn given_attributes(&self) -> Attributes {
        let fields = self.literal().fields.into_iter();
        let attributes = fields.filter_map(|(_, field)| match field {
            Field::Attributes(attributes) => Some(attributes),
            _ => None,
        });
        attributes.fold(Attributes::NONE, Attributes::union)
    }
}
