//! What changes nothing is recognised, named, and not in the renderer nor among its data; and the picture is the one
//! that a renderer with it would make.

use std::fs;
use std::path::Path;

use glam::{Vec2, Vec3, Vec4};
use residual_device_cpu::LaneCount;
use residual_render::domain::Buffer;
use residual_render::program::LightNode;
use residual_scenegen::desc::{
    AlphaMode, ColorInput, EnvironmentDesc, Filter, LightKind, MaterialDesc, MetallicRoughness,
    NormalMap, Phong, Projection, ScalarInput, SceneDesc, SurfaceDesc, Texels, TextureUse, Wrap,
};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{Binding, Plan, PlanOptions, plan};
use residual_tests::fixtures::{
    Builder, color, material, matte, metallic_roughness, scalar, sheet,
};
use residual_tests::tiny::SIZE;
use residual_tests::{Look, Prepared, read_scene};
use serde_json::{Value, json};

/// A texture of a material and what it amounts to.
struct Case {
    name: &'static str,
    texels: Texels,
    /// Another value of the texel that no ray reads: with it, the texture stays. None where it makes no difference.
    far: Option<Texels>,
    material: fn(TextureUse) -> MaterialDesc,
    dismissed: &'static [(Effect, &'static str)],
    out: &'static [Effect],
    /// A number or a colour that takes the texture's place among the parameters.
    becomes: Option<&'static [f64]>,
}

const SIDE: u32 = 16;

fn bytes(texel: [u8; 4]) -> Texels {
    Texels::Rgba8(vec![texel])
}

fn floats(texel: [f32; 4]) -> Texels {
    Texels::RgbaF32(vec![texel])
}

/// An image of one texel everywhere, but for the one in the corner that is not read.
fn fill(texel: &Texels, far: Option<&Texels>) -> Texels {
    fn all<T: Copy>(texel: T, far: T) -> Vec<T> {
        let mut texels = vec![texel; (SIDE * SIDE) as usize];
        *texels.last_mut().unwrap() = far;
        texels
    }
    match (texel, far.unwrap_or(texel)) {
        (Texels::Rgba8(texel), Texels::Rgba8(far)) => Texels::Rgba8(all(texel[0], far[0])),
        (Texels::RgbaF32(texel), Texels::RgbaF32(far)) => Texels::RgbaF32(all(texel[0], far[0])),
        _ => unreachable!("both are bytes or both are numbers"),
    }
}

/// Two sheets of the material, one before the other, under a point light.
fn scene(case: &Case, far: Option<&Texels>) -> SceneDesc {
    let mut b = Builder::new("sheets");
    let image = b.bytes(SIDE, SIDE);
    let texture = b.texture(image, [Wrap::Clamp; 2], Filter::Linear);
    let meshes = [0.0, 0.3].map(|z| {
        let mut mesh = sheet([-1.0 + z, -0.8, z], [1.6, 0.0, 0.0], [0.0, 1.6, 0.2]);
        // Far from the last texel.
        for uv in mesh.uvs[0].iter_mut().flatten() {
            *uv = Vec2::splat(0.2) + *uv * 0.4;
        }
        mesh.tangents = Some(vec![Vec4::new(1.0, 0.0, 0.0, 1.0); 4]);
        mesh
    });
    b.add(
        material("back", matte([0.5; 3])),
        [sheet([-2.0, -2.0, -1.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0])],
    );
    b.add((case.material)(texture), meshes);
    let position = Vec3::new(0.3, 0.5, 2.0);
    b.light(LightKind::Point { position }, [3.0, 2.5, 2.0]);
    let lens = Projection::Perspective { yfov: 0.6 };
    b.camera("camera", [0.1, 0.2, 3.0], [0.0, 0.0, 0.0], lens);
    let mut scene = b.finish();
    scene.images[image].texels = fill(&case.texels, far);
    scene.validate().unwrap();
    scene
}

