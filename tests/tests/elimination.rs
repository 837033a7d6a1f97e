//! What a scene does not call for is not in its renderer: neither in the emitted text, nor as a symbol, nor as a single
//! instruction, inlined ones included.
//!
//! The same look at scenes that do call for something finds it: otherwise it would say nothing.
//!
//! Longer than 400 lines: tables of words and of files.
#![cfg(target_os = "linux")]

use std::path::Path;

use residual_render::layer::{Layer, Layers};
use residual_render::tracer::{DebugView, TracerNode};
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::emit::rust;
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use residual_tests::library::Library;
use residual_tests::{fixtures, read_scene, scenes, tiny};

/// Effects that are layers over a base.
const COATS: &[Effect] = &[Effect::DielectricCoat, Effect::ClearCoat, Effect::Sheen];
/// Effects whose light microfacets reflect.
const FACETS: &[Effect] = &[
    Effect::DielectricCoat,
    Effect::ClearCoat,
    Effect::MetallicReflection,
];

/// Effects of what paths meet between surfaces.
const MEDIA: &[Effect] = &[
    Effect::Absorption,
    Effect::ScatteringMedia,
    Effect::NestedBodies,
];

/// What emitted texts contain, one word or another, and the effects that alone call for it.
const WORDS: &[(&str, &[Effect])] = &[
    ("TEXTURE_", &[Effect::Textures]),
    ("Image<", &[Effect::Textures]),
    ("Nearest", &[Effect::NearestFilter]),
    ("Bilinear", &[Effect::BilinearFilter]),
    ("Trilinear", &[Effect::Mipmaps]),
    ("filters", &[Effect::Mipmaps]),
    ("Repeat", &[Effect::RepeatWrap]),
    ("MirroredRepeat", &[Effect::MirrorWrap]),
    ("Clamp", &[Effect::ClampWrap]),
    ("WhiteBorder", &[Effect::BorderWrap]),
    ("SrgbRgba8", &[Effect::SrgbTexels]),
    ("LinearRgba8", &[Effect::LinearTexels]),
    ("LinearHalf", &[Effect::HalfTexels]),
    ("LinearFloat", &[Effect::FloatTexels]),
    ("Checkerboard {", &[Effect::ProceduralTextures]),
    ("transform: Some", &[Effect::TextureTransforms]),
    ("set: 1", &[Effect::SecondUvSet]),
    ("VertexColor", &[Effect::VertexColors]),
    ("normals: true", &[Effect::SmoothNormals]),
    ("decode_normal", &[Effect::NormalMaps]),
    ("MappedFrame {", &[Effect::CoatNormalMaps]),
    (
        "has_alpha_tests",
        &[Effect::AlphaMasks, Effect::AlphaBlending],
    ),
    ("alpha_test(", &[Effect::AlphaMasks, Effect::AlphaBlending]),
    ("AlphaMask {", &[Effect::AlphaMasks]),
    ("AlphaBlend {", &[Effect::AlphaBlending]),
    ("Coated {", COATS),
    ("UnderCoat {", &[Effect::CoatedEmission]),
    ("Glossy {", FACETS),
    ("ThinFilm {", &[Effect::Iridescence]),
    ("Anisotropic {", &[Effect::Anisotropy]),
    ("decode_tangent", &[Effect::Anisotropy]),
    ("Sheen {", &[Effect::Sheen]),
    (
        "RoughDielectric {|RoughSheet {",
        &[Effect::RoughTransmission],
    ),
    ("RoughDiffuse {", &[Effect::RoughDiffuseReflection]),
    ("DiffuseTransmission {", &[Effect::DiffuseTransmission]),
    ("InMedia", MEDIA),
    ("AbsorptionAndScattering {", &[Effect::ScatteringMedia]),
    ("Nested", &[Effect::NestedBodies]),
    ("SolidAmongSolids", &[Effect::NestedBodies]),
    ("Dispersing", &[Effect::Dispersion]),
    ("Dispersive {", &[Effect::Dispersion]),
    ("Phong {", &[Effect::PhongReflection]),
    ("Mirror {", &[Effect::MirrorReflection]),
    ("interface: Thin|RoughSheet {", &[Effect::ThinTransmission]),
    ("interface: Solid|RoughDielectric {", &[Effect::Refraction]),
    ("Area<|AreaBySolidAngle<", &[Effect::EmittingSurfaces]),
    ("AreaBySolidAngle<", &[Effect::SolidAngleSampling]),
    ("emission: Some", &[Effect::EmittingSurfaces]),
    ("(Point, ", &[Effect::PointLights]),
    ("(Spot, ", &[Effect::SpotLights]),
    ("(Directional, ", &[Effect::DirectionalLights]),
    ("(SphericalPoint, ", &[Effect::SphericalPointLights]),
    ("(SphericalSpot, ", &[Effect::SphericalSpotLights]),
    ("(Sun, ", &[Effect::Suns]),
    ("(Environment, ", &[Effect::Environment]),
    ("Perspective", &[Effect::PerspectiveCamera]),
    ("ThinLens", &[Effect::DepthOfField]),
    ("Orthographic", &[Effect::OrthographicCamera]),
    ("Panorama", &[Effect::PanoramicCamera]),
];

