//! Strategies of sampling agree with one another: light that two can find is found by each alone (L-10).

use residual_device_cpu::{CpuDevice, LaneCount};
use residual_render::domain::Buffer;
use residual_render::film::Film;
use residual_render::layer::{Layer, Layers};
use residual_render::passes::RenderOptions;
use residual_render::program::LightNode;
use residual_render::tracer::{AnyMis, TracerNode};
use residual_scenegen::desc::{
    AlphaMode, Filter, MaterialDesc, MetallicRoughness, Projection, PunctualKind, ScalarInput,
    SceneDesc, SurfaceDesc, Wrap,
};
use residual_scenegen::plan::{LightPicks, LightPlaces, PlanOptions, plan};
use residual_tests::Prepared;
use residual_tests::fixtures::{
    self, Builder, color, material, matte, metallic_roughness, scalar, sheet,
};
use std::ops::ControlFlow;

const SIZE: [u32; 2] = [48, 36];
const SAMPLES: u32 = 1024;

fn render(scene: &SceneDesc, mis: AnyMis, light_picks: LightPicks, seed: u32) -> Film {
    let options = PlanOptions {
        light_picks,
        light_places: LightPlaces::Area,
        ..PlanOptions::default()
    };
    render_with(scene, mis, options, seed)
}

fn render_with(scene: &SceneDesc, mis: AnyMis, options: PlanOptions, seed: u32) -> Film {
    let options = PlanOptions {
        size: SIZE,
        tracer: TracerNode::Path(mis),
        layers: Layers::NONE.with(Layer::StandardError),
        ..options
    };
    let plan = plan(scene, &options).unwrap();
    let prepared = Prepared::new(&plan, LaneCount::native());
    let options = RenderOptions {
        size: SIZE,
        samples: Some(SAMPLES),
        seed,
        ..RenderOptions::default()
    };
    let renderer = prepared.interpreter();
    let go_on = |_: residual_render::passes::Progress<'_>| ControlFlow::Continue(());
    let device = CpuDevice::new(2).unwrap();
    device
        .render(|| &renderer, &prepared.view(), &options, go_on)
        .0
}

/// Mean of the image and its standard error, by channel.
fn mean(film: &Film) -> [[f64; 2]; 3] {
    let mean = film.mean();
    [0, 1, 2].map(|k| {
        let errors = film.channel(Layer::StandardError, k).unwrap();
        let squares: f64 = errors.iter().map(|e| f64::from(*e).powi(2)).sum();
        [mean[k], squares.sqrt() / errors.len() as f64]
    })
}

fn agree(a: &Film, b: &Film, what: &str) {
    for (k, ([a, error_a], [b, error_b])) in mean(a).into_iter().zip(mean(b)).enumerate() {
        let z = (a - b) / error_a.hypot(error_b);
        // 4.5 standard errors, in some thirty comparisons: once in five thousand runs of other seeds.
        assert!(
            z.abs() < 4.5,
            "{what}, channel {k}: {a} and {b}, {z:.1} standard errors"
        );
        assert!(error_a < 0.02 * a, "{what}: {a} is known to {error_a}");
    }
}

/// The scenes have a roof's or a sky's light, points and spots, and glossy surfaces.
fn scenes() -> Vec<(&'static str, SceneDesc)> {
    vec![
        ("room", fixtures::room()),
        ("lights", fixtures::lights()),
        ("lamps with alpha", lamps_with_alpha()),
        ("coated lamp", coated_lamp()),
    ]
}

fn on_a_floor(name: &str) -> Builder {
    let mut b = Builder::new(name);
    b.add(
        material("floor", matte([0.8, 0.7, 0.6])),
        [sheet([-2.0, 0.0, 2.0], [4.0, 0.0, 0.0], [0.0, 0.0, -4.0])],
    );
    b
}

/// From a camera that shows the floor and what is on it.
fn seen(mut b: Builder) -> SceneDesc {
    let lens = Projection::Perspective { yfov: 0.9 };
    b.camera("camera", [0.5, 2.5, 4.5], [0.0, 0.7, 0.0], lens);
    b.finish()
}