fn planned(scene: &SceneDesc, binding: Binding) -> Plan {
    let options = PlanOptions {
        binding,
        size: SIZE,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

fn picture(plan: &Plan, max_depth: u32) -> Vec<[f32; 3]> {
    let look = Look {
        max_depth,
        ..Look::new(SIZE, 8)
    };
    Prepared::new(plan, LaneCount::Eight)
        .interpret(&look)
        .image()
}

fn surface(surface: MetallicRoughness) -> MaterialDesc {
    material("case", SurfaceDesc::MetallicRoughness(surface))
}

fn plastic() -> MetallicRoughness {
    metallic_roughness([0.5; 3], 0.0, 0.5)
}

fn channel(factor: f32, texture: TextureUse, channel: usize) -> ScalarInput {
    ScalarInput {
        factor,
        texture: Some((texture, channel)),
    }
}

fn colored(factor: [f32; 3], texture: TextureUse) -> ColorInput {
    ColorInput {
        factor,
        texture: Some(texture),
    }
}

fn alpha(mode: AlphaMode, factor: f32, texture: TextureUse) -> MaterialDesc {
    MaterialDesc {
        alpha_mode: mode,
        alpha: channel(factor, texture, 3),
        ..material("case", matte([0.5; 3]))
    }
}

fn painted(factor: [f32; 3], texture: TextureUse) -> MaterialDesc {
    let surface = Phong {
        diffuse: colored(factor, texture),
        specular: color([0.0; 3]),
        exponent: scalar(0.0),
    };
    material("case", SurfaceDesc::Phong(surface))
}

const TEXTURE: &[Effect] = &[Effect::Textures];
const ONE_COLOR: &[(Effect, &str)] = &[(Effect::Textures, "of one colour")];
const ONE_NUMBER: &[(Effect, &str)] = &[(Effect::Textures, "the same everywhere")];
const FACTOR_0: &[(Effect, &str)] = &[(Effect::Textures, "its factor is 0")];

fn cases() -> Vec<Case> {
    let white = || bytes([255; 4]);
    let black = || bytes([0, 0, 0, 255]);
    vec![
        Case {
            name: "a colour of bytes",
            // ((188/255 + 0.055) / 1.055)^2.4 and so on, times the factor.
            texels: bytes([188, 64, 10, 255]),
            far: Some(white()),
            material: |texture| painted([0.5, 1.0, 0.25], texture),
            dismissed: ONE_COLOR,
            out: TEXTURE,
            becomes: Some(&[0.251_443_2, 0.051_269_4, 0.000_758_816]),
        },
        Case {
            name: "a colour of floating-point numbers",
            texels: floats([0.5, 0.25, 0.75, 1.0]),
            far: Some(floats([0.5, 0.25, 0.5, 1.0])),
            material: |texture| painted([0.5, 1.0, 0.25], texture),
            dismissed: ONE_COLOR,
            out: TEXTURE,
            becomes: Some(&[0.25, 0.25, 0.1875]),
        },
        Case {
            name: "roughness",
            texels: bytes([7, 100, 9, 255]),
            far: Some(white()),
            material: |texture| {
                surface(MetallicRoughness {
                    roughness: channel(0.5, texture, 1),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: TEXTURE,
            becomes: Some(&[50.0 / 255.0]),
        },
        Case {
            name: "roughness of an image whose other channels vary",
            texels: bytes([7, 100, 9, 255]),
            far: Some(bytes([7, 101, 9, 255])),
            material: |texture| {
                surface(MetallicRoughness {
                    roughness: channel(1.0, texture, 1),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: TEXTURE,
            becomes: Some(&[100.0 / 255.0]),
        },
        Case {
            name: "strength of the coat",
            texels: bytes([0, 0, 0, 51]),
            far: Some(bytes([0, 0, 0, 255])),
            material: |texture| {
                surface(MetallicRoughness {
                    specular: channel(0.5, texture, 3),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: TEXTURE,
            // F0 is 0.04 of it.
            becomes: Some(&[0.004, 0.004, 0.004]),
        },
        Case {
            name: "no coat",
            texels: bytes([255, 255, 255, 0]),
            far: Some(white()),
            material: |texture| {
                surface(MetallicRoughness {
                    specular: channel(1.0, texture, 3),
                    ..plastic()
                })
            },
            dismissed: ONE_NUMBER,
            out: &[Effect::Textures, Effect::DielectricCoat],
            becomes: None,
        },
        Case {
            name: "colour by factor 0",
            texels: white(),
            far: None,
            material: |texture| painted([0.0; 3], texture),
            dismissed: FACTOR_0,
            out: TEXTURE,
            becomes: None,
        },
        Case {
            name: "metallic by factor 0",
            texels: white(),
            far: None,
            material: |texture| {
                surface(MetallicRoughness {
                    metallic: channel(0.0, texture, 2),
                    ..plastic()
                })
            },
            dismissed: FACTOR_0,
            out: &[
                Effect::Textures,
                Effect::MetallicReflection,
                Effect::MixedLobes,
            ],
            becomes: None,
        },
        Case {
            name: "transmission black everywhere",
            texels: black(),
            far: Some(white()),
            material: |texture| {
                surface(MetallicRoughness {
                    transmission: channel(1.0, texture, 0),
                    ..plastic()
                })
            },
            dismissed: &[
                (Effect::Textures, "the same everywhere"),
                (Effect::ThinTransmission, "transmission texture is black"),
            ],
            out: &[
                Effect::Textures,
                Effect::ThinTransmission,
                Effect::MixedLobes,
            ],
            becomes: None,
        },
        Case {
            name: "transmission tinted black by a texture",
            texels: black(),
            // What does transmit is rendered as if smooth, so its coat is another.
            far: None,
            material: |texture| {
                surface(MetallicRoughness {
                    base_color: colored([1.0; 3], texture),
                    transmission: scalar(0.5),
                    ..plastic()
                })
            },
            dismissed: &[
                (Effect::Textures, "of one colour"),
                (Effect::ThinTransmission, "tinted black"),
            ],
            out: &[
                Effect::Textures,
                Effect::ThinTransmission,
                Effect::MixedLobes,
            ],
            becomes: None,
        },
        Case {
            name: "emission black everywhere",
            texels: black(),
            far: Some(white()),
            material: |texture| MaterialDesc {
                emission: colored([4.0; 3], texture),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[
                (Effect::Textures, "of one colour"),
                (Effect::EmittingSurfaces, "emissive texture is black"),
            ],
            out: &[
                Effect::Textures,
                Effect::EmittingSurfaces,
                Effect::TexturedEmission,
            ],
            becomes: None,
        },
        Case {
            name: "emission of one colour",
            texels: bytes([255, 188, 255, 255]),
            far: Some(white()),
            material: |texture| MaterialDesc {
                emission: colored([4.0, 2.0, 1.0], texture),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: ONE_COLOR,
            out: &[Effect::Textures, Effect::TexturedEmission],
            becomes: Some(&[4.0, 1.005_773, 1.0]),
        },
        Case {
            name: "a normal map of scale 0",
            texels: bytes([20, 200, 90, 255]),
            far: Some(white()),
            material: |texture| MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 0.0,
                }),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[(Effect::NormalMaps, "bends no normal")],
            out: &[Effect::NormalMaps, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a flat normal map of floating-point numbers",
            texels: floats([0.5, 0.5, 1.0, 1.0]),
            far: Some(floats([0.9, 0.5, 0.6, 1.0])),
            material: |texture| MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 1.0,
                }),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[(Effect::NormalMaps, "bends no normal")],
            out: &[Effect::NormalMaps, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a flat normal map of bytes",
            texels: bytes([128, 127, 255, 255]),
            // Bytes cannot write it exactly, so pictures differ.
            far: None,
            material: |texture| MaterialDesc {
                normal_map: Some(NormalMap {
                    texture,
                    scale: 1.0,
                }),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[(Effect::NormalMaps, "bends no normal")],
            out: &[Effect::NormalMaps, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a mask that every texel passes",
            texels: bytes([255, 255, 255, 200]),
            far: Some(bytes([255, 255, 255, 0])),
            material: |texture| alpha(AlphaMode::Mask(0.5), 1.0, texture),
            dismissed: &[(Effect::AlphaMasks, "lets nothing through")],
            out: &[Effect::AlphaMasks, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a mask of cutoff 0",
            texels: bytes([255, 255, 255, 0]),
            far: None,
            material: |texture| alpha(AlphaMode::Mask(0.0), 1.0, texture),
            dismissed: &[(Effect::AlphaMasks, "lets nothing through")],
            out: &[Effect::AlphaMasks, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "a mask that no texel passes",
            texels: bytes([255, 255, 255, 100]),
            far: Some(white()),
            material: |texture| alpha(AlphaMode::Mask(0.5), 1.0, texture),
            dismissed: &[(Effect::AlphaMasks, "lets everything through")],
            out: &[Effect::AlphaMasks, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "blending by alpha 1",
            texels: white(),
            far: Some(bytes([255, 255, 255, 0])),
            material: |texture| alpha(AlphaMode::Blend, 1.0, texture),
            dismissed: &[(Effect::AlphaBlending, "lets nothing through")],
            out: &[Effect::AlphaBlending, Effect::Textures],
            becomes: None,
        },
        Case {
            name: "blending by alpha 0",
            texels: bytes([255, 255, 255, 0]),
            far: Some(white()),
            material: |texture| alpha(AlphaMode::Blend, 0.5, texture),
            dismissed: &[(Effect::AlphaBlending, "lets everything through")],
            out: &[Effect::AlphaBlending, Effect::Textures],
            becomes: None,
        },
    ]
}

/// Whether some parameters follow each other among the words.
fn has(params: &[u32], values: &[f64]) -> bool {
    let is = |(word, value): (&u32, &f64)| {
        let found = f64::from(f32::from_bits(*word));
        (found - value).abs() <= 1e-5 * value.abs()
    };
    let mut windows = params.windows(values.len());
    windows.any(|words| words.iter().zip(values).all(is))
}

#[test]
fn what_changes_nothing_is_named_and_out() {
    for case in cases() {
        let name = case.name;
        let plan = planned(&scene(&case, None), Binding::Structure);
        let effects = Effects::of(&plan);
        for (effect, reason) in case.dismissed {
            let said = effects.dismissed(*effect);
            let is_it = |text: &String| text.contains("material \"case\"") && text.contains(reason);
            assert!(said.iter().any(is_it), "{name}: {effect}: {said:?}");
        }
        for effect in case.out {
            assert!(!effects.has(*effect), "{name}: {effect}");
            assert_eq!(effects.reasons(*effect), &[] as &[String], "{name}");
        }
        assert_eq!(plan.data.buffer(Buffer::Texels), &[] as &[u32], "{name}");
        if let Some(values) = case.becomes {
            assert!(has(plan.data.buffer(Buffer::Params), values), "{name}");
            let constants = planned(&scene(&case, None), Binding::Constants);
            assert_eq!(
                constants.data.buffer(Buffer::Params),
                &[] as &[u32],
                "{name}"
            );
        }
    }
}

#[test]
fn a_renderer_with_it_makes_the_same_picture() {
    for case in cases() {
        let (name, Some(far)) = (case.name, &case.far) else {
            continue;
        };
        let without = planned(&scene(&case, None), Binding::Structure);
        let with = planned(&scene(&case, Some(far)), Binding::Structure);
        // A normal map of scale 0 is out for any texels.
        if !name.contains("scale 0") {
            assert!(!with.data.buffer(Buffer::Texels).is_empty(), "{name}");
        }
        // Direct light, or none where one of them picks among more lights: that would be to compare noise.
        let same_lights = with.structure.lights == without.structure.lights;
        let [with, without] =
            [with, without].map(|plan| picture(&plan, 1 + u32::from(same_lights)));
        for (a, b) in with.iter().flatten().zip(without.iter().flatten()) {
            assert!(
                (a - b).abs() <= 1e-5 * a.abs().max(b.abs()),
                "{name}: {a} {b}"
            );
        }
    }
}

/// Of what is never seen there is nothing at all: no program, no data, no light.
#[test]
fn what_is_never_there_is_left_out() {
    let case = Case {
        name: "a lamp that is not there",
        texels: bytes([1, 2, 3, 0]),
        far: None,
        material: |texture| MaterialDesc {
            emission: color([1.0; 3]),
            normal_map: Some(NormalMap {
                texture: texture.clone(),
                scale: 1.0,
            }),
            ..alpha(AlphaMode::Blend, 1.0, texture)
        },
        dismissed: &[],
        out: &[],
        becomes: None,
    };
    let mut scene = scene(&case, Some(&bytes([200, 100, 50, 0])));
    for colors in [None, Some(vec![Vec4::ONE; 4])] {
        scene.meshes[1].colors = colors;
        let plan = planned(&scene, Binding::Structure);
        assert_eq!(plan.structure.programs.len(), 1);
        assert_eq!(plan.structure.lights, [LightNode::Point]);
        assert_eq!(plan.data.triangle_count(), 2);
        assert_eq!(plan.warnings.len(), 2, "{:?}", plan.warnings);
        for buffer in [
            Buffer::Texels,
            Buffer::Indices,
            Buffer::Colors,
            Buffer::Tangents,
        ] {
            assert!(plan.data.buffer(buffer).is_empty(), "{buffer:?}");
        }
        let effects = Effects::of(&plan);
        for effect in [
            Effect::EmittingSurfaces,
            Effect::NormalMaps,
            Effect::Textures,
        ] {
            assert!(!effects.has(effect), "{effect}");
        }
        assert_eq!(effects.dismissed(Effect::AlphaBlending).len(), 1);
    }
}

/// A texture that makes a surface smooth is not what the warning about rough glass is about.
#[test]
fn glass_smoothed_by_a_texture_is_smooth() {
    let case = |texels| Case {
        name: "smooth glass",
        texels,
        far: None,
        material: |texture| {
            surface(MetallicRoughness {
                transmission: scalar(1.0),
                roughness: channel(1.0, texture, 1),
                ..plastic()
            })
        },
        dismissed: &[],
        out: &[],
        becomes: None,
    };
    for (texel, warnings) in [([255, 0, 255, 255], 0), ([255; 4], 1)] {
        let plan = planned(&scene(&case(bytes(texel)), None), Binding::Structure);
        assert_eq!(plan.warnings.len(), warnings, "{:?}", plan.warnings);
        assert!(plan.data.buffer(Buffer::Texels).is_empty());
    }
}

/// A lamp whose texture is black is none, so that there is the sky of scenes without light.
#[test]
fn a_black_lamp_leaves_a_scene_without_light() {
    for (texel, lit) in [([0, 0, 0, 255], false), ([0, 0, 1, 255], true)] {
        let case = Case {
            name: "lamp",
            texels: bytes(texel),
            far: None,
            material: |texture| MaterialDesc {
                emission: colored([1.0; 3], texture),
                ..material("case", matte([0.5; 3]))
            },
            dismissed: &[],
            out: &[],
            becomes: None,
        };
        let mut scene = scene(&case, None);
        scene.lights.clear();
        let plan = planned(&scene, Binding::Structure);
        let effects = Effects::of(&plan);
        assert_eq!(effects.has(Effect::EmittingSurfaces), lit);
        assert_eq!(effects.has(Effect::Environment), !lit);
        let said =
            |warning: &residual_scenegen::desc::Warning| warning.message.contains("white sky");
        assert_eq!(plan.warnings.iter().any(said), !lit);
        // Named once, although the scene is planned twice.
        let dismissed = effects.dismissed(Effect::EmittingSurfaces);
        assert_eq!(dismissed.len(), usize::from(!lit), "{dismissed:?}");
    }
}

/// A black sky is darkness, not a missing light; nobody reads its texels.
#[test]
fn a_black_sky_is_no_light_and_no_data() {
    for (texel, strength) in [(1.0, 0.0), (0.0, 1.0)] {
        let mut b = Builder::new("night");
        let mesh = sheet([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]);
        b.add(material("gray", matte([0.5; 3])), [mesh]);
        let image = b.floats(4, 2);
        let mut scene = b.finish();
        scene.images[image].texels = Texels::RgbaF32(vec![[texel, texel, texel, 1.0]; 8]);
        scene.environment = Some(EnvironmentDesc {
            image,
            strength,
            rotation: 0.0,
        });
        let plan = planned(&scene, Binding::Structure);
        assert!(plan.structure.lights.is_empty());
        for buffer in [Buffer::Texels, Buffer::Environment] {
            assert!(plan.data.buffer(buffer).is_empty(), "{buffer:?}");
        }
        assert!(!Effects::of(&plan).has(Effect::Environment));
        let black = picture(&plan, 8).into_iter().flatten().all(|c| c == 0.0);
        assert!(black, "of {texel} times {strength}");
    }
}

/// A triangle of each of the materials, in a folder with `white.png`.
fn gltf(folder: &Path, materials: &[Value], more: &Value) -> std::path::PathBuf {
    let corners: [f32; 9] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = corners.iter().flat_map(|c| c.to_le_bytes()).collect();
    fs::write(folder.join("corners.bin"), bytes).unwrap();
    image::RgbaImage::from_pixel(2, 2, image::Rgba([255; 4]))
        .save(folder.join("white.png"))
        .unwrap();
    let primitive = |material| json!({ "attributes": { "POSITION": 0 }, "material": material });
    let primitives: Vec<_> = (0..materials.len()).map(primitive).collect();
    let mut document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": primitives }],
        "accessors": [{
            "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
            "min": [0, 0, 0], "max": [1, 1, 0]
        }],
        "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
        "buffers": [{ "uri": "corners.bin", "byteLength": 36 }],
        "materials": materials,
        "textures": [{ "source": 0 }],
        "images": [{ "uri": "white.png", "name": "white" }],
    });
    for (key, values) in more.as_object().unwrap() {
        match &mut document[key] {
            Value::Array(list) => list.extend(values.as_array().unwrap().iter().cloned()),
            absent => *absent = values.clone(),
        }
    }
    let file = folder.join("scene.gltf");
    fs::write(&file, document.to_string()).unwrap();
    file
}

/// What the scene of a file dismisses, places and reasons.
fn dismissed(scene: &SceneDesc) -> Vec<(String, String)> {
    let plan = planned(scene, Binding::Structure);
    let pair = |d: residual_scenegen::desc::Dismissed| (d.place, d.reason);
    plan.dismissed.into_iter().map(pair).collect()
}

fn assert_named(list: &[(String, String)], place: &str, reason: &str) {
    let is_it = |(p, r): &&(String, String)| p.contains(place) && r.contains(reason);
    assert_eq!(
        list.iter().filter(is_it).count(),
        1,
        "{place}: {reason}: {list:?}"
    );
}

/// Extensions that we do not render are no loss where their factor is 0, be it by default.
#[test]
fn extensions_by_factor_0_are_dismissed_without_a_warning() {
    let switches = [
        (
            "KHR_materials_anisotropy",
            "anisotropyStrength",
            json!(0.0),
            json!(0.1),
        ),
        (
            "KHR_materials_clearcoat",
            "clearcoatFactor",
            json!(0),
            json!(1),
        ),
        (
            "KHR_materials_diffuse_transmission",
            "diffuseTransmissionFactor",
            json!(0.0),
            json!(0.5),
        ),
        (
            "KHR_materials_dispersion",
            "dispersion",
            json!(0.0),
            json!(0.3),
        ),
        (
            "KHR_materials_iridescence",
            "iridescenceFactor",
            json!(0.0),
            json!(1e-3),
        ),
        (
            "KHR_materials_sheen",
            "sheenColorFactor",
            json!([0, 0.0, 0]),
            json!([0, 0.1, 0]),
        ),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (extension, member, zero, other) in switches {
        let material = |name: &str, content: Value| json!({ "name": name, "extensions": { extension: content } });
        let materials = [
            material("zero", json!({ member: zero })),
            material("default", json!({})),
            material("other", json!({ member: other })),
        ];
        let file = gltf(
            folder.path(),
            &materials,
            &json!({ "extensionsUsed": [extension] }),
        );
        let scene = read_scene(&file, None).unwrap();
        let list = dismissed(&scene);
        for name in ["zero", "default"] {
            assert_named(
                &list,
                &format!("\"{name}\""),
                &format!("{extension} is there, and its factor is 0"),
            );
            let warned = scene.warnings.iter().any(|w| w.place.contains(name));
            assert!(!warned, "{:?}", scene.warnings);
        }
        assert!(
            !list.iter().any(|(place, _)| place.contains("other")),
            "{list:?}"
        );
        let warned = |w: &&residual_scenegen::desc::Warning| w.message.contains(extension);
        assert_eq!(
            scene.warnings.iter().filter(warned).count(),
            1,
            "{:?}",
            scene.warnings
        );
    }
}

#[test]
fn what_a_gltf_file_does_not_use_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let strength = |strength: f32| json!({ "KHR_materials_emissive_strength": { "emissiveStrength": strength } });
    let materials = [
        json!({ "name": "dark", "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 0 }, "extensions": strength(0.0) }),
        json!({ "name": "plain" }),
    ];
    let more = json!({
        "materials": [{ "name": "spare" }],
        "meshes": [{ "name": "ghost", "primitives": [{ "attributes": { "POSITION": 0 }, "material": 2 }] }],
        "images": [{ "uri": "missing.png", "name": "unread" }],
    });
    let scene = read_scene(&gltf(folder.path(), &materials, &more), None).unwrap();
    let list = dismissed(&scene);
    assert_named(&list, "materials/0 \"dark\"", "emissiveStrength is 0");
    assert_named(
        &list,
        "materials/2 \"spare\"",
        "no mesh of the scene uses it",
    );
    assert_named(&list, "meshes/1 \"ghost\"", "no node of the scene shows it");
    for image in ["images/0 \"white\"", "images/1 \"unread\""] {
        assert_named(&list, image, "no material in use reads it");
    }
    assert_eq!(list.len(), 5, "{list:?}");
    let effects = Effects::of(&planned(&scene, Binding::Structure));
    assert_eq!(effects.dismissed(Effect::EmittingSurfaces).len(), 1);
    assert!(!effects.has(Effect::EmittingSurfaces) && !effects.has(Effect::Textures));
    assert!(
        scene.images.is_empty() && scene.warnings.is_empty(),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn what_an_obj_file_does_not_use_is_named() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(
        folder.path().join("scene.mtl"),
        "newmtl used\nKd 0.5 0.5 0.5\nKe 0 0 0\nnewmtl spare\nKd 1 1 1\nmap_Kd missing.png\n",
    )
    .unwrap();
    let file = folder.path().join("scene.obj");
    fs::write(
        &file,
        "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl used\nf 1 2 3\n",
    )
    .unwrap();
    let scene = read_scene(&file, None).unwrap();
    let list = dismissed(&scene);
    assert_named(&list, "\"spare\"", "no face uses it");
    assert_eq!(list.len(), 1, "{list:?}");
    assert_eq!((scene.materials.len(), scene.images.len()), (1, 0));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}
