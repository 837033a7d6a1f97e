//! Printed WGSL: naga accepts it, nothing in it is dead, and it is the same every time.

mod naga_checks;
mod structures;

use residual_render::bsdf::AnyInterface;
use residual_render::domain::Domain;
use residual_render::domain::tape::{Outputs, Record, Tape};
use residual_render::layer::{Layer, Layers};
use residual_render::light::LightTree;
use residual_render::program::{
    BsdfNode, CameraNode, ColorNode, FresnelNode, LightNode, RoughnessNode, ScalarNode, Structure,
};
use residual_render::sampler::AnySampler;
use residual_render::surface::Attributes;
use residual_render::texture::Input;
use residual_render::tracer::{
    AnyNesting, AnySharing, Between, DebugView, MatterNode, MediaNode, TracerNode,
};
use residual_wgsl::{Arithmetic, Binding, KernelSet, Mapping, function_module, scene_module};

use crate::naga_checks::{accept, no_dead_code};
use crate::structures::{bsdfs, color, everything, images, lights, program, scalar, structure};

#[test]
fn every_bsdf() {
    for bsdf in bsdfs() {
        no_dead_code(&scene_module(&structure(vec![program(bsdf)], vec![])));
    }
}

#[test]
fn every_bsdf_with_constants() {
    for (c, s) in [(0.0, 0.0), (1.0, 1.0), (0.25, 0.5), (1.0, 1.5)] {
        for bsdf in bsdfs() {
            let has_table = matches!(bsdf, BsdfNode::RoughDielectric { .. });
            let mut program = program(bsdf);
            program.inputs = vec![
                color("first", ColorNode::Const([c; 3])),
                color("second", ColorNode::Const([1.0 - c; 3])),
                scalar("third", ScalarNode::Const(s)),
                scalar("fourth", ScalarNode::Const(s)),
            ];
            let text = scene_module(&structure(vec![program], vec![]));
            no_dead_code(&text);
            assert!(
                has_table || !text.contains("bases.params"),
                "constants are not loaded\n{text}"
            );
        }
    }
}

#[test]
fn every_image() {
    for image in images() {
        let mut program = program(BsdfNode::Glossy {
            fresnel: FresnelNode::Schlick {
                normal: Input(0),
                grazing: Input(3),
            },
            roughness: RoughnessNode::Isotropic {
                roughness: Input(2),
            },
        });
        program.attributes = Attributes {
            uv0: true,
            uv1: true,
            ..Attributes::default()
        };
        program.inputs[0] = color("color", ColorNode::Image(image));
        program.inputs[2] = scalar("roughness", ScalarNode::Image(image));
        let text = scene_module(&structure(vec![program], vec![]));
        no_dead_code(&text);
        assert!(text.contains(" texels:"));
    }
}

#[test]
fn every_light() {
    for light in lights() {
        let matte = program(BsdfNode::Diffuse { albedo: Input(0) });
        let text = scene_module(&structure(vec![matte], vec![light.clone()]));
        no_dead_code(&text);
        assert!(text.contains("shadow_contribution"));
        assert_eq!(text.contains("fn miss"), light == LightNode::Environment);
    }
}

#[test]
fn lights_of_a_tree() {
    let matte = program(BsdfNode::Diffuse { albedo: Input(0) });
    let text = scene_module(&Structure {
        light_tree: Some(LightTree { levels: 5 }),
        ..structure(vec![matte], lights())
    });
    no_dead_code(&text);
    assert!(text.contains("bases.light_tree") && !text.contains("bases.light_alias"));
}

#[test]
fn every_camera_and_sampler() {
    for camera in [
        CameraNode::Perspective,
        CameraNode::ThinLens,
        CameraNode::Orthographic,
        CameraNode::Panorama,
    ] {
        for sampler in [AnySampler::Independent, AnySampler::Sobol] {
            let text = scene_module(&Structure {
                camera: camera.clone(),
                sampler,
                ..structure(vec![], vec![])
            });
            no_dead_code(&text);
            assert!(
                !text.contains("bases.light") && !text.contains("fn miss"),
                "a scene without lights picks none"
            );
        }
    }
}

