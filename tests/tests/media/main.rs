//! What paths meet between surfaces, against closed forms: bodies that absorb, and surfaces that bend wavelengths differently.

mod camera;

use residual_device_cpu::LaneCount;
use residual_render::sampler::AnySampler;
use residual_render::tracer::{AnyMis, Between, MAX_DEPTH, TracerNode};
use residual_scenegen::desc::{
    Attenuation, EnvironmentDesc, ImageDesc, MetallicRoughness, Projection, Scattering, SceneDesc,
    SurfaceDesc, Texels,
};
use residual_scenegen::effects::{Effect, Effects};
use residual_scenegen::plan::{PlanOptions, plan};
use residual_tests::fixtures::{Builder, glass, material, metallic_roughness, sheet, sphere};
use residual_tests::pictures::mean;
use residual_tests::{Look, Prepared};

const SIZE: [u32; 2] = [16, 16];

/// A surface's meshes under a white sky of radiance 1, seen along −z by parallel rays.
fn under_white_sky(
    surfaces: Vec<(MetallicRoughness, Vec<residual_scenegen::desc::MeshDesc>)>,
) -> SceneDesc {
    let mut b = Builder::new("body");
    for (surface, meshes) in surfaces {
        let mut body = material("body", SurfaceDesc::MetallicRoughness(surface));
        body.double_sided = false;
        b.add(body, meshes);
    }
    b.camera(
        "front",
        [0.0, 0.0, 5.0],
        [0.0; 3],
        Projection::Orthographic { ymag: 0.3 },
    );
    let mut scene = b.finish();
    scene.images.push(ImageDesc {
        name: "white".to_owned(),
        width: 1,
        height: 1,
        texels: Texels::RgbaF32(vec![[1.0; 4]]),
    });
    scene.environment = Some(EnvironmentDesc {
        image: scene.images.len() - 1,
        strength: 1.0,
        rotation: 0.0,
    });
    scene
}

/// A box between two corners, its front faces outside.
fn cuboid([x, y, z]: [f32; 3], [w, h, d]: [f32; 3]) -> Vec<residual_scenegen::desc::MeshDesc> {
    vec![
        sheet([x, y, z + d], [w, 0.0, 0.0], [0.0, h, 0.0]),
        sheet([x, y, z], [0.0, h, 0.0], [w, 0.0, 0.0]),
        sheet([x, y, z], [0.0, 0.0, d], [0.0, h, 0.0]),
        sheet([x + w, y, z], [0.0, h, 0.0], [0.0, 0.0, d]),
        sheet([x, y, z], [w, 0.0, 0.0], [0.0, 0.0, d]),
        sheet([x, y + h, z], [0.0, 0.0, d], [w, 0.0, 0.0]),
    ]
}

fn rendered(scene: &SceneDesc, samples: u32) -> [f64; 3] {
    rendered_with(scene, |look| look.samples = samples)
}

/// With a sample a pixel, unless the change says otherwise.
fn rendered_with(scene: &SceneDesc, change: impl FnOnce(&mut Look)) -> [f64; 3] {
    let options = PlanOptions {
        size: SIZE,
        sampler: AnySampler::Sobol,
        // Normals of vertices are not on the side of all directions that leave a triangle, which loses light.
        flat_normals: true,
        ..PlanOptions::default()
    };
    let plan = plan(scene, &options).unwrap();
    let prepared = Prepared::new(&plan, LaneCount::Eight);
    let mut look = Look::new(SIZE, 1);
    look.max_depth = MAX_DEPTH;
    change(&mut look);
    let film = prepared.interpret(&look);
    assert_eq!(film.invalid_samples(), 0);
    mean(&film.image())
}

fn body(ior: f32, attenuation: Option<Attenuation>) -> MetallicRoughness {
    MetallicRoughness {
        ior,
        attenuation,
        ..MetallicRoughness {
            transmission: glass(true).transmission,
            solid: true,
            ..metallic_roughness([1.0; 3], 0.0, 0.0)
        }
    }
}

const TEA: Attenuation = Attenuation {
    color: [0.9, 0.5, 0.1],
    distance: 0.5,
};

fn assert_near(name: &str, seen: [f64; 3], expected: [f64; 3], tolerance: f64) {
    for k in 0..3 {
        assert!(
            (seen[k] - expected[k]).abs() <= tolerance,
            "{name}: {seen:?} instead of {expected:?}"
        );
    }
}

