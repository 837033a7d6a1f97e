//! Printed WGSL: naga accepts it, nothing in it is dead, and it is the same every time.

use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use residual_render::bsdf::AnyInterface;
use residual_render::domain::tape::{Outputs, Record, Tape};
use residual_render::domain::{Buffer, Domain};
use residual_render::layer::{Layer, Layers};
use residual_render::program::{
    AlphaTestNode, BsdfNode, CameraNode, ColorNode, EmissionNode, ImageNode, InputNode, LightNode,
    NormalNode, Program, ScalarNode, SourceNode, Structure,
};
use residual_render::sampler::AnySampler;
use residual_render::surface::Attributes;
use residual_render::texture::{AnyFilter, AnyFormat, AnyWrap, Input, UvMap};
use residual_render::tracer::{DebugView, TracerNode};
use residual_scenegen::emit::{wgsl::wgsl_function, wgsl_module};

/// Parses and validates; panics with naga's explanation and the text.
#[track_caller]
fn accept(text: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(text)
        .unwrap_or_else(|error| panic!("{}\n{text}", error.emit_to_string(text)));
    let mut validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
    if let Err(error) = validator.validate(&module) {
        panic!("{}\n{text}", error.emit_to_string(text));
    }
    module
}

/// Sizes of everything that could be removed.
fn sizes(module: &naga::Module) -> Vec<(String, usize)> {
    let mut sizes = vec![
        ("types".to_owned(), module.types.len()),
        ("constants".to_owned(), module.constants.len()),
        ("globals".to_owned(), module.global_variables.len()),
        ("functions".to_owned(), module.functions.len()),
    ];
    for (_, function) in module.functions.iter() {
        let name = function.name.clone().unwrap_or_default();
        sizes.push((format!("{name}: expressions"), function.expressions.len()));
        sizes.push((format!("{name}: variables"), function.local_variables.len()));
    }
    sizes
}

/// Nothing in the module is unused: neither by naga's account nor, for names, by counting words.
#[track_caller]
fn no_dead_code(text: &str) {
    // Every function is wanted: an entry point calls them all.
    let module = accept(text);
    let calls = module
        .functions
        .iter()
        .filter(|(_, f)| f.name.as_deref() != Some("copysign"));
    let calls: Vec<String> =
        calls
            .map(|(_, function)| {
                let arguments = function.arguments.iter().map(|argument| {
                    match &module.types[argument.ty].inner {
                        naga::TypeInner::Vector { .. } => "vec3f(0.5)",
                        naga::TypeInner::Scalar(scalar)
                            if scalar.kind == naga::ScalarKind::Float =>
                        {
                            "0.5f"
                        }
                        naga::TypeInner::Scalar(_) => "1u",
                        other => panic!("{other:?}"),
                    }
                });
                let arguments: Vec<&str> = arguments.collect();
                format!(
                    "    _ = {}({});\n",
                    function.name.as_deref().unwrap(),
                    arguments.join(", ")
                )
            })
            .collect();
    let main = format!(
        "{text}\n@compute @workgroup_size(1)\nfn main() {{\n{}}}\n",
        calls.concat()
    );
    let before = accept(&main);
    let mut after = before.clone();
    compact(&mut after, KeepUnused::No);
    let shrunk: Vec<_> = sizes(&before)
        .into_iter()
        .zip(sizes(&after))
        .filter(|(before, after)| before != after)
        .collect();
    assert!(shrunk.is_empty(), "{shrunk:?}\n{text}");

    for function in text.split("\nfn ").skip(1) {
        let words: Vec<&str> = function
            .split(|c: char| !c.is_alphanumeric() && c != '_')
            .collect();
        for line in function.lines() {
            let line = line.trim();
            let Some(rest) = line.strip_prefix("let ").or(line.strip_prefix("var ")) else {
                continue;
            };
            let name = rest.split([' ', ':']).next().unwrap();
            let uses = words.iter().filter(|word| **word == name).count();
            let needed =
                if line.ends_with("f32;") || line.ends_with("u32;") || line.ends_with("bool;") {
                    4
                } else {
                    2
                };
            assert!(uses >= needed, "{name} is used {uses} times in\n{function}");
        }
    }
}

fn color(name: &'static str, node: ColorNode) -> InputNode {
    InputNode {
        name,
        source: SourceNode::Color(node),
    }
}
fn scalar(name: &'static str, node: ScalarNode) -> InputNode {
    InputNode {
        name,
        source: SourceNode::Scalar(node),
    }
}