#[test]
fn every_tracer_and_layer() {
    let tracers = [
        (TracerNode::default(), [true, true]),
        (TracerNode::AmbientOcclusion, [true, false]),
        (TracerNode::Debug(DebugView::Normals), [false, false]),
        (TracerNode::Debug(DebugView::Depth), [false, false]),
    ];
    for (tracer, [shadow, bounce]) in tracers {
        for layers in [Layers::NONE, Layer::ALL.into_iter().collect()] {
            let text = scene_module(&Structure {
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
fn paths_from_both_ends() {
    for sharing in [AnySharing::Combined, AnySharing::LightPathsOnly] {
        let text = scene_module(&Structure {
            tracer: TracerNode::Bidirectional(sharing),
            ..everything()
        });
        no_dead_code(&text);
        for function in [
            "emit",
            "light_emit",
            "program_0_step",
            "light_program_0_step",
        ] {
            assert_eq!(
                text.matches(&format!("fn {function}(")).count(),
                1,
                "{function}"
            );
        }
        assert!(text.contains("shadow_pixel"));
    }
    assert!(!scene_module(&everything()).contains("light_emit"));
}

/// Media and dispersion are printed where a scene has them, and nowhere else.
#[test]
fn what_paths_meet_between_surfaces() {
    let media = |nesting, matter| Some(MediaNode { nesting, matter });
    let all_media = [
        None,
        media(AnyNesting::Beside, MatterNode::Absorption),
        media(AnyNesting::Beside, MatterNode::AbsorptionAndScattering),
        media(AnyNesting::Nested, MatterNode::Absorption),
        media(AnyNesting::Nested, MatterNode::AbsorptionAndScattering),
    ];
    let both = [false, true].map(|dispersion| all_media.map(|media| (media, dispersion)));
    for (media, dispersion) in both.into_iter().flatten() {
        let mut scene = everything();
        scene.between = Between { media, dispersion };
        let mut glass = program(BsdfNode::Dielectric {
            transmittance: Input(0),
            ior: Input(3),
            interface: match scene.between.nests() {
                true => AnyInterface::SolidAmongSolids,
                false => AnyInterface::Solid,
            },
        });
        glass.interior = media.map(|_| 8);
        if dispersion {
            let ior = ScalarNode::Dispersive {
                ior: Box::new(ScalarNode::Param(6)),
                dispersion: Box::new(ScalarNode::Param(7)),
            };
            glass.inputs[3] = scalar("ior", ior);
        }
        scene.programs.push(glass);
        let text = scene_module(&scene);
        no_dead_code(&text);
        assert_eq!(text.contains("bases.media"), media.is_some());
    }
}

#[test]
fn everything_at_once_and_always_the_same() {
    let text = scene_module(&everything());
    no_dead_code(&text);
    assert_eq!(text, scene_module(&everything()));
    for binding in Binding::ALL {
        assert!(text.contains(&format!("@binding({})", binding as u32)));
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
    let text = scene_module(&structure(vec![program], vec![]));
    for absent in [
        "bases.params",
        "bases.indices",
        "bases.normals",
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
        let text = function_module(
            &tape.function("f", Outputs::new().real("y", x + d.lit(number))),
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
    no_dead_code(&function_module(&tape.function("f", outputs), "Three"));
}

#[test]
fn sets_of_kernels_are_read_back() {
    for mapping in [Mapping::Wavefront, Mapping::Megakernel] {
        let set = KernelSet::new(&everything(), mapping, true, true, Arithmetic::default());
        assert!(set.texts().count() >= 1);
        assert_eq!(set.to_string().parse(), Ok(set));
    }
    let foreign = "// residual kernels, version 0: wavefront 0 0 3\n";
    let error = foreign.parse::<KernelSet>().unwrap_err();
    assert!(error.contains("emit them anew"), "{error}");
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
