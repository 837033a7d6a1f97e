//! Layers of an image: what they hold is what is in the scene, and radiance does not depend on them.

use residual_device_cpu::LaneCount;
use residual_render::cryptomatte;
use residual_render::film::Film;
use residual_render::layer::{FAR, Layer, Layers};
use residual_scenegen::desc::{Projection, SceneDesc};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::fixtures::{self, Builder, material, matte, sheet};
use residual_tests::pictures::first_difference;
use residual_tests::{Look, Prepared};

const SIZE: [u32; 2] = [40, 30];

fn render(scene: &SceneDesc, layers: Layers, samples: u32) -> Film {
    let options = PlanOptions {
        size: SIZE,
        layers,
        ..PlanOptions::default()
    };
    let plan = plan(scene, &options).unwrap();
    Prepared::new(&plan, LaneCount::native()).interpret(&Look::new(SIZE, samples))
}

fn all() -> Layers {
    Layer::ALL.into_iter().collect()
}

/// A square that faces the camera and one behind it, farther to the right; nothing else.
fn squares() -> SceneDesc {
    let mut b = Builder::new("squares");
    let square = |x: f32, z: f32| sheet([x, -0.5, z], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    b.add(
        material("red", matte([0.75, 0.25, 0.125])),
        [square(-1.5, 0.0)],
    );
    b.add(material("grey", matte([0.5; 3])), [square(0.5, -2.0)]);
    let projection = Projection::Orthographic { ymag: 1.5 };
    b.camera("front", [0.0, 0.0, 4.0], [0.0; 3], projection);
    b.finish()
}

/// The pixel at a place of the film, x to the right and y up, in the scene's units.
fn index([x, y]: [f32; 2]) -> usize {
    let [width, height] = SIZE.map(|n| n as f32);
    let column = (x / 3.0 * height + width / 2.0) as usize;
    let row = (height / 2.0 - y / 3.0 * height) as usize;
    row * SIZE[0] as usize + column
}

const LEFT: [f32; 2] = [-1.05, 0.05];
const RIGHT: [f32; 2] = [1.05, 0.05];
const NOWHERE: [f32; 2] = [0.05, 1.25];

#[test]
fn layers_hold_what_is_there() {
    let film = render(&squares(), all(), 3);
    let values = |layer: Layer, place| -> Vec<f32> {
        (0..layer.channels().len())
            .map(|channel| film.channel(layer, channel).unwrap()[index(place)])
            .collect()
    };
    assert_eq!(values(Layer::Albedo, LEFT), [0.75, 0.25, 0.125]);
    assert_eq!(values(Layer::Albedo, RIGHT), [0.5; 3]);
    assert_eq!(values(Layer::Albedo, NOWHERE), [0.0; 3]);
    for place in [LEFT, RIGHT] {
        assert_eq!(values(Layer::Normal, place), [0.0, 0.0, 1.0]);
    }
    assert_eq!(values(Layer::Normal, NOWHERE), [0.0; 3]);
    assert_eq!(values(Layer::Depth, LEFT), [4.0]);
    assert_eq!(values(Layer::Depth, RIGHT), [6.0]);
    assert_eq!(values(Layer::Depth, NOWHERE), [FAR]);
    let pixel = 3.0 / SIZE[1] as f32;
    for ([x, y], z) in [(LEFT, 0.0), (RIGHT, -2.0)] {
        let found = values(Layer::Position, [x, y]);
        assert!(
            (found[0] - x).abs() <= pixel && (found[1] - y).abs() <= pixel,
            "{found:?}"
        );
        assert_eq!(found[2], z);
    }
    assert_eq!(values(Layer::Position, NOWHERE), [0.0; 3]);
    for place in [LEFT, NOWHERE] {
        assert_eq!(values(Layer::SampleCount, place), [3.0]);
    }
    for layer in [Layer::ObjectIndex, Layer::MaterialIndex] {
        assert_eq!(
            [LEFT, RIGHT, NOWHERE].map(|place| values(layer, place)[0]),
            [1.0, 2.0, 0.0]
        );
    }
}

/// Coverage is the part of a pixel that a surface fills: of an edge through its middle, half; samples lie in strata. What is
/// not covered is nothing's.
#[test]
fn cryptomattes_hold_parts_of_pixels() {
    let samples = 256;
    let film = render(&squares(), all(), samples);
    for (layer, names) in [
        (Layer::CryptoObject, ["node 0", "node 1"]),
        (Layer::CryptoMaterial, ["red", "grey"]),
    ] {
        let channels = film.layer(layer).unwrap();
        let ranks = |place: [f32; 2]| {
            let pixel = index(place);
            [0, 2, 4].map(|k| [channels[k][pixel], channels[k + 1][pixel]])
        };
        let [left, right] = names.map(cryptomatte::id);
        assert_eq!(ranks(LEFT), [[left, 1.0], [0.0; 2], [0.0; 2]]);
        assert_eq!(ranks(RIGHT), [[right, 1.0], [0.0; 2], [0.0; 2]]);
        assert_eq!(
            ranks(NOWHERE),
            [[cryptomatte::NOTHING, 1.0], [0.0; 2], [0.0; 2]]
        );
        for pixel in 0..(SIZE[0] * SIZE[1]) as usize {
            let parts = channels.iter().skip(1).step_by(2);
            let sum: f32 = parts.map(|parts| parts[pixel]).sum();
            assert_eq!(sum, 1.0, "{layer}");
        }
        // Pixels are a tenth wide: the first square, half a tenth to the right, ends in the middle of one.
        let mut moved = squares();
        let first = moved.meshes[0].positions.iter_mut();
        first.for_each(|position| position.x += 0.05);
        let film = render(&moved, all(), samples);
        let channels = film.layer(layer).unwrap();
        let pixel = index([-0.45, 0.05]);
        let mut found = [0, 2].map(|k| [channels[k][pixel], channels[k + 1][pixel]]);
        found.sort_by_key(|[id, _]| *id == cryptomatte::NOTHING);
        assert_eq!(found.map(|[id, _]| id), [left, cryptomatte::NOTHING]);
        for [_, part] in found {
            assert!((part - 0.5).abs() < 0.01, "{part}");
        }
    }
}

/// Names that are the same have one id: their parts are added.
#[test]
fn objects_of_one_name_are_one_in_a_cryptomatte() {
    let mut scene = squares();
    scene.instances[1].name = scene.instances[0].name.clone();
    let film = render(&scene, Layers::NONE.with(Layer::CryptoObject), 4);
    let id = film.channel(Layer::CryptoObject, 0).unwrap();
    assert_eq!(id[index(LEFT)], id[index(RIGHT)]);
    assert_ne!(id[index(LEFT)], id[index(NOWHERE)]);
}

#[test]
fn radiance_does_not_depend_on_layers() {
    for scene in [fixtures::room(), fixtures::textures()] {
        let plain = render(&scene, Layers::NONE, 4);
        let layered = render(&scene, all(), 4);
        assert_eq!(first_difference(&plain.image(), &layered.image()), None);
        assert_eq!(plain.error(), layered.error());
        // Denoisers want no more than this.
        for (layer, range) in [(Layer::Albedo, 0.0..=1.0), (Layer::Normal, -1.0..=1.0)] {
            for channel in 0..3 {
                let values = layered.channel(layer, channel).unwrap();
                assert!(values.iter().all(|value| range.contains(value)), "{layer}");
                assert!(values.iter().any(|value| *value != values[0]), "{layer}");
            }
        }
    }
}
