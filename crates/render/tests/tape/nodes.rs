//! Programs and lights to record, and where they are asked.

use residual_render::bsdf::AnyInterface;
use residual_render::layer::Layers;
use residual_render::program::{
    BsdfNode, CameraNode, ColorNode, FresnelNode, ImageNode, InputNode, LayerFrameNode, LightNode,
    Program, RoughnessNode, ScalarNode, SourceNode, Structure,
};
use residual_render::sampler::AnySampler;
use residual_render::surface::Attributes;
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap, Input, UvMap};
use residual_render::tracer::{Between, TracerNode};

use crate::common::{ALBEDOS, IMAGE, Random, TRANSFORM, TRIANGLES};

pub(crate) fn hit_arguments(random: &mut Random) -> (Vec<f32>, Vec<u32>) {
    let (u, v) = (random.unit(), random.unit());
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    let mut reals = vec![u, v];
    reals.extend(random.direction());
    (reals, vec![random.word() % TRIANGLES])
}

pub(crate) fn color(name: &'static str, node: ColorNode) -> InputNode {
    InputNode {
        name,
        source: SourceNode::Color(node),
    }
}

pub(crate) fn scalar(name: &'static str, node: ScalarNode) -> InputNode {
    InputNode {
        name,
        source: SourceNode::Scalar(node),
    }
}

pub(crate) fn program(bsdf: BsdfNode, inputs: Vec<InputNode>) -> Program {
    Program {
        attributes: Attributes::default(),
        inputs,
        normal: None,
        tangent: None,
        interior: None,
        emission: None,
        bsdf,
        alpha_test: None,
    }
}

/// Inputs 0 and 1 are colours, 2, 3 and 4 numbers.
pub(crate) fn inputs(constant: bool) -> Vec<InputNode> {
    let (c, s): (fn(u32) -> ColorNode, fn(u32) -> ScalarNode) = if constant {
        (
            |k| ColorNode::Const([0.25, 0.5, 0.125 * (k + 1) as f32]),
            |k| ScalarNode::Const(0.3 + 0.1 * k as f32),
        )
    } else {
        (ColorNode::Param, ScalarNode::Param)
    };
    vec![
        color("first", c(0)),
        color("second", c(3)),
        scalar("third", s(6)),
        scalar("fourth", s(7)),
        scalar("fifth", s(8)),
    ]
}