/// Beer's law: a body that bends no light lets through what its thickness leaves.
#[test]
fn bodies_absorb_by_their_thickness() {
    for thickness in [0.125_f32, 0.5, 2.0] {
        let corner = [-0.5, -0.5, -0.5 * thickness];
        let cube = cuboid(corner, [1.0, 1.0, thickness]);
        let scene = under_white_sky(vec![(body(1.0, Some(TEA)), cube)]);
        let expected = TEA
            .color
            .map(|c| f64::from(c).powf(f64::from(thickness) / 0.5));
        // Nothing but roulette would be noisy.
        let seen = rendered_with(&scene, |look| look.roulette_from = u32::MAX);
        assert_near(&format!("thickness {thickness}"), seen, expected, 1e-5);
    }
}

/// What stands in a body is seen through what is before it, and a second body has its own colour.
#[test]
fn bodies_are_told_apart() {
    let wine = Attenuation {
        color: [0.3, 0.2, 0.8],
        distance: 1.0,
    };
    let first = cuboid([-0.5, -0.5, 0.5], [1.0, 1.0, 0.25]);
    let second = cuboid([-0.5, -0.5, -0.5], [1.0, 1.0, 0.75]);
    let scene = under_white_sky(vec![
        (body(1.0, Some(TEA)), first),
        (body(1.0, Some(wine)), second),
        (body(1.0, None), cuboid([-0.5, -0.5, -2.0], [1.0, 1.0, 1.0])),
    ]);
    let expected = [0, 1, 2]
        .map(|k: usize| f64::from(TEA.color[k]).powf(0.5) * f64::from(wine.color[k]).powf(0.75));
    // Roulette ends some of these paths.
    assert_near("two bodies", rendered(&scene, 1024), expected, 3e-3);
}

/// A white furnace: whatever wavelengths do in a body that absorbs nothing, all of them together are white.
#[test]
fn dispersion_keeps_white_white() {
    let surface = MetallicRoughness {
        dispersion: 5.0,
        ..body(1.5, None)
    };
    let scene = under_white_sky(vec![(surface, vec![sphere([0.0; 3], 0.6)])]);
    assert_near("furnace", rendered(&scene, 1024), [1.0; 3], 6e-3);
}

/// A white furnace: rough glass that absorbs nothing gives back all light, however often it goes around in a ball.
#[test]
fn rough_glass_keeps_white_white() {
    for roughness in [0.2, 0.5, 1.0] {
        for ior in [1.33, 1.5, 2.0] {
            let surface = MetallicRoughness {
                roughness: residual_tests::fixtures::scalar(roughness),
                ..body(ior, None)
            };
            let scene = under_white_sky(vec![(surface, vec![sphere([0.0; 3], 0.6)])]);
            let seen = rendered(&scene, 1024);
            println!("roughness {roughness}, index {ior}: {seen:?}");
            assert_near(&format!("{roughness}, {ior}"), seen, [1.0; 3], 6e-3);
        }
    }
}

#[test]
fn only_scenes_that_call_for_it_have_it() {
    let effects = |surface| {
        let scene = under_white_sky(vec![(surface, vec![sphere([0.0; 3], 0.6)])]);
        let plan = plan(&scene, &PlanOptions::default()).unwrap();
        let effects = Effects::of(&plan);
        let has = [Effect::Absorption, Effect::Dispersion].map(|effect| effects.has(effect));
        let Between { media, dispersion } = plan.structure.between;
        assert_eq!(has, [media.is_some(), dispersion]);
        assert!(!effects.has(Effect::ScatteringMedia) && !effects.has(Effect::NestedBodies));
        has
    };
    let dispersive = |surface| MetallicRoughness {
        dispersion: 0.5,
        ..surface
    };
    assert_eq!(effects(body(1.5, None)), [false, false]);
    assert_eq!(effects(body(1.5, Some(TEA))), [true, false]);
    assert_eq!(effects(dispersive(body(1.5, None))), [false, true]);
    assert_eq!(effects(dispersive(body(1.5, Some(TEA)))), [true, true]);
    // What is not transparent absorbs nothing that is seen, and bends nothing.
    let opaque = MetallicRoughness {
        transmission: residual_tests::fixtures::scalar(0.0),
        ..dispersive(body(1.5, Some(TEA)))
    };
    assert_eq!(effects(opaque), [false, false]);
}

