//! Textures, lamps and skies that change nothing.

use glam::Vec4;
use residual_render::domain::Buffer;
use residual_render::program::LightNode;
use residual_render::triangle::TriangleRecord;
use residual_scenegen::desc::{
    AlphaMode, EnvironmentDesc, MaterialDesc, MetallicRoughness, NormalMap, Texels,
};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::Binding;
use residual_tests::fixtures::{Builder, color, material, matte, scalar, sheet};

use crate::cases::cases;
use crate::sheets::{
    Case, alpha, bytes, channel, colored, picture, planned, plastic, scene, surface,
};

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
        for buffer in [Buffer::Texels, Buffer::Colors, Buffer::Tangents] {
            assert!(plan.data.buffer(buffer).is_empty(), "{buffer:?}");
        }
        let mut triangles = plan.data.records::<TriangleRecord>();
        assert!(triangles.all(|triangle| triangle.vertices() == [0; 3]));
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

/// A texture that makes a surface smooth leaves no rough glass.
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
    for (texel, is_rough) in [([255, 0, 255, 255], false), ([255; 4], true)] {
        let plan = planned(&scene(&case(bytes(texel)), None), Binding::Structure);
        let effects = Effects::of(&plan);
        assert_eq!(effects.has(Effect::RoughTransmission), is_rough);
        assert!(plan.warnings.is_empty(), "{:?}", plan.warnings);
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