/// Source files of renderers, and the effects that alone call for them.
const SOURCES: &[(&str, &[Effect])] = &[
    ("render/src/texture/image.rs", &[Effect::Textures]),
    // Environments are images, too.
    (
        "render/src/texture/wrapping.rs",
        &[Effect::Textures, Effect::Environment],
    ),
    (
        "render/src/texture/filtering.rs",
        &[Effect::Textures, Effect::Environment],
    ),
    (
        "render/src/texture/texel_format.rs",
        &[Effect::Textures, Effect::Environment],
    ),
    (
        "render/src/texture/checkerboard.rs",
        &[Effect::ProceduralTextures],
    ),
    ("render/src/light/environment.rs", &[Effect::Environment]),
    (
        "render/src/bsdf/dielectric.rs",
        &[Effect::Refraction, Effect::ThinTransmission],
    ),
    (
        "render/src/alpha.rs",
        &[Effect::AlphaMasks, Effect::AlphaBlending],
    ),
    ("render/src/bsdf/coated.rs", COATS),
    ("render/src/bsdf/glossy.rs", FACETS),
    ("render/src/bsdf/fresnel.rs", FACETS),
    ("render/src/bsdf/phong.rs", &[Effect::PhongReflection]),
    ("render/src/bsdf/mirror.rs", &[Effect::MirrorReflection]),
    (
        "render/src/bsdf/combine.rs",
        &[Effect::MixedLobes, Effect::DielectricCoat],
    ),
    ("render/src/bsdf/ggx.rs", FACETS),
    ("render/src/bsdf/directional_albedo.rs", FACETS),
    (
        "render/src/math/fresnel.rs",
        &[
            Effect::DielectricCoat,
            Effect::MetallicReflection,
            Effect::Refraction,
            Effect::ThinTransmission,
        ],
    ),
    ("render/src/tracer/in_media.rs", MEDIA),
    ("render/src/tracer/medium.rs", MEDIA),
    (
        "render/src/bsdf/henyey_greenstein.rs",
        &[Effect::ScatteringMedia],
    ),
    ("render/src/tracer/dispersing.rs", &[Effect::Dispersion]),
    (
        "render/src/texture/under_coat.rs",
        &[Effect::CoatedEmission],
    ),
    ("render/src/light/area.rs", &[Effect::EmittingSurfaces]),
    (
        "render/src/light/area_by_solid_angle.rs",
        &[Effect::SolidAngleSampling],
    ),
    (
        "render/src/math/spherical_triangle.rs",
        &[Effect::SolidAngleSampling],
    ),
    ("render/src/light/cone.rs", SIZED_LIGHTS),
    ("render/src/light/sized.rs", SIZED_LIGHTS),
    (
        "render/src/light/punctual.rs",
        &[
            Effect::PointLights,
            Effect::SpotLights,
            Effect::DirectionalLights,
            Effect::SphericalPointLights,
            Effect::SphericalSpotLights,
            Effect::Suns,
        ],
    ),
];

/// What lights with a size are called for by.
const SIZED_LIGHTS: &[Effect] = &[
    Effect::SphericalPointLights,
    Effect::SphericalSpotLights,
    Effect::Suns,
];

