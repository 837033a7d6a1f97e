//! A material's program: its inputs, each once, and what they are for.

use residual_render::program::{
    ColorNode, EmissionNode, InputNode, NormalNode, Program, ScalarNode, SourceNode,
};
use residual_render::surface::Attributes;
use residual_render::texture::Input;
use residual_render::tracer::AnyNesting;

use super::opacity::Opacity;
use super::rough_dielectrics::RoughDielectrics;
use super::sources::Sources;
use crate::desc::{MaterialDesc, NormalMap, SurfaceDesc};
use crate::effect::Effect;

/// Builds the program of one material.
pub(super) struct Builder<'a> {
    pub(super) sources: Sources<'a>,
    pub(super) inputs: Vec<InputNode>,
    /// The material's surfaces are closed.
    pub(super) encloses: bool,
    /// How bodies lie to each other.
    pub(super) nesting: AnyNesting,
    pub(super) rough_dielectrics: &'a mut RoughDielectrics,
}

impl Builder<'_> {
    /// The program; its surface reads the normals of vertices if they are `available`.
    pub(super) fn program(
        &mut self,
        desc: &MaterialDesc,
        available: Attributes,
        opacity: Opacity,
    ) -> Program {
        let normal_map = desc.normal_map.as_ref().filter(|_| available.tangents);
        let normal = normal_map.and_then(|map| self.normal(map));
        let is_anisotropic = self.is_anisotropic(&desc.surface);
        let tangent = match is_anisotropic {
            true => self.tangent(&desc.surface),
            false => None,
        };
        let bsdf = self.bsdf(&desc.surface, normal_map);
        let emission = self.emission(desc);
        let inputs = std::mem::take(&mut self.inputs);
        let read = inputs.iter().map(|input| self.sources.read(&input.source));
        let mut attributes = read.fold(Attributes::NONE, Attributes::union);
        attributes.normals |= available.normals;
        attributes.tangents |= normal.is_some() || is_anisotropic || bsdf.reads_tangents();
        let alpha_test = match opacity {
            Opacity::Opaque | Opacity::Transparent => None,
            Opacity::Tested => self.alpha_test(desc),
        };
        Program {
            attributes,
            inputs,
            normal,
            tangent,
            interior: None,
            emission,
            bsdf,
            alpha_test,
        }
    }

    fn normal(&mut self, map: &NormalMap) -> Option<NormalNode> {
        if map.scale == 0.0 || self.sources.is_flat(&map.texture) {
            self.sources
                .dismiss(Effect::NormalMaps, "its normal map bends no normal");
            return None;
        }
        let texel = self.sources.normal_texel(&map.texture);
        let scale = self.sources.number(map.scale);
        Some(NormalNode {
            texel: self.color("normal_texel", texel),
            scale: self.scalar("normal_scale", scale),
        })
    }

    fn emission(&mut self, desc: &MaterialDesc) -> Option<EmissionNode> {
        let emission = match &desc.surface {
            SurfaceDesc::Unlit => self.sources.tinted_color(&desc.emission),
            _ => self.sources.full_color(&desc.emission),
        };
        if is_black(&emission) {
            if desc.emission.factor != [0.0; 3] {
                self.sources
                    .dismiss(Effect::EmittingSurfaces, "its emissive texture is black");
            }
            return None;
        }
        let emission = self.emission_under_clearcoat(&desc.surface, emission);
        Some(EmissionNode {
            radiance: self.color("emission", emission),
            double_sided: desc.double_sided,
        })
    }

    fn input(&mut self, name: &'static str, source: SourceNode) -> Input {
        let node = InputNode { name, source };
        // The same source under the same name is the same input.
        let found = self.inputs.iter().position(|other| *other == node);
        Input(found.unwrap_or_else(|| {
            self.inputs.push(node);
            self.inputs.len() - 1
        }))
    }

    /// An input that is a colour.
    pub(super) fn color(&mut self, name: &'static str, node: ColorNode) -> Input {
        self.input(name, SourceNode::Color(node))
    }

    /// An input that is a number.
    pub(super) fn scalar(&mut self, name: &'static str, node: ScalarNode) -> Input {
        self.input(name, SourceNode::Scalar(node))
    }
}

/// Known to be black everywhere.
pub(super) fn is_black(node: &ColorNode) -> bool {
    *node == ColorNode::Const([0.0; 3])
}
