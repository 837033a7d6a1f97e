//! Kinds of programs, each with constants and with textures.

use std::fmt;

use residual_render::bsdf::AnyInterface;
use residual_render::program::{
    BsdfNode, ColorNode, FresnelNode, ImageNode, InputNode, Program, RoughnessNode, ScalarNode,
    SourceNode,
};
use residual_render::record::BufferRecord;
use residual_render::surface::Attributes;
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap, ColorParam, Image, Input, UvMap};

use super::stream::{COLOR_IMAGES, NUMBER_IMAGE, image_param};

/// How a surface scatters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A diffuse base, and this many Phong lobes added to it (thesis, Figure 3.4).
    Phong(usize),
    /// A diffuse base under a coat.
    Coat,
    /// A rough conductor.
    Metal,
    /// Smooth glass.
    Dielectric,
    /// A metal and a coated base, mixed: glTF's metallic-roughness.
    MetalAndCoat,
}

/// Where a program's colours, roughness and weights come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Inputs {
    /// Its parameters.
    Constants,
    /// Images, bilinear and repeated: colours sRGB, one image each; numbers the channels of a linear one.
    Textures,
}

impl Kind {
    /// All that are measured.
    pub const ALL: [Self; 8] = [
        Self::Phong(0),
        Self::Phong(1),
        Self::Phong(2),
        Self::Phong(3),
        Self::Coat,
        Self::Metal,
        Self::Dielectric,
        Self::MetalAndCoat,
    ];

    /// The program, and its parameters.
    pub fn program(self, inputs: Inputs) -> (Program, Vec<u32>) {
        let mut builder = Builder {
            textured: inputs == Inputs::Textures,
            inputs: Vec::new(),
            params: Vec::new(),
            images: 0,
        };
        let bsdf = builder.bsdf(self);
        let program = Program {
            attributes: Attributes {
                uv0: builder.textured,
                ..Attributes::NONE
            },
            inputs: builder.inputs,
            normal: None,
            tangent: None,
            interior: None,
            emission: None,
            bsdf,
            alpha_test: None,
        };
        (program, builder.params)
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Phong(0) => "diffuse",
            Self::Phong(1) => "diffuse + 1 Phong",
            Self::Phong(2) => "diffuse + 2 Phong",
            Self::Phong(_) => "diffuse + 3 Phong",
            Self::Coat => "dielectric coat",
            Self::Metal => "metal",
            Self::Dielectric => "dielectric",
            Self::MetalAndCoat => "metal and coat",
        })
    }
}

impl fmt::Display for Inputs {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Constants => "constants",
            Self::Textures => "textures",
        })
    }
}

/// Builds one program.
struct Builder {
    textured: bool,
    inputs: Vec<InputNode>,
    params: Vec<u32>,
    /// Colour images in use.
    images: usize,
}

impl Builder {
    fn bsdf(&mut self, kind: Kind) -> BsdfNode {
        match kind {
            Kind::Phong(lobes) => {
                let mut sum = BsdfNode::Diffuse {
                    albedo: self.color("albedo", 0.5),
                };
                for lobe in 0..lobes {
                    sum = self.with_lobe(sum, lobe);
                }
                sum
            }
            Kind::Coat => {
                let albedo = self.color("albedo", 0.7);
                let roughness = self.number("roughness", 0.4, 1);
                self.coat(albedo, roughness)
            }
            Kind::Metal => {
                let color = self.color("albedo", 0.7);
                let roughness = self.number("roughness", 0.4, 1);
                self.metal(color, roughness)
            }
            Kind::Dielectric => BsdfNode::Dielectric {
                transmittance: self.color("transmittance", 0.7),
                ior: self.parameter("ior", 1.5),
                interface: AnyInterface::Solid,
            },
            Kind::MetalAndCoat => {
                let color = self.color("albedo", 0.7);
                let roughness = self.number("roughness", 0.4, 1);
                BsdfNode::Mix {
                    a: Box::new(self.coat(color, roughness)),
                    b: Box::new(self.metal(color, roughness)),
                    weight: self.number("metallic", 0.5, 2),
                }
            }
        }
    }

    fn coat(&mut self, albedo: Input, roughness: Input) -> BsdfNode {
        let reflectance = self.record(gray(0.04));
        let normal = self.input(
            "reflectance",
            SourceNode::Color(ColorNode::Param(reflectance)),
        );
        let grazing = self.parameter("grazing_reflectance", 0.9);
        BsdfNode::Coated {
            coat: Box::new(facets(normal, grazing, roughness)),
            base: Box::new(BsdfNode::Diffuse { albedo }),
        }
    }

    fn metal(&mut self, color: Input, roughness: Input) -> BsdfNode {
        let one = SourceNode::Scalar(ScalarNode::Const(1.0));
        let grazing = self.input("metal_grazing_reflectance", one);
        facets(color, grazing, roughness)
    }

    fn with_lobe(&mut self, base: BsdfNode, lobe: usize) -> BsdfNode {
        const NAMES: [[&str; 3]; 3] = [
            ["specular_1", "exponent_1", "probability_1"],
            ["specular_2", "exponent_2", "probability_2"],
            ["specular_3", "exponent_3", "probability_3"],
        ];
        let [color, exponent, probability] = NAMES[lobe];
        BsdfNode::Sum {
            a: Box::new(base),
            b: Box::new(BsdfNode::Phong {
                color: self.color(color, 0.15),
                exponent: self.parameter(exponent, [10.0, 40.0, 160.0][lobe]),
            }),
            probability: self.parameter(probability, 0.3),
        }
    }

    fn input(&mut self, name: &'static str, source: SourceNode) -> Input {
        self.inputs.push(InputNode { name, source });
        Input(self.inputs.len() - 1)
    }

    fn color(&mut self, name: &'static str, grey: f32) -> Input {
        let node = if self.textured {
            self.images += 1;
            ColorNode::Image(self.image(COLOR_IMAGES[self.images - 1], 0, AnyFormat::SrgbRgba8))
        } else {
            ColorNode::Param(self.record(gray(grey)))
        };
        self.input(name, SourceNode::Color(node))
    }

    fn number(&mut self, name: &'static str, value: f32, channel: u32) -> Input {
        if !self.textured {
            return self.parameter(name, value);
        }
        let image = self.image(NUMBER_IMAGE, channel, AnyFormat::LinearRgba8);
        self.input(name, SourceNode::Scalar(ScalarNode::Image(image)))
    }

    fn parameter(&mut self, name: &'static str, value: f32) -> Input {
        let offset = self.params.len() as u32;
        self.params.push(value.to_bits());
        self.input(name, SourceNode::Scalar(ScalarNode::Param(offset)))
    }

    fn image(&mut self, image: u32, channel: u32, format: AnyFormat) -> ImageNode {
        Image {
            slot: self.record(image_param(image)),
            uv: UvMap {
                set: 0,
                transform: None,
            },
            channel,
            wrap: (AnyWrap::Repeat, AnyWrap::Repeat),
            filter: AnyFilter::Bilinear,
            format,
        }
    }

    /// Adds a parameter; returns its offset.
    fn record(&mut self, record: impl BufferRecord) -> u32 {
        let offset = self.params.len() as u32;
        record.append_to(&mut self.params);
        offset
    }
}

fn facets(normal: Input, grazing: Input, roughness: Input) -> BsdfNode {
    BsdfNode::Glossy {
        fresnel: FresnelNode::Schlick { normal, grazing },
        roughness: RoughnessNode::Isotropic { roughness },
    }
}

fn gray(value: f32) -> ColorParam {
    ColorParam {
        color: [value; 3].into(),
    }
}
