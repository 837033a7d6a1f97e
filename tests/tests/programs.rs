//! What is compiled depends on the kinds of materials, not on their number nor on their colours.

use residual_device_cpu::LaneCount;
use residual_render::film::Film;
use residual_scenegen::desc::{Filter, MaterialDesc, PunctualKind, SceneDesc, SurfaceDesc, Wrap};
use residual_scenegen::emit::rust;
use residual_scenegen::plan::{Binding, Plan, PlanOptions, plan};
use residual_tests::fixtures::{Builder, material, matte, metallic_roughness, sheet};
use residual_tests::pictures::first_difference;
use residual_tests::{Look, Prepared};

const COUNT: usize = 500;
const SIZE: [u32; 2] = [50, 40];

/// A wall of as many tiles as materials, in turn matte, metal and textured, no two alike.
fn wall() -> SceneDesc {
    let mut b = Builder::new("wall");
    let image = b.bytes(8, 8);
    let texture = b.texture(image, [Wrap::Repeat; 2], Filter::Linear);
    for number in 0..COUNT {
        let shade = 0.1 + 0.8 * number as f32 / COUNT as f32;
        let color = [shade, 0.5, 1.0 - shade];
        let surface = match number % 3 {
            0 => matte(color),
            1 => SurfaceDesc::MetallicRoughness(metallic_roughness(color, 1.0, 0.3 + 0.5 * shade)),
            _ => {
                let mut surface = metallic_roughness(color, 0.0, shade);
                surface.base_color.texture = Some(texture.clone());
                SurfaceDesc::MetallicRoughness(surface)
            }
        };
        let corner = [(number % 25) as f32, (number / 25) as f32, 0.0];
        b.add(
            material(&format!("tile {number}"), surface),
            [sheet(corner, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0])],
        );
    }
    let position = glam::Vec3::new(8.0, 14.0, 6.0);
    b.light(PunctualKind::Point { position }, [300.0; 3]);
    let projection = residual_scenegen::desc::Projection::Orthographic { ymag: 10.0 };
    b.camera("front", [12.5, 10.0, 9.0], [12.5, 10.0, 0.0], projection);
    b.finish()
}

fn planned(scene: &SceneDesc, binding: Binding) -> Plan {
    let options = PlanOptions {
        size: SIZE,
        binding,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

/// The scene with another colour of one material.
fn edited(mut scene: SceneDesc, number: usize) -> SceneDesc {
    let MaterialDesc { surface, .. } = &mut scene.materials[number];
    let color = match surface {
        SurfaceDesc::MetallicRoughness(surface) => &mut surface.base_color,
        SurfaceDesc::Phong(surface) => &mut surface.diffuse,
        other => panic!("no base colour: {other:?}"),
    };
    color.factor = [0.9, 0.8, 0.05];
    scene
}

fn interpreted(plan: &Plan) -> Film {
    Prepared::new(plan, LaneCount::Eight).interpret(&Look::new(SIZE, 4))
}

#[test]
fn five_hundred_materials_of_three_kinds_are_three_programs() {
    let plan = planned(&wall(), Binding::Structure);
    assert_eq!(plan.structure.programs.len(), 3);
    let text = rust::module(&plan, "Eight");
    assert_eq!(text.matches("pub struct Program;").count(), 3);
    assert_eq!(text.matches("\n/// \"tile ").count(), COUNT);
    // The thesis's binding times give each a program of its own: it is not that they are alike.
    let constants = planned(&wall(), Binding::Constants);
    assert_eq!(constants.structure.programs.len(), COUNT);
}

/// A text is compiled once (`residual_driver::compile` knows renderers by their text), so the same text compiles nothing.
#[test]
fn an_edited_colour_compiles_nothing() {
    let scene = wall();
    let plan = planned(&scene, Binding::Structure);
    // Nobody waits for a renderer of hundreds of programs.
    assert!(plan.structure.programs.len() < 10);
    let text = rust::module(&plan, "Eight");
    let renderer = residual_driver::compile(&plan, LaneCount::Eight).unwrap();
    let before = interpreted(&plan).image();
    for number in [0, 1, 2, COUNT - 1] {
        let plan = planned(&edited(scene.clone(), number), Binding::Structure);
        assert!(rust::module(&plan, "Eight") == text, "{number}");
        // The renderer that is there shows the edit.
        let film = Prepared::new(&plan, LaneCount::Eight).render(&renderer, &Look::new(SIZE, 4));
        assert_eq!(
            first_difference(&interpreted(&plan).image(), &film.image()),
            None
        );
        assert!(
            first_difference(&before, &film.image()).is_some(),
            "{number}"
        );
    }
}

/// What removes code is another kind.
#[test]
fn black_is_another_program() {
    let mut scene = wall();
    scene.materials[0].surface = matte([0.0; 3]);
    let plan = planned(&scene, Binding::Structure);
    assert_eq!(plan.structure.programs.len(), 4);
}