/// Lamps of which parts are cut out or let light through, in front of one another, and panes below them.
fn lamps_with_alpha() -> SceneDesc {
    let mut b = on_a_floor("lamps with alpha");
    let image = b.bytes(7, 5);
    let alpha = ScalarInput {
        factor: 1.0,
        texture: Some((b.texture(image, [Wrap::Repeat; 2], Filter::Linear), 3)),
    };
    let lamps = [
        (AlphaMode::Blend, alpha.clone(), 1.5),
        (AlphaMode::Mask(0.5), alpha, 1.7),
        (AlphaMode::Blend, scalar(0.25), 1.9),
        (AlphaMode::Opaque, scalar(0.25), 2.1),
    ];
    for (alpha_mode, alpha, height) in lamps {
        let lamp = MaterialDesc {
            emission: color([3.0, 2.0, 1.0]),
            alpha_mode,
            alpha,
            double_sided: true,
            ..material("lamp", matte([0.5; 3]))
        };
        b.add(
            lamp,
            [sheet(
                [-0.5, height, 0.5],
                [1.0, 0.0, 0.0],
                [0.0, 0.0, -1.0],
            )],
        );
    }
    for height in [0.6, 0.7, 0.8] {
        let pane = MaterialDesc {
            alpha_mode: AlphaMode::Blend,
            alpha: scalar(0.4),
            double_sided: true,
            ..material("pane", matte([0.2, 0.5, 0.8]))
        };
        b.add(
            pane,
            [sheet(
                [-1.0, height, 1.0],
                [1.2, 0.0, 0.0],
                [0.0, 0.0, -2.0],
            )],
        );
    }
    seen(b)
}

/// A lamp whose coat lets through the less, the more it is seen from the side.
fn coated_lamp() -> SceneDesc {
    let mut b = on_a_floor("coated lamp");
    let coated = MetallicRoughness {
        clearcoat: scalar(0.9),
        clearcoat_roughness: scalar(0.3),
        ..metallic_roughness([0.5; 3], 0.0, 0.5)
    };
    let lamp = MaterialDesc {
        emission: color([3.0, 2.0, 1.0]),
        ..material("lamp", SurfaceDesc::MetallicRoughness(coated))
    };
    b.add(
        lamp,
        [sheet([-1.0, 0.1, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0])],
    );
    seen(b)
}

#[test]
fn weights_of_all_kinds_give_one_image() {
    for (name, scene) in scenes() {
        let power = render(&scene, AnyMis::PowerHeuristic, LightPicks::Mixed, 1);
        let others = [
            AnyMis::BalanceHeuristic,
            AnyMis::LightsOnly,
            AnyMis::BsdfOnly,
        ];
        for (seed, mis) in (2..).zip(others) {
            let other = render(&scene, mis, LightPicks::Mixed, seed);
            agree(&power, &other, &format!("{name}, {mis:?}"));
        }
    }
}

/// The probability of a light that a path has met is that with which it is picked.
#[test]
fn weights_of_all_kinds_give_one_image_by_a_tree() {
    for (name, scene) in scenes() {
        let alone = render(&scene, AnyMis::LightsOnly, LightPicks::Mixed, 9);
        for (seed, mis) in (10..).zip([AnyMis::PowerHeuristic, AnyMis::BalanceHeuristic]) {
            let tree = render(&scene, mis, LightPicks::Tree, seed);
            agree(&alone, &tree, &format!("{name}, {mis:?}, by a tree"));
        }
    }
}

#[test]
fn lights_may_be_picked_in_any_way() {
    for (name, scene) in scenes() {
        let mixed = render(&scene, AnyMis::LightsOnly, LightPicks::Mixed, 5);
        for (seed, picks) in (6..).zip([LightPicks::Power, LightPicks::Uniform, LightPicks::Tree]) {
            let other = render(&scene, AnyMis::LightsOnly, picks, seed);
            agree(&mixed, &other, &format!("{name}, {picks:?}"));
        }
    }
}

/// Panels that nearly touch the walls and the floor of a corner.
fn beside_panels(distance: f32) -> SceneDesc {
    let mut b = Builder::new("panels");
    let sheets = [
        sheet([-2.0, 0.0, 2.0], [4.0, 0.0, 0.0], [0.0, 0.0, -4.0]),
        sheet([-2.0, 0.0, -2.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]),
    ];
    b.add(material("walls", matte([0.8, 0.7, 0.6])), sheets);
    let panel = MaterialDesc {
        emission: color([3.0, 2.0, 1.0]),
        double_sided: true,
        ..material("panel", matte([0.5; 3]))
    };
    let low = sheet([-1.0, distance, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]);
    let high = sheet(
        [-1.0, 1.0, distance - 2.0],
        [2.0, 0.0, 0.0],
        [0.0, 2.0, 0.0],
    );
    b.add(panel, [low, high]);
    let lens = Projection::Perspective { yfov: 0.9 };
    b.camera("camera", [0.5, 2.5, 5.5], [0.0, 1.0, 0.0], lens);
    b.finish()
}

