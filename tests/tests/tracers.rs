//! The tracers beside that of paths: ambient occlusion against its closed form, debug pictures against what is in the
//! scene, and all of them compiled against interpreted.

use residual_bvh::BuildQuality;
use residual_device_cpu::{AnyBvh, LaneCount, Traversal, Width};
use residual_render::film::Film;
use residual_render::layer::{Layer, Layers};
use residual_render::tracer::{AnySharing, CostMap, DebugView, TracerNode};
use residual_scenegen::desc::{MaterialDesc, Projection, SceneDesc};
use residual_scenegen::plan::{Plan, PlanOptions, plan};
use residual_tests::fixtures::{self, Builder, color, material, matte, sheet};
use residual_tests::pictures::first_difference;
use residual_tests::{Look, Prepared, tiny};

const SIZE: [u32; 2] = [32, 24];

fn planned(scene: &SceneDesc, tracer: TracerNode) -> Plan {
    let options = PlanOptions {
        size: SIZE,
        tracer,
        ..PlanOptions::default()
    };
    plan(scene, &options).unwrap()
}

fn render(plan: &Plan, look: &Look) -> Film {
    Prepared::new(plan, LaneCount::native()).interpret(look)
}

/// A floor, and a wall at x = 0 so wide and high that it is a half-plane; seen from above around x = 1, no more than
/// `width` wide.
fn corner(width: f32) -> SceneDesc {
    const FAR: f32 = 1e4;
    let mut b = Builder::new("corner");
    b.add(
        material("matte", matte([0.5; 3])),
        [
            sheet([0.0, 0.0, FAR], [FAR, 0.0, 0.0], [0.0, 0.0, -2.0 * FAR]),
            sheet([0.0, 0.0, FAR], [0.0, 0.0, -2.0 * FAR], [0.0, FAR, 0.0]),
        ],
    );
    let projection = Projection::Orthographic { ymag: width / 2.0 };
    b.camera("above", [1.0, 5.0, 0.01], [1.0, 0.0, 0.0], projection);
    b.finish()
}

/// Directions that go by the cosine are even on the disc below the hemisphere. Those that meet the wall at distance x
/// within the reach r are the segment of the disc beyond x/r.
#[test]
fn ambient_occlusion_in_a_corner_is_a_segment_of_the_disc() {
    let plan = planned(&corner(0.02), TracerNode::AmbientOcclusion);
    assert!(plan.structure.lights.is_empty() && plan.warnings.is_empty());
    for reach in [f64::INFINITY, 4.0, 1.25, 1.05, 0.9] {
        let look = Look {
            reach: (reach as f32).min(f32::MAX),
            ..Look::new(SIZE, 256)
        };
        let film = render(&plan, &look);
        let s = (1.0 / reach).min(1.0);
        let expected = 1.0 - (s.acos() - s * (1.0 - s * s).sqrt()) / std::f64::consts::PI;
        let mean = film.mean()[1];
        // 200,000 samples of a number between 0 and 1, in strata.
        assert!(
            (mean - expected).abs() < 2e-3,
            "reach {reach}: {mean}, not {expected}"
        );
    }
}

#[test]
fn the_guaranteed_error_of_ambient_occlusion_is_not_exceeded() {
    let plan = planned(&corner(0.02), TracerNode::AmbientOcclusion);
    let look = |samples, seed| Look {
        reach: 4.0,
        seed,
        ..Look::new(SIZE, samples)
    };
    let reference = render(&plan, &look(1024, 1000)).image();
    for seed in 0..5 {
        let film = render(&plan, &look(4, seed));
        let squares = film.image().into_iter().zip(&reference);
        let squares = squares.map(|(a, b)| f64::from(a[1] - b[1]).powi(2));
        let mse = squares.sum::<f64>() / reference.len() as f64;
        let bound = film
            .guaranteed_mse()
            .expect("pixels that are sampled twice");
        assert!(mse < bound && bound < 0.25, "{mse}, at most {bound}");
    }
}