/// Files that every renderer may contain.
const COMMON: &[&str] = &[
    "bvh/src/ray.rs",
    "bvh/src/trace/prefetch.rs",
    "device-cpu/src/",
    "render/src/alias_table.rs",
    "render/src/bsdf/diffuse.rs",
    // Kinds whose functions fold to constants or to the source that they hold.
    "render/src/bsdf/interface.rs",
    "render/src/bsdf/roughness.rs",
    "render/src/bsdf/mod.rs",
    "render/src/camera.rs",
    "render/src/domain/",
    // Which samples of which pixels.
    "render/src/film/pass.rs",
    "render/src/film/rect.rs",
    // How many numbers a sample has.
    "render/src/film/replicates.rs",
    "render/src/layer.rs",
    "render/src/light/kinds.rs",
    "render/src/light/mod.rs",
    "render/src/light/pick.rs",
    "render/src/light/scene_lights.rs",
    "render/src/material.rs",
    "render/src/math/",
    // Counters of rays and seconds.
    "render/src/passes.rs",
    "render/src/record/",
    "render/src/sampler/",
    "render/src/surface/",
    // Constants and parameters.
    "render/src/texture/mod.rs",
    "render/src/texture/params.rs",
    // What tracers around others leave to them.
    "render/src/tracer/forward.rs",
    "render/src/tracer/mod.rs",
    // Kinds of media: what they hold is in `medium.rs` and `henyey_greenstein.rs`.
    "render/src/tracer/matter.rs",
    "render/src/tracer/mis.rs",
    "render/src/tracer/nesting.rs",
    "render/src/tracer/next_event.rs",
    "render/src/tracer/path.rs",
    "render/src/tracer/path_state.rs",
    "render/src/tracer/settings.rs",
    "render/src/tracer/step.rs",
    "render/src/tracer/vertex_pairs.rs",
    "render/src/tracer/way_on.rs",
    "render/src/triangle.rs",
];

fn planned(scene: &SceneDesc) -> Plan {
    plan(scene, &PlanOptions::default()).unwrap()
}

fn check_text(plan: &Plan) {
    let effects = Effects::of(plan);
    let text = rust::module(plan, "Eight");
    for (word, callers) in WORDS {
        let wanted = callers
            .iter()
            .any(|effect| !effects.reasons(*effect).is_empty());
        let has_any = word.split('|').any(|word| has_word(&text, word));
        assert_eq!(has_any, wanted, "{}: {word}", plan.name);
    }
}

/// Whether a text has a word that is not the end of another.
fn has_word(text: &str, word: &str) -> bool {
    let is_whole = |start: usize| {
        let before = text[..start].chars().next_back();
        before.is_none_or(|c| !c.is_alphanumeric() && c != '_')
    };
    text.match_indices(word).any(|(start, _)| is_whole(start))
}

/// Compiles a renderer and looks where its instructions come from.
fn check_instructions(plan: &Plan, name: &str) -> Library {
    let effects = Effects::of(plan);
    let library = Library::compile(plan);
    println!(
        "{name}: {} bytes of instructions, {} in functions of the project, {} of them from known places",
        library.size, library.own, library.known
    );
    assert!(
        library.own > 10_000 && library.known == library.own,
        "{name}"
    );
    for (file, callers) in SOURCES {
        let wanted = callers
            .iter()
            .any(|effect| !effects.reasons(*effect).is_empty());
        let bytes = library.bytes_of(file);
        println!("    {file}: {bytes}");
        assert_eq!(bytes > 0, wanted, "{name}: {bytes} bytes from {file}");
    }
    for (file, bytes) in library.sources() {
        let common = COMMON.iter().any(|start| file.starts_with(start));
        let listed = SOURCES.iter().any(|(other, _)| *other == file);
        assert!(common || listed, "{name}: {bytes} bytes from {file}");
    }
    library
}

#[test]
fn texts_contain_what_scenes_call_for_and_nothing_else() {
    for tiny in tiny::all() {
        check_text(&tiny.plan());
    }
    for scene in [fixtures::room(), fixtures::textures(), fixtures::lights()] {
        check_text(&planned(&scene));
    }
}