const WINE: Attenuation = Attenuation {
    color: [0.3, 0.2, 0.8],
    distance: 1.0,
};

/// What is left of white light after lengths of what absorbs, and a body.
fn after(lengths: [(Attenuation, f64); 2]) -> [f64; 3] {
    [0, 1, 2].map(|k: usize| {
        let left = |(attenuation, length): (Attenuation, f64)| {
            f64::from(attenuation.color[k]).powf(length / f64::from(attenuation.distance))
        };
        lengths.map(left).iter().product()
    })
}

/// A body within another is itself, and the other is around it.
#[test]
fn bodies_within_others_are_what_is_there() {
    let outer = cuboid([-0.5, -0.5, -0.5], [1.0, 1.0, 1.0]);
    let inner = cuboid([-0.4, -0.4, -0.25], [0.8, 0.8, 0.5]);
    let scene = under_white_sky(vec![
        (body(1.0, Some(TEA)), outer.clone()),
        (body(1.0, Some(WINE)), inner.clone()),
    ]);
    let expected = after([(TEA, 0.5), (WINE, 0.5)]);
    assert_near("within", rendered(&scene, 1024), expected, 3e-3);
    // A bubble: nothing within.
    let scene = under_white_sky(vec![
        (body(1.0, Some(TEA)), outer),
        (body(1.0, None), inner),
    ]);
    let expected = after([(TEA, 0.5), (WINE, 0.0)]);
    assert_near("bubble", rendered(&scene, 1024), expected, 3e-3);
}

/// Where two bodies overlap, the priority decides, not the side that is entered first.
#[test]
fn of_bodies_that_overlap_the_one_of_the_higher_priority_is_there() {
    let near = cuboid([-0.5, -0.5, 0.0], [1.0, 1.0, 1.0]);
    let far = cuboid([-0.5, -0.5, -0.75], [1.0, 1.0, 1.0]);
    let with = |priority, attenuation| MetallicRoughness {
        priority,
        ..body(1.0, Some(attenuation))
    };
    for (tea, wine, lengths) in [
        (1, 0, [1.0, 0.75]),
        (-2, -1, [0.75, 1.0]),
        // The one that was entered last.
        (0, 0, [0.75, 1.0]),
    ] {
        let scene = under_white_sky(vec![
            (with(tea, TEA), near.clone()),
            (with(wine, WINE), far.clone()),
        ]);
        let expected = after([(TEA, lengths[0]), (WINE, lengths[1])]);
        let name = format!("priorities {tea} and {wine}");
        assert_near(&name, rendered(&scene, 1024), expected, 3e-3);
    }
}

/// Light that enters a body at an angle, and one of another index within it, as Fresnel and Snell say for each of the four
/// surfaces: what is reflected of it comes from a black sky.
#[test]
fn bodies_within_others_bend_light_by_what_is_around_them() {
    // A body of the index of what is around it is not seen, but for its ratio of 1.001.
    let lens = |ior: f32, inner: Option<f32>| {
        let mut bodies = vec![(body(ior, Some(TEA)), vec![sphere([0.0; 3], 0.6)])];
        let inner = inner.map(|ior| (body(ior, Some(TEA)), vec![sphere([0.1, 0.0, 0.1], 0.3)]));
        bodies.extend(inner);
        let mut scene = under_white_sky(bodies);
        // Light from above only, so that it matters where rays go.
        let sky = scene.environment.as_ref().unwrap().image;
        scene.images[sky].height = 2;
        scene.images[sky].texels = Texels::RgbaF32(vec![[2.0; 4], [0.25; 4]]);
        rendered(&scene, 4096)
    };
    let alone = lens(1.5, None);
    assert_near("same", lens(1.5, Some(1.5)), alone, 4e-3);
    let other = lens(1.5, Some(1.0));
    assert!((other[0] - alone[0]).abs() > 0.02, "{other:?} {alone:?}");
}

fn milky(color: [f32; 3], anisotropy: f32, ior: f32) -> MetallicRoughness {
    MetallicRoughness {
        scattering: Some(Scattering {
            multiscatter_color: color,
            anisotropy,
        }),
        ..body(
            ior,
            Some(Attenuation {
                color: [0.5, 0.1, 0.9],
                distance: 0.1,
            }),
        )
    }
}

