//! Renderers that could do more than their scenes call for.

use std::collections::BTreeMap;

use residual_device_cpu::LaneCount;
use residual_render::domain::Buffer;
use residual_render::light::EnvironmentHeader;
use residual_render::program::{LightNode, Structure};
use residual_render::record::BufferRecord;
use residual_render::scene_data::SceneData;
use residual_render::tracer::{AnyNesting, Between, MatterNode, MediaNode, MediumRecord};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{LightKindUse, MaterialUse, Plan};
use residual_tests::pictures::first_difference;
use residual_tests::tiny::{self, SIZE};
use residual_tests::{Look, Prepared};
use residual_variants::AnyLanes;

/// What a renderer of a plan shows of a scene's data.
fn picture(plan: &Plan, structure: &Structure) -> Vec<[f32; 3]> {
    let prepared = Prepared::new(plan, LaneCount::Eight);
    let renderer = AnyLanes::new(structure.clone(), LaneCount::Eight);
    let film = prepared.render(&renderer, &Look::new(SIZE, 8));
    assert_eq!(film.invalid_samples(), 0);
    film.image()
}

/// Data for an environment that is black and never picked, so that renderers can ask for it.
fn add_black_environment(data: &mut SceneData) {
    let bright = tiny::named("environment").plan().data;
    for buffer in [Buffer::Environment, Buffer::Texels] {
        assert!(data.buffer(buffer).is_empty());
        data.buffer_mut(buffer).extend(bright.buffer(buffer));
    }
    data.change(0, |header| EnvironmentHeader {
        strength: 0.0,
        ..header
    });
}

/// The plain scene's structure, with the programs and the lights of all tiny scenes: none of its triangles uses them.
fn with_everything(plain: &Structure) -> Structure {
    let mut structure = plain.clone();
    for tiny in tiny::all() {
        let other = tiny.plan().structure;
        for program in other.programs {
            if !structure.programs.contains(&program) {
                structure.programs.push(program);
            }
        }
        for light in other.lights {
            if !structure.lights.contains(&light) {
                structure.lights.push(light);
            }
        }
    }
    structure
}

#[test]
fn what_is_not_used_changes_nothing() {
    let plain = tiny::plain().plan();
    let expected = picture(&plain, &plain.structure);
    let mut seen = 0;
    let mut same = |what: &str, plan: &Plan, structure: &Structure| {
        assert_ne!(*structure, plain.structure, "{what}");
        let image = picture(plan, structure);
        assert_eq!(first_difference(&expected, &image), None, "{what}");
        seen += 1;
    };
    for tiny in tiny::all() {
        let other = tiny.plan();
        let mut structure = plain.structure.clone();
        let new = |program: &&_| !plain.structure.programs.contains(program);
        structure
            .programs
            .extend(other.structure.programs.iter().filter(new).cloned());
        if structure != plain.structure {
            same(
                &format!("the programs of {}", tiny.name),
                &plain,
                &structure,
            );
        }
        for light in other.structure.lights {
            if !plain.structure.lights.contains(&light) && light != LightNode::Environment {
                let mut structure = plain.structure.clone();
                structure.lights.push(light);
                same(&format!("the lights of {}", tiny.name), &plain, &structure);
            }
        }
    }
    // Sides are a question to the hierarchy.
    let mut sided = plain.clone();
    sided.data.single_sided = vec![false; sided.data.triangle_count()];
    assert_eq!(
        first_difference(&expected, &picture(&sided, &plain.structure)),
        None
    );
    let mut dark = plain.clone();
    add_black_environment(&mut dark.data);
    let mut structure = plain.structure.clone();
    structure.lights.push(LightNode::Environment);
    same("a black environment", &dark, &structure);
    assert!(seen > 20, "{seen}");
}

/// The same, compiled, with everything at once.
#[test]
fn a_renderer_for_everything_gives_the_same_bits() {
    let plain = tiny::plain().plan();
    let expected = picture(&plain, &plain.structure);
    let mut everything = plain.clone();
    add_black_environment(&mut everything.data);
    everything.structure = with_everything(&plain.structure);
    everything.structure.between = Between {
        media: Some(MediaNode {
            nesting: AnyNesting::Nested,
            matter: MatterNode::AbsorptionAndScattering,
        }),
        dispersion: true,
    };
    // The outside, which is empty.
    let mut outside = Vec::new();
    let record = MediumRecord {
        halvings: [0.0; 3].into(),
        ior: 1.0,
        albedo: [0.0; 3].into(),
        anisotropy: 0.0,
        above: 1,
        around_camera: 0,
    };
    record.append_to(&mut outside);
    *everything.data.buffer_mut(Buffer::Media) = outside;
    let nobody = MaterialUse {
        name: "nobody".to_owned(),
        images: BTreeMap::new(),
        culled: false,
        absorbs: true,
        scatters: true,
        body: true,
    };
    everything.materials = vec![vec![nobody]; everything.structure.programs.len()];
    let none = LightKindUse {
        count: 0,
        sources: vec!["none".to_owned()],
    };
    everything.lights = vec![none; everything.structure.lights.len()];
    let effects = Effects::of(&everything);
    // There is one camera, and one rule for sides.
    let missing = Effect::ALL
        .iter()
        .filter(|effect| effects.reasons(**effect).is_empty());
    let missing: Vec<_> = missing.collect();
    assert_eq!(
        missing,
        [
            &Effect::BackFaceCulling,
            &Effect::LightTree,
            &Effect::DepthOfField,
            &Effect::OrthographicCamera,
            &Effect::PanoramicCamera,
            &Effect::MotionBlur
        ]
    );

    let renderer = residual_driver::compile(&everything, LaneCount::Eight).unwrap();
    let prepared = Prepared::new(&everything, LaneCount::Eight);
    let image = prepared.render(&renderer, &Look::new(SIZE, 8)).image();
    assert_eq!(first_difference(&expected, &image), None);
}