#[test]
fn renderers_contain_what_scenes_call_for() {
    for (name, functions) in [
        ("alpha_mask", &["texture::image", "alpha_test"][..]),
        ("diffuse_and_phong", &["bsdf::phong", "bsdf::combine"]),
        ("diffuse_and_mirror", &["bsdf::mirror"]),
        ("environment", &["light::environment"]),
        ("mixed_metal", &["bsdf::glossy", "bsdf::coated"]),
        ("solid_glass", &["bsdf::dielectric"]),
        ("tinted_glass", &["tracer::in_media"]),
    ] {
        let library = check_instructions(&tiny::named(name).plan(), name);
        // Names tell, too: the Cornell box has none of these.
        for part in functions {
            assert!(NOT_IN_CORNELL.contains(part));
            assert!(library.has_function(part), "{name}: {part}");
        }
    }
}

/// Parts of names of functions. Instances are the hierarchy's, which is no part of a renderer; media would be a file that
/// is neither among [`SOURCES`] nor [`COMMON`].
const NOT_IN_CORNELL: &[&str] = &[
    "texture::image",
    "alpha_test",
    "light::environment",
    "light::punctual",
    "bsdf::dielectric",
    "bsdf::ggx",
    "bsdf::glossy",
    "bsdf::coated",
    "bsdf::phong",
    "bsdf::mirror",
    "bsdf::combine",
    "decode_normal",
    "tracer::in_media",
    "tracer::dispersing",
    "tracer::light_paths",
    "light::emission",
    "bvh::instances",
];

fn check_cornell(scene: &SceneDesc, name: &str) {
    let plan = planned(scene);
    check_text(&plan);
    let effects: Vec<_> = Effects::of(&plan).iter().collect();
    let expected = [
        Effect::DiffuseReflection,
        Effect::BackFaceCulling,
        Effect::EmittingSurfaces,
        Effect::PerspectiveCamera,
    ];
    assert_eq!(effects, expected);
    let library = check_instructions(&plan, name);
    assert!(library.has_function("bsdf::diffuse"));
    for part in NOT_IN_CORNELL {
        assert!(!library.has_function(part), "{name}: {part}");
    }
}

#[test]
fn cornell_box() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let scene = read_scene(&scenes.join("cornell-box.gltf"), None);
    check_cornell(&scene.unwrap(), "cornell_box");
}

#[test]
fn shared_cornell_box() {
    let Some(scenes) = scenes() else { return };
    let scene = read_scene(&scenes.join("interiors/cornell-generated.glb"), None);
    check_cornell(&scene.unwrap(), "cornell_generated");
}

/// Layers, and tracers but that of paths, are asked for on the command line. Who does not ask has none of their code.
#[test]
fn layers_and_other_tracers_are_there_if_asked_for() {
    let scene = tiny::plain().scene;
    let compile = |tracer, layers| {
        let options = PlanOptions {
            tracer,
            layers,
            ..PlanOptions::default()
        };
        Library::compile(&plan(&scene, &options).unwrap())
    };
    let all: Layers = Layer::ALL.into_iter().collect();
    let libraries = [
        compile(TracerNode::default(), Layers::NONE),
        compile(TracerNode::default(), all),
        compile(TracerNode::AmbientOcclusion, Layers::NONE),
        compile(TracerNode::Debug(DebugView::Normals), Layers::NONE),
    ];
    let is_in = |file: &str| {
        let bytes = libraries.each_ref().map(|library| library.bytes_of(file));
        bytes.map(|bytes| bytes > 0)
    };
    assert_eq!(
        is_in("render/src/tracer/path.rs"),
        [true, true, false, false]
    );
    assert_eq!(
        is_in("render/src/tracer/features.rs"),
        [false, true, false, false]
    );
    assert_eq!(
        is_in("render/src/tracer/ambient_occlusion.rs"),
        [false, false, true, false]
    );
    assert_eq!(
        is_in("render/src/tracer/debug.rs"),
        [false, false, false, true]
    );
    // What is not computed needs no light either.
    assert_eq!(
        is_in("render/src/light/punctual.rs"),
        [true, true, false, false]
    );
}