/// A white furnace: what is scattered and not absorbed is all there, whatever way it took.
#[test]
fn white_bodies_scatter_all_light() {
    for (ior, anisotropy) in [(1.0, 0.0), (1.0, 0.8), (1.0, -0.6), (1.4, 0.3)] {
        let ball = vec![sphere([0.0; 3], 0.6)];
        let scene = under_white_sky(vec![(milky([1.0; 3], anisotropy, ior), ball)]);
        let seen = rendered(&scene, 256);
        // Paths of 1,023 vertices end there.
        assert_near(&format!("{ior} {anisotropy}"), seen, [1.0; 3], 2e-2);
    }
}

/// Chandrasekhar's H of isotropic scattering (1960, "Radiative transfer", chapter 5), by iteration of its integral equation.
fn h(albedo: f64, mu: f64) -> f64 {
    const STEPS: usize = 400;
    let node = |i: usize| (i as f64 + 0.5) / STEPS as f64;
    let mut values = vec![1.0; STEPS];
    let inverse = |values: &[f64], mu: f64| {
        let sum: f64 = (0..STEPS)
            .map(|i| values[i] * node(i) / (mu + node(i)))
            .sum();
        (1.0 - albedo).sqrt() + 0.5 * albedo * sum / STEPS as f64
    };
    for _ in 0..200 {
        let next: Vec<_> = (0..STEPS)
            .map(|i| 1.0 / inverse(&values, node(i)))
            .collect();
        values = next;
    }
    1.0 / inverse(&values, mu)
}

/// A thick layer under a white sky, seen from above: what it reflects of it has a closed form, 1 − H(1)·√(1 − albedo).
#[test]
fn thick_layers_reflect_what_chandrasekhar_says() {
    let colors = [0.2_f32, 0.5, 0.8];
    let surface = MetallicRoughness {
        attenuation: Some(Attenuation {
            // Mean free paths of 1/400 of the block, so that no light comes from its sides.
            color: [1e-5; 3],
            distance: 0.05,
        }),
        ..milky(colors, 0.0, 1.0)
    };
    let block = cuboid([-1.0, -1.0, -2.0], [2.0, 2.0, 2.0]);
    let scene = under_white_sky(vec![(surface, block)]);
    let seen = rendered(&scene, 1024);
    // KHR_materials_volume_scatter's albedo of single scattering.
    let albedo = colors.map(|c| {
        let c = f64::from(c);
        let s = 4.09712 + 4.20863 * c - (9.59217 + 41.6808 * c + 17.7126 * c * c).sqrt();
        1.0 - s * s
    });
    let expected = albedo.map(|albedo| 1.0 - h(albedo, 1.0) * (1.0 - albedo).sqrt());
    assert_near("layer", seen, expected, 4e-3);
}

/// A lamp in fog is found by shadow rays and by scattered paths: both alone give the same image.
#[test]
fn lamps_in_fog_are_found_in_both_ways() {
    let fog = MetallicRoughness {
        attenuation: Some(Attenuation {
            color: [0.2, 0.4, 0.6],
            distance: 1.0,
        }),
        ..milky([0.8, 0.7, 0.6], 0.5, 1.0)
    };
    let mut b = Builder::new("fog");
    let mut cloud = material("fog", SurfaceDesc::MetallicRoughness(fog));
    cloud.double_sided = false;
    b.add(cloud, cuboid([-1.0, -1.0, -1.0], [2.0, 2.0, 2.0]));
    let mut lamp = material("lamp", SurfaceDesc::Unlit);
    lamp.emission.factor = [1.0; 3];
    b.add(lamp, [sphere([0.3, 0.2, 0.0], 0.25)]);
    b.camera(
        "front",
        [0.0, 0.0, 5.0],
        [0.0; 3],
        Projection::Orthographic { ymag: 0.5 },
    );
    let scene = b.finish();
    let seen = [AnyMis::PowerHeuristic, AnyMis::BsdfOnly, AnyMis::LightsOnly].map(|mis| {
        let options = PlanOptions {
            size: SIZE,
            tracer: TracerNode::Path(mis),
            ..PlanOptions::default()
        };
        let plan = plan(&scene, &options).unwrap();
        let film = Prepared::new(&plan, LaneCount::Eight).interpret(&Look {
            max_depth: 64,
            ..Look::new(SIZE, 1024)
        });
        mean(&film.image())
    });
    assert_near("BSDF samples", seen[1], seen[0], 4e-3);
    assert_near("light samples", seen[2], seen[0], 4e-3);
    assert!(seen[0][0] > 0.1, "{seen:?}");
}