#[test]
fn nothing_is_occluded_where_nothing_occludes() {
    let mut b = Builder::new("floor");
    b.add(
        material("matte", matte([0.2; 3])),
        [sheet([-5.0, 0.0, 5.0], [10.0, 0.0, 0.0], [0.0, 0.0, -10.0])],
    );
    let projection = Projection::Perspective { yfov: 1.0 };
    b.camera("aslant", [0.0, 2.0, 4.0], [0.0; 3], projection);
    let plan = planned(&b.finish(), TracerNode::AmbientOcclusion);
    // The sky, which is part of the picture, is open, too; whatever the length of paths.
    for max_depth in [1, 8] {
        let look = Look {
            max_depth,
            ..Look::new(SIZE, 16)
        };
        assert!(
            render(&plan, &look)
                .image()
                .iter()
                .all(|rgb| *rgb == [1.0; 3])
        );
    }
}

/// Two squares side by side that face the camera, at different distances, of two materials; nothing around them.
fn two_squares() -> SceneDesc {
    let mut b = Builder::new("squares");
    let red = material("red", matte([0.8, 0.1, 0.1]));
    // Another structure, so that it is another program.
    let lamp = MaterialDesc {
        emission: color([1.0; 3]),
        ..material("lamp", matte([0.0; 3]))
    };
    b.add(
        red,
        [sheet([-2.0, -1.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0])],
    );
    b.add(
        lamp,
        [sheet([0.0, -1.0, -3.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0])],
    );
    let projection = Projection::Orthographic { ymag: 1.5 };
    b.camera("front", [0.0, 0.0, 2.0], [0.0, 0.0, 0.0], projection);
    b.finish()
}

/// The colour at a place of the film, x to the right and y up, in the scene's units.
fn at(image: &[[f32; 3]], x: f32, y: f32) -> [f32; 3] {
    let [width, height] = SIZE.map(|n| n as f32);
    let column = (x / 3.0 * height + width / 2.0) as usize;
    let row = (height / 2.0 - y / 3.0 * height) as usize;
    image[row * SIZE[0] as usize + column]
}

fn debug(view: DebugView, reach: f32) -> Vec<[f32; 3]> {
    let plan = planned(&two_squares(), TracerNode::Debug(view));
    let look = Look {
        reach,
        ..Look::new(SIZE, 4)
    };
    render(&plan, &look).image()
}

const LEFT: [f32; 2] = [-1.0, 0.3];
const RIGHT: [f32; 2] = [0.6, -0.3];
const BESIDE: [f32; 2] = [1.6, 0.0];

fn views(image: &[[f32; 3]]) -> [[f32; 3]; 3] {
    [LEFT, RIGHT, BESIDE].map(|[x, y]| at(image, x, y))
}

#[test]
fn debug_pictures_show_what_is_there() {
    let [left, right, beside] = views(&debug(DebugView::Normals, 1.0));
    assert_eq!(
        [left, right, beside],
        [[0.5, 0.5, 1.0], [0.5, 0.5, 1.0], [0.0; 3]]
    );

    // The eye is at z = 2.
    let [left, right, beside] = views(&debug(DebugView::Depth, 10.0));
    assert!(
        (left[0] - 0.7).abs() < 1e-5 && (right[0] - 0.5).abs() < 1e-5,
        "{left:?} {right:?}"
    );
    assert_eq!(beside, [0.0; 3]);
    let [left, right, _] = views(&debug(DebugView::Depth, 3.0));
    assert!(
        left[0].abs() < 1e-6 && right == [0.0; 3],
        "{left:?} {right:?}"
    );

    let [left, right, beside] = views(&debug(DebugView::Programs, 1.0));
    assert!(left != right && left != beside && right != beside);
    assert_eq!(beside, [0.0; 3]);

    // u goes to the right; v, from the top, down. Neither material reads them, but they are there.
    let image = debug(DebugView::TextureCoordinates, 1.0);
    let [left, right, beside] = views(&image);
    let pixel = 3.0 / SIZE[1] as f32;
    for ([u, v, b], [x, y], [low, width]) in [(left, LEFT, [-2.0, 2.0]), (right, RIGHT, [0.0, 1.0])]
    {
        let expected = [(x - low) / width, (1.0 - y) / 2.0];
        assert!((u - expected[0]).abs() < pixel / width, "{u} {expected:?}");
        assert!((v - expected[1]).abs() < pixel / 2.0, "{v} {expected:?}");
        assert_eq!(b, 0.0);
    }
    assert_eq!(beside, [0.0; 3]);
}

