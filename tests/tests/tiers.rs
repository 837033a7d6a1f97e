//! Interpreted and specialised renderers give the same bits, whatever the lanes, threads and binding times
//! (ARCHITECTURE.md, invariant 1). Every specialised renderer is compiled by cargo, so each scene is compiled once for each lane count.

use std::collections::BTreeSet;

use residual_device_cpu::LaneCount;
use residual_render::film::Film;
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{Binding, Plan, PlanOptions, plan};
use residual_tests::pictures::{first_difference, mean};
use residual_tests::{Look, Parts, Prepared, fixtures, read_scene, scenes, tiny};

/// Neither a multiple of a tile nor of a lane count.
const SIZE: [u32; 2] = [75, 52];

fn planned(scene: &SceneDesc, binding: Binding) -> Plan {
    plan(
        scene,
        &PlanOptions {
            size: SIZE,
            binding,
            ..PlanOptions::default()
        },
    )
    .unwrap()
}

/// Fails unless the film is the expected one, bit for bit.
fn expect_same(what: &str, expected: &Film, film: &Film) {
    let difference = first_difference(&expected.image(), &film.image());
    assert_eq!(difference, None, "{what}");
    assert_eq!(expected.error(), film.error(), "{what}");
}

/// Compares all ways to render a scene; `compiled` lane counts are compiled as well.
fn check(scene: &SceneDesc, samples: u32, compiled: &[LaneCount]) {
    let plan = planned(scene, Binding::Structure);
    let two_threads = Look::new(SIZE, samples);
    let looks = [
        Look {
            threads: 1,
            ..two_threads
        },
        two_threads,
    ];
    let expected = Prepared::new(&plan, LaneCount::One).interpret(&looks[0]);
    assert_eq!(expected.invalid_samples(), 0);
    // What is compared is a picture: black or uniform ones would agree for nothing.
    let shades: BTreeSet<_> = expected
        .image()
        .iter()
        .map(|rgb| rgb.map(f32::to_bits))
        .collect();
    assert!(
        shades.len() > 50 || scene.instances.len() < 2,
        "{}: {} shades",
        scene.name,
        shades.len()
    );
    assert!(mean(&expected.image()).iter().all(|c| *c > 0.0));

    for lanes in LaneCount::ALL {
        let prepared = Prepared::new(&plan, lanes);
        let renderer = compiled
            .contains(&lanes)
            .then(|| residual_driver::compile(&plan, lanes).unwrap());
        for look in looks {
            let what = format!("{}, {lanes} lanes, {} threads", scene.name, look.threads);
            expect_same(
                &format!("{what}, interpreted"),
                &expected,
                &prepared.interpret(&look),
            );
            if let Some(renderer) = &renderer {
                expect_same(
                    &format!("{what}, specialised"),
                    &expected,
                    &prepared.render(renderer, &look),
                );
            }
        }
        // Renderers know no hierarchy: whatever finds the same hits will do.
        if let Some(renderer) = &renderer {
            let what = format!("{}, {lanes} lanes, traced in parts", scene.name);
            let parts = Prepared::with_traversal(&plan, lanes, Parts::new(&plan.data));
            expect_same(
                &format!("{what}, interpreted"),
                &expected,
                &parts.interpret(&two_threads),
            );
            expect_same(
                &format!("{what}, specialised"),
                &expected,
                &parts.render(renderer, &two_threads),
            );
        }
    }
    let constants = planned(scene, Binding::Constants);
    let film = Prepared::new(&constants, LaneCount::Eight).interpret(&two_threads);
    expect_same(&format!("{}, constants", scene.name), &expected, &film);
}

#[test]
#[should_panic(expected = "of 3900 pixels")]
fn another_film_is_noticed() {
    let plan = planned(&fixtures::triangle(), Binding::Structure);
    let prepared = Prepared::new(&plan, LaneCount::Eight);
    let look = Look::new(SIZE, 2);
    expect_same(
        "seeds",
        &prepared.interpret(&look),
        &prepared.interpret(&Look { seed: 1, ..look }),
    );
}

/// In one scene the same code is compiled for more lanes and for fewer; interpreters have all lane counts in every scene.
#[test]
fn room_fixture() {
    let both = [LaneCount::Eight, LaneCount::Sixteen];
    check(&fixtures::room(), 4, &both);
}

#[test]
fn textures_fixture() {
    check(&fixtures::textures(), 4, &[LaneCount::native()]);
}

#[test]
fn lights_fixture() {
    check(&fixtures::lights(), 4, &[LaneCount::native()]);
}

#[test]
fn one_triangle_and_nothing() {
    check(&fixtures::triangle(), 4, &[LaneCount::Eight]);
    check(
        &SceneDesc {
            name: "nothing".to_owned(),
            ..SceneDesc::default()
        },
        2,
        &[LaneCount::Sixteen],
    );
}

/// A scene of the repository.
fn check_shipped(file: &str, compiled: &[LaneCount]) {
    let scenes = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    check(&read_scene(&scenes.join(file), None).unwrap(), 2, compiled);
}

#[test]
fn still_life() {
    check_shipped("textured.gltf", &[LaneCount::native()]);
}

#[test]
fn cornell_box_from_obj() {
    check_shipped("cornell-box.obj", &[LaneCount::native()]);
}

/// A shared scene; compiled, if fixtures and shipped scenes have nothing of its kind.
fn check_shared(file: &str, compiled: &[LaneCount]) {
    let Some(scenes) = scenes() else { return };
    check(&read_scene(&scenes.join(file), None).unwrap(), 2, compiled);
}

#[test]
fn cornell() {
    check_shared("interiors/cornell-generated.glb", &[]);
}

#[test]
fn teapot() {
    check_shared("interiors/teapot-full.glb", &[LaneCount::native()]);
}

#[test]
fn living_room() {
    check_shared(
        "interiors/living-room-grey-white.glb",
        &[LaneCount::native()],
    );
}

#[test]
fn alpha_blend() {
    check_shared("materials/AlphaBlendModeTest/AlphaBlendModeTest.gltf", &[]);
}

#[test]
fn texture_settings() {
    check_shared(
        "materials/TextureSettingsTest/TextureSettingsTest.gltf",
        &[],
    );
}

/// Comparing traversals says little unless alpha and sides both matter, and each triangle is a part of its own.
#[test]
fn textures_have_alpha_and_single_sides() {
    let plan = planned(&fixtures::textures(), Binding::Structure);
    assert!(
        plan.structure
            .programs
            .iter()
            .any(|p| p.alpha_test.is_some())
    );
    assert!(plan.data.single_sided.contains(&true) && plan.data.single_sided.contains(&false));
    assert!(plan.data.triangle_count() <= Parts::MOST);
}

/// An effect that neither a fixture nor a tiny scene, of which `goldens.rs` compiles each, calls for would be compiled by no
/// test.
#[test]
fn test_scenes_call_for_every_effect() {
    let scenes = [fixtures::room(), fixtures::textures(), fixtures::lights()];
    let fixtures = scenes
        .iter()
        .map(|scene| planned(scene, Binding::Structure));
    let tiny = tiny::all().into_iter().map(|tiny| tiny.plan());
    let effects: Vec<_> = fixtures
        .chain(tiny)
        .map(|plan| Effects::of(&plan))
        .collect();
    let missing: Vec<_> = Effect::ALL
        .iter()
        .filter(|effect| effects.iter().all(|e| e.reasons(**effect).is_empty()))
        .collect();
    assert!(missing.is_empty(), "no scene calls for {missing:?}");
}