fn program(bsdf: BsdfNode) -> Program {
    Program {
        attributes: Attributes::default(),
        inputs: vec![
            color("first", ColorNode::Param(0)),
            color("second", ColorNode::Param(3)),
            scalar("third", ScalarNode::Param(6)),
            scalar("fourth", ScalarNode::Param(7)),
        ],
        normal: None,
        emission: None,
        bsdf,
        alpha_test: None,
    }
}

fn structure(programs: Vec<Program>, lights: Vec<LightNode>) -> Structure {
    Structure {
        programs,
        lights,
        camera: CameraNode::Perspective,
        sampler: AnySampler::Sobol,
        tracer: TracerNode::Path,
        layers: Layers::NONE,
    }
}

fn bsdfs() -> Vec<BsdfNode> {
    let [first, second, third, fourth] = [0, 1, 2, 3].map(Input);
    let diffuse = BsdfNode::Diffuse { albedo: first };
    let conductor = BsdfNode::Conductor {
        color: second,
        roughness: third,
    };
    let coated = BsdfNode::CoatedDiffuse {
        albedo: first,
        roughness: third,
        reflectance: second,
        grazing: fourth,
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
        conductor.clone(),
        coated.clone(),
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

fn images() -> Vec<ImageNode> {
    let mut images = vec![];
    for (k, format) in [
        AnyFormat::SrgbRgba8,
        AnyFormat::LinearRgba8,
        AnyFormat::LinearFloat,
    ]
    .into_iter()
    .enumerate()
    {
        for filter in [AnyFilter::Nearest, AnyFilter::Bilinear] {
            for u in [AnyWrap::Repeat, AnyWrap::MirroredRepeat, AnyWrap::Clamp] {
                for v in [AnyWrap::Repeat, AnyWrap::MirroredRepeat, AnyWrap::Clamp] {
                    let uv = UvMap {
                        set: k % 2,
                        transform: (k > 0).then_some(20),
                    };
                    images.push(ImageNode {
                        slot: 8,
                        uv,
                        channel: k as u32 + 1,
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
fn everything() -> Structure {
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
            Box::new(ColorNode::VertexColor),
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

fn lights() -> Vec<LightNode> {
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
        area(ColorNode::Image(images()[0]), uv0),
        LightNode::Point,
        LightNode::Spot,
        LightNode::Directional,
        LightNode::Environment,
    ]
}

#[test]
fn every_bsdf() {
    for bsdf in bsdfs() {
        no_dead_code(&wgsl_module(&structure(vec![program(bsdf)], vec![])));
    }
}

#[test]
fn every_bsdf_with_constants() {
    for (c, s) in [(0.0, 0.0), (1.0, 1.0), (0.25, 0.5), (1.0, 1.5)] {
        for bsdf in bsdfs() {
            let mut program = program(bsdf);
            program.inputs = vec![
                color("first", ColorNode::Const([c; 3])),
                color("second", ColorNode::Const([1.0 - c; 3])),
                scalar("third", ScalarNode::Const(s)),
                scalar("fourth", ScalarNode::Const(s)),
            ];
            let text = wgsl_module(&structure(vec![program], vec![]));
            no_dead_code(&text);
            assert!(
                !text.contains(" params:"),
                "constants are not loaded\n{text}"
            );
        }
    }
}

#[test]
fn every_image() {
    for image in images() {
        let mut program = program(BsdfNode::Conductor {
            color: Input(0),
            roughness: Input(2),
        });
        program.attributes = Attributes {
            uv0: true,
            uv1: true,
            ..Attributes::default()
        };
        program.inputs[0] = color("color", ColorNode::Image(image));
        program.inputs[2] = scalar("roughness", ScalarNode::Image(image));
        let text = wgsl_module(&structure(vec![program], vec![]));
        no_dead_code(&text);
        assert!(text.contains(" texels:"));
    }
}

#[test]
fn every_light() {
    for light in lights() {
        let matte = program(BsdfNode::Diffuse { albedo: Input(0) });
        let text = wgsl_module(&structure(vec![matte], vec![light.clone()]));
        no_dead_code(&text);
        assert!(text.contains("shadow_contribution"));
        assert_eq!(text.contains("fn miss"), light == LightNode::Environment);
    }
}

#[test]
fn every_camera_and_sampler() {
    for camera in [CameraNode::Perspective, CameraNode::Orthographic] {
        for sampler in [AnySampler::Independent, AnySampler::Sobol] {
            let text = wgsl_module(&Structure {
                camera: camera.clone(),
                sampler,
                ..structure(vec![], vec![])
            });
            no_dead_code(&text);
            assert!(
                !text.contains("light") && !text.contains("fn miss"),
                "a scene without lights picks none"
            );
        }
    }
}

#[test]
fn every_tracer_and_layer() {
    let tracers = [
        (TracerNode::Path, [true, true]),
        (TracerNode::AmbientOcclusion, [true, false]),
        (TracerNode::Debug(DebugView::Normals), [false, false]),
        (TracerNode::Debug(DebugView::Depth), [false, false]),
    ];
    for (tracer, [shadow, bounce]) in tracers {
        for layers in [Layers::NONE, Layer::ALL.into_iter().collect()] {
            let text = wgsl_module(&Structure {
                tracer,
                layers,
                ..everything()
            });
            no_dead_code(&text);
            assert_eq!(text.contains("shadow_active"), shadow);
            assert_eq!(text.contains("bounce_active"), bounce);
            assert_eq!(text.contains("albedo: vec3f"), layers != Layers::NONE);
        }
    }
}

#[test]
fn everything_at_once_and_always_the_same() {
    let text = wgsl_module(&everything());
    no_dead_code(&text);
    assert_eq!(text, wgsl_module(&everything()));
    for buffer in [Buffer::Params, Buffer::Texels, Buffer::Environment] {
        assert!(text.contains(&format!("@binding({})", buffer as usize)));
    }
    assert!(
        text.lines()
            .all(|line| !line.contains("inf") || line.contains("infinite"))
    );
    if let Ok(path) = std::env::var("RESIDUAL_WGSL_OUT") {
        std::fs::write(path, text).unwrap();
    }
}

#[test]
fn constants_leave_a_short_program() {
    let mut program = program(BsdfNode::Diffuse { albedo: Input(0) });
    program.inputs.truncate(1);
    program.inputs[0] = color("albedo", ColorNode::Const([0.5, 0.25, 0.125]));
    let text = wgsl_module(&structure(vec![program], vec![]));
    for absent in [
        "params",
        "indices",
        "normals",
        "if ",
        "shadow",
        "seen",
        "program_0_alpha_test",
    ] {
        assert!(!text.contains(absent), "{absent} is not called for\n{text}");
    }
}

#[test]
fn numbers_are_read_back_as_they_were() {
    let numbers = [
        1e-37,
        0.1,
        1.0,
        16_777_216.0,
        f64::from(f32::MAX),
        f64::from(f32::MIN_POSITIVE),
        -0.3,
    ];
    for number in numbers {
        let tape = Tape::new();
        let d = Record::new(&tape);
        let x = tape.real("x");
        let text = wgsl_function(
            &tape.function("f", Outputs::new().real("y", d.max(x, d.lit(number)))),
            "",
        );
        let module = accept(&text);
        let (_, function) = module.functions.iter().next().unwrap();
        let found = function
            .expressions
            .iter()
            .find_map(|(_, expression)| match expression {
                naga::Expression::Literal(naga::Literal::F32(value)) => Some(*value),
                _ => None,
            });
        assert_eq!(found, Some(number as f32), "{text}");
    }
}

#[test]
fn operations_without_finite_value_are_printed() {
    let tape = Tape::new();
    let d = Record::new(&tape);
    let (x, one, zero) = (tape.real("x"), d.lit(1.0), d.lit(0.0));
    let outputs = Outputs::new()
        .real("quotient", d.select(d.lt(x, one), one / zero, x))
        .real("root", d.sqrt(-one))
        .real("bits", d.from_bits(d.uint(0x7fc0_0000)));
    no_dead_code(&wgsl_function(&tape.function("f", outputs), "Three"));
}

#[test]
#[should_panic(expected = "is used 1 times")]
fn dead_variables_are_found() {
    no_dead_code("\nfn f(x: f32) -> f32 {\n    let v0 = x * 2.0f;\n    return x;\n}\n");
}

#[test]
#[should_panic(expected = "globals")]
fn dead_buffers_are_found() {
    no_dead_code(
        "@group(0) @binding(0) var<storage, read> params: array<u32>;\n\nfn f(x: f32) -> f32 {\n    return x;\n}\n",
    );
}