/// What the picture shows is what the traversal says of the middle of the pixel.
#[test]
fn the_heat_map_is_of_the_visits_of_camera_rays() {
    let plan = planned(&two_squares(), TracerNode::Debug(DebugView::TraversalCost));
    let bvh = AnyBvh::build(&plan.data, Width::Native, BuildQuality::Best);
    let visits = [LEFT, BESIDE].map(|[x, y]| {
        let ray = residual_bvh::Ray::unbounded([x, y, 2.0], [0.0, 0.0, -1.0]);
        let mut visits = [0];
        bvh.visits(&[ray], &mut visits, None);
        visits[0]
    });
    assert!(visits[0] > visits[1] && visits[1] > 0, "{visits:?}");
    let [left, _, beside] = views(&debug(DebugView::TraversalCost, 1.0));
    let close = |a: [f32; 3], b: [f32; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-6);
    assert!(close(left, CostMap.color(visits[0])), "{left:?} {visits:?}");
    assert!(
        close(beside, CostMap.color(visits[1])),
        "{beside:?} {visits:?}"
    );
}

/// Compiled and interpreted renderers give the same bits with every tracer, layers included, and also with `others`
/// lanes, which have hierarchies of other widths.
fn check(scene: &SceneDesc, tracer: TracerNode, layers: Layers, others: &[LaneCount]) {
    let options = PlanOptions {
        size: SIZE,
        tracer,
        layers,
        ..PlanOptions::default()
    };
    let plan = plan(scene, &options).unwrap();
    let look = Look {
        reach: 2.0,
        ..Look::new(SIZE, 4)
    };
    let native = Prepared::new(&plan, LaneCount::native());
    let expected = native.interpret(&look);
    assert_eq!(expected.invalid_samples(), 0);
    let compiled = residual_driver::compile(&plan, LaneCount::native()).unwrap();
    let tiled = Look {
        threads: 1,
        tile_size: Some(8),
        ..look
    };
    let mut films = vec![native.interpret(&tiled), native.render(&compiled, &look)];
    let others = others.iter();
    films.extend(others.map(|&lanes| Prepared::new(&plan, lanes).interpret(&look)));
    for film in films {
        let what = format!("{tracer:?}");
        assert_eq!(
            first_difference(&expected.image(), &film.image()),
            None,
            "{what}"
        );
        for layer in layers.iter() {
            for channel in 0..layer.channels().len() {
                let of = |film: &Film| film.channel(layer, channel).unwrap();
                assert_eq!(of(&expected), of(&film), "{what}, {layer}");
            }
        }
    }
}

/// What is compiled of a tracer that asks little of materials, or shares what it asks with another tracer: alpha, coordinates, light.
fn lamp_with_holes() -> SceneDesc {
    tiny::named("masked_emission").scene
}

#[test]
fn path_tracer_with_layers() {
    check(
        &fixtures::textures(),
        TracerNode::default(),
        Layer::ALL.into_iter().collect(),
        &LaneCount::ALL,
    );
}

#[test]
fn ambient_occlusion() {
    check(
        &lamp_with_holes(),
        TracerNode::AmbientOcclusion,
        Layers::NONE.with(Layer::Normal),
        &LaneCount::ALL,
    );
}

#[test]
fn paths_from_both_ends() {
    check(
        &fixtures::textures(),
        TracerNode::Bidirectional(AnySharing::Combined),
        Layers::NONE.with(Layer::Normal),
        &[LaneCount::Four],
    );
}

#[test]
fn paths_from_lights() {
    check(
        &lamp_with_holes(),
        TracerNode::Bidirectional(AnySharing::LightPathsOnly),
        Layers::NONE,
        &[],
    );
}

#[test]
fn debug_views() {
    let views = [
        (DebugView::TextureCoordinates, &LaneCount::ALL[..]),
        // What traversal costs depends on the hierarchy.
        (DebugView::TraversalCost, &[]),
    ];
    for (view, others) in views {
        let tracer = TracerNode::Debug(view);
        check(&lamp_with_holes(), tracer, Layers::NONE, others);
    }
}
