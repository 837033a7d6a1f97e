//! Structures to print, between them all that can be printed.

use residual_render::bsdf::AnyInterface;
use residual_render::layer::Layers;
use residual_render::program::{
    AlphaTestNode, BsdfNode, CameraNode, ColorNode, EmissionNode, FresnelNode, ImageNode,
    InputNode, LayerFrameNode, LightNode, NormalNode, Program, RoughnessNode, ScalarNode,
    SourceNode, Structure,
};
use residual_render::sampler::AnySampler;
use residual_render::surface::Attributes;
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap, Input, UvMap};
use residual_render::tracer::{Between, TracerNode};

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

pub(crate) fn program(bsdf: BsdfNode) -> Program {
    Program {
        attributes: Attributes::default(),
        inputs: vec![
            color("first", ColorNode::Param(0)),
            color("second", ColorNode::Param(3)),
            scalar("third", ScalarNode::Param(6)),
            scalar("fourth", ScalarNode::Param(7)),
        ],
        normal: None,
        tangent: None,
        interior: None,
        emission: None,
        bsdf,
        alpha_test: None,
    }
}

pub(crate) fn structure(programs: Vec<Program>, lights: Vec<LightNode>) -> Structure {
    Structure {
        programs,
        lights,
        light_tree: None,
        camera: CameraNode::Perspective,
        sampler: AnySampler::Sobol,
        tracer: TracerNode::default(),
        between: Between::default(),
        layers: Layers::NONE,
    }
}

pub(crate) fn bsdfs() -> Vec<BsdfNode> {
    let [first, second, third, fourth] = [0, 1, 2, 3].map(Input);
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
        albedos: 8,
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
        exponent: third,
    };
    let (a, b) = (
        Box::new(coated.clone()),
        Box::new(glass(AnyInterface::Thin)),
    );
    vec![
        BsdfNode::Black,
        diffuse.clone(),
        clay,
        conductor.clone(),
        coated.clone(),
        coat(&own(LayerFrameNode::MeshFrame), &conductor),
        coat(&own(mapped), &conductor),
        brushed,
        coat(&sheen, &coated),
        paper,
        frosted(AnyInterface::Solid),
        frosted(AnyInterface::SolidAmongSolids),
        glass(AnyInterface::SolidAmongSolids),
        frosted_sheet,
        glass(AnyInterface::Solid),
        glass(AnyInterface::Thin),
        phong.clone(),
        BsdfNode::Mirror {
            reflectance: second,
        },
        BsdfNode::Mix {
            a,
            b,
            weight: third,
        },
        BsdfNode::Mix {
            a: Box::new(glass(AnyInterface::Solid)),
            b: Box::new(conductor),
            weight: third,
        },
        BsdfNode::Sum {
            a: Box::new(diffuse),
            b: Box::new(phong),
            probability: third,
        },
    ]
}

pub(crate) fn images() -> Vec<ImageNode> {
    let mut images = vec![];
    for (k, format) in [
        AnyFormat::SrgbRgba8,
        AnyFormat::LinearRgba8,
        AnyFormat::LinearHalf,
        AnyFormat::LinearFloat,
    ]
    .into_iter()
    .enumerate()
    {
        for filter in [
            AnyFilter::Nearest,
            AnyFilter::Bilinear,
            AnyFilter::Trilinear,
        ] {
            for u in [AnyWrap::Repeat, AnyWrap::MirroredRepeat, AnyWrap::Clamp] {
                for v in [AnyWrap::Repeat, AnyWrap::FlatBorder, AnyWrap::Clamp] {
                    let uv = UvMap {
                        set: k % 2,
                        transform: (k > 0).then_some(20),
                    };
                    images.push(ImageNode {
                        slot: 8,
                        uv,
                        channel: k as u32,
                        wrap: (u, v),
                        filter,
                        format,
                    });
                }
            }
        }
    }
    images
}

/// A scene with everything in it.
pub(crate) fn everything() -> Structure {
    let all = Attributes {
        normals: true,
        tangents: true,
        uv0: true,
        uv1: true,
        colors: true,
    };
    let mut programs: Vec<Program> = bsdfs().into_iter().map(program).collect();
    let image = images()[10];
    let last = programs.last_mut().unwrap();
    last.attributes = all;
    last.inputs[0] = color(
        "albedo",
        ColorNode::Product(
            Box::new(ColorNode::Image(image)),
            Box::new(ColorNode::Checkerboard {
                even: Box::new(ColorNode::Param(0)),
                odd: Box::new(ColorNode::VertexColor),
                uv: UvMap {
                    set: 0,
                    transform: Some(12),
                },
            }),
        ),
    );
    last.inputs[1] = color("normal", ColorNode::Image(images()[30]));
    last.normal = Some(NormalNode {
        texel: Input(1),
        scale: Input(3),
    });
    last.emission = Some(EmissionNode {
        radiance: Input(0),
        double_sided: false,
    });
    last.alpha_test = Some(AlphaTestNode::AlphaBlend {
        alpha: ScalarNode::Product(
            Box::new(ScalarNode::Image(image)),
            Box::new(ScalarNode::VertexColor),
        ),
        attributes: all,
    });
    programs[1].emission = Some(EmissionNode {
        radiance: Input(1),
        double_sided: true,
    });
    programs[1].alpha_test = Some(AlphaTestNode::AlphaMask {
        alpha: ScalarNode::Param(3),
        cutoff: ScalarNode::Const(0.5),
        attributes: Attributes::default(),
    });
    structure(programs, lights())
}

pub(crate) fn lights() -> Vec<LightNode> {
    let area = |emission, attributes| LightNode::Area {
        emission,
        attributes,
    };
    let uv0 = Attributes {
        uv0: true,
        ..Attributes::default()
    };
    vec![
        area(ColorNode::Param(0), Attributes::default()),
        LightNode::AreaBySolidAngle {
            emission: ColorNode::Image(images()[0]),
            attributes: uv0,
        },
        area(ColorNode::Image(images()[0]), uv0),
        area(
            ColorNode::UnderCoat {
                color: Box::new(ColorNode::Param(0)),
                normal: Box::new(ScalarNode::Const(0.04)),
                grazing: Box::new(ScalarNode::Param(3)),
            },
            Attributes::default(),
        ),
        area(
            ColorNode::Gray(Box::new(ScalarNode::AtLeast(
                Box::new(ScalarNode::Image(images()[0])),
                Box::new(ScalarNode::Param(3)),
            ))),
            uv0,
        ),
        LightNode::Point,
        LightNode::Spot,
        LightNode::Directional,
        LightNode::SphericalPoint,
        LightNode::SphericalSpot,
        LightNode::Sun,
        LightNode::Environment,
    ]
}