/// What is sampled by solid angle, and the density of what paths meet, belong together.
#[test]
fn places_by_area_and_by_solid_angle_give_one_image() {
    let mut scenes = scenes();
    // What its lamp sends through glass and off mirrors is found too rarely for the stated error to be known.
    scenes.retain(|(name, _)| *name != "lights");
    scenes.push(("panels", beside_panels(0.05)));
    for (name, scene) in scenes {
        let by_area = render(&scene, AnyMis::PowerHeuristic, LightPicks::Mixed, 20);
        let others = [
            (AnyMis::PowerHeuristic, LightPicks::Mixed),
            (AnyMis::BalanceHeuristic, LightPicks::Tree),
            (AnyMis::LightsOnly, LightPicks::Mixed),
        ];
        for (seed, (mis, light_picks)) in (21..).zip(others) {
            let options = PlanOptions {
                light_picks,
                light_places: LightPlaces::SolidAngle,
                ..PlanOptions::default()
            };
            let other = render_with(&scene, mis, options, seed);
            agree(
                &by_area,
                &other,
                &format!("{name}, {mis:?}, by solid angle"),
            );
        }
    }
}

#[test]
fn triangles_are_sampled_by_solid_angle_where_it_pays() {
    let by_solid_angle = |scene: &SceneDesc, light_places| {
        let options = PlanOptions {
            light_places,
            ..PlanOptions::default()
        };
        let plan = plan(scene, &options).unwrap();
        let lights = plan.structure.lights.iter();
        lights
            .filter(|light| matches!(light, LightNode::AreaBySolidAngle { .. }))
            .count()
    };
    let near = beside_panels(0.05);
    assert_eq!(by_solid_angle(&near, LightPlaces::Auto), 1);
    assert_eq!(by_solid_angle(&near, LightPlaces::Area), 0);
    let mut far = near;
    // Behind the meshes of floor and wall are those of the panels.
    for position in far.meshes[2..]
        .iter_mut()
        .flat_map(|mesh| &mut mesh.positions)
    {
        position.y += 40.0;
    }
    assert_eq!(by_solid_angle(&far, LightPlaces::Auto), 0);
    assert_eq!(by_solid_angle(&far, LightPlaces::SolidAngle), 1);
    let points = under_lamps([[0.0, 1.0, 0.0]]);
    assert_eq!(by_solid_angle(&points, LightPlaces::SolidAngle), 0);
}

/// A floor under lamps at these places.
fn under_lamps(places: impl IntoIterator<Item = [f32; 3]>) -> SceneDesc {
    let mut b = Builder::new("lamps");
    let corner = [-5.0, 0.0, 5.0];
    b.add(
        material("floor", matte([0.8; 3])),
        [sheet(corner, [10.0, 0.0, 0.0], [0.0, 0.0, -10.0])],
    );
    for place in places {
        let position = place.into();
        b.light(PunctualKind::Point { position }, [1.0; 3]);
    }
    b.camera(
        "camera",
        [0.5, 2.5, 4.5],
        [0.0, 0.7, 0.0],
        Projection::Perspective { yfov: 0.9 },
    );
    b.finish()
}

#[test]
fn a_tree_is_where_it_pays() {
    let levels = |scene: &SceneDesc| {
        let plan = plan(scene, &PlanOptions::default()).unwrap();
        assert_eq!(
            plan.data.buffer(Buffer::LightTree).is_empty(),
            plan.structure.light_tree.is_none()
        );
        plan.structure.light_tree.map(|tree| tree.levels)
    };
    let spread = |count: u16| {
        let places = (0..count).map(|k| [f32::from(k % 4), 0.3, f32::from(k / 4)]);
        under_lamps(places.map(|[x, y, z]| [2.5 * x - 4.0, y, 2.5 * z - 4.0]))
    };
    assert!(levels(&spread(16)).is_some_and(|levels| (4..=8).contains(&levels)));
    assert_eq!(levels(&spread(7)), None, "there are few");
    let together = under_lamps((0..16_u8).map(|k| [0.01 * f32::from(k), 4.0, 0.0]));
    assert_eq!(levels(&together), None, "they shine alike");
    assert!(levels(&under_lamps((0..2000).map(|_| [0.0, 4.0, 0.0]))).is_some());
    for (name, scene) in scenes() {
        assert_eq!(levels(&scene), None, "{name}");
    }
}