/// Every BSDF, and combinations of them.
pub(crate) fn bsdfs() -> Vec<BsdfNode> {
    let [first, second, third, fourth, fifth] = [0, 1, 2, 3, 4].map(Input);
    let diffuse = BsdfNode::Diffuse { albedo: first };
    let clay = BsdfNode::RoughDiffuse {
        albedo: first,
        roughness: third,
    };
    let isotropic = RoughnessNode::Isotropic { roughness: third };
    let schlick = FresnelNode::Schlick {
        normal: second,
        grazing: fourth,
    };
    let conductor = BsdfNode::Glossy {
        fresnel: schlick.clone(),
        roughness: isotropic.clone(),
    };
    let brushed = BsdfNode::Glossy {
        fresnel: FresnelNode::ThinFilm {
            normal: second,
            grazing: fourth,
            strength: third,
            ior: fourth,
            thickness: third,
        },
        roughness: RoughnessNode::Anisotropic {
            roughness: third,
            anisotropy: fourth,
        },
    };
    let coat = |coat: &BsdfNode, base: &BsdfNode| BsdfNode::Coated {
        coat: Box::new(coat.clone()),
        base: Box::new(base.clone()),
    };
    let coated = coat(&conductor, &diffuse);
    let own = |normal| BsdfNode::OwnNormal {
        bsdf: Box::new(conductor.clone()),
        normal,
    };
    let mapped = LayerFrameNode::MappedFrame {
        texel: first,
        scale: fourth,
    };
    let sheen = BsdfNode::Sheen {
        color: second,
        roughness: third,
    };
    let paper = BsdfNode::DiffuseTransmission { color: second };
    let frosted = |interface| BsdfNode::RoughDielectric {
        transmittance: first,
        ior: fourth,
        roughness: isotropic.clone(),
        interface,
        albedos: ALBEDOS,
    };
    let frosted_sheet = BsdfNode::RoughSheet {
        transmittance: first,
        ior: fourth,
        roughness: isotropic.clone(),
    };
    let glass = |interface| BsdfNode::Dielectric {
        transmittance: first,
        ior: fourth,
        interface,
    };
    let phong = BsdfNode::Phong {
        color: second,
        exponent: fifth,
    };
    let mirror = BsdfNode::Mirror {
        reflectance: second,
    };
    let mix = |a: &BsdfNode, b: &BsdfNode| BsdfNode::Mix {
        a: Box::new(a.clone()),
        b: Box::new(b.clone()),
        weight: third,
    };
    let sum = |a: &BsdfNode, b: &BsdfNode| BsdfNode::Sum {
        a: Box::new(a.clone()),
        b: Box::new(b.clone()),
        probability: fourth,
    };
    vec![
        BsdfNode::Black,
        diffuse.clone(),
        clay,
        conductor.clone(),
        coated.clone(),
        glass(AnyInterface::Solid),
        glass(AnyInterface::Thin),
        phong.clone(),
        mirror.clone(),
        coat(&own(LayerFrameNode::MeshFrame), &conductor),
        coat(&own(mapped), &conductor),
        brushed,
        sheen.clone(),
        paper.clone(),
        coat(&sheen, &coated),
        coat(&conductor, &mix(&diffuse, &paper)),
        frosted(AnyInterface::Solid),
        frosted(AnyInterface::SolidAmongSolids),
        glass(AnyInterface::SolidAmongSolids),
        frosted_sheet,
        sum(&diffuse, &mirror),
        mix(&coated, &conductor),
        mix(&coated, &glass(AnyInterface::Thin)),
        mix(&glass(AnyInterface::Solid), &glass(AnyInterface::Thin)),
        sum(&diffuse, &phong),
        mix(
            &sum(&diffuse, &phong),
            &mix(&glass(AnyInterface::Solid), &coated),
        ),
    ]
}

/// Image number `k` of all combinations of wrapping, filter, format, coordinates and transform.
pub(crate) fn image(k: usize) -> ImageNode {
    let wraps = [AnyWrap::Repeat, AnyWrap::WhiteBorder, AnyWrap::Clamp];
    let filters = [
        AnyFilter::Nearest,
        AnyFilter::Bilinear,
        AnyFilter::Trilinear,
    ];
    let formats = [
        AnyFormat::SrgbRgba8,
        AnyFormat::LinearRgba8,
        AnyFormat::LinearHalf,
        AnyFormat::LinearFloat,
    ];
    ImageNode {
        slot: IMAGE,
        uv: UvMap {
            set: k % 2,
            transform: k.is_multiple_of(3).then_some(TRANSFORM),
        },
        channel: (k % 4) as u32,
        wrap: (wraps[k % 3], wraps[k / 3 % 3]),
        filter: filters[k / 9 % 3],
        format: formats[k / 27 % 4],
    }
}

pub(crate) fn structure(lights: Vec<LightNode>) -> Structure {
    Structure {
        programs: vec![],
        lights,
        light_tree: None,
        camera: CameraNode::Perspective,
        sampler: AnySampler::Sobol,
        tracer: TracerNode::default(),
        between: Between::default(),
        layers: Layers::NONE,
    }
}

pub(crate) fn light_kinds() -> Vec<LightNode> {
    let attributes = Attributes {
        uv0: true,
        uv1: true,
        ..Attributes::default()
    };
    vec![
        LightNode::Area {
            emission: ColorNode::Image(image(9)),
            attributes,
        },
        LightNode::AreaBySolidAngle {
            emission: ColorNode::Image(image(9)),
            attributes,
        },
        LightNode::Point,
        LightNode::Spot,
        LightNode::Directional,
        LightNode::SphericalPoint,
        LightNode::SphericalSpot,
        LightNode::Sun,
        LightNode::Environment,
    ]
}
