//! What paths meet between surfaces, against closed forms: bodies that absorb, and surfaces that bend wavelengths differently.

use residual_device_cpu::LaneCount;
use residual_render::sampler::AnySampler;
use residual_render::tracer::Between;
use residual_scenegen::desc::{
    Attenuation, EnvironmentDesc, ImageDesc, MetallicRoughness, Projection, SceneDesc, SurfaceDesc,
    Texels,
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
    let options = PlanOptions {
        size: SIZE,
        sampler: AnySampler::Sobol,
        // Normals of vertices are not on the side of all directions that leave a triangle, which loses light.
        flat_normals: true,
        ..PlanOptions::default()
    };
    let plan = plan(scene, &options).unwrap();
    let prepared = Prepared::new(&plan, LaneCount::Eight);
    let film = prepared.interpret(&Look {
        max_depth: 64,
        ..Look::new(SIZE, samples)
    });
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
        let seen = rendered(&scene, 1);
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
        let Between {
            absorption,
            dispersion,
        } = plan.structure.between;
        assert_eq!(has, [absorption, dispersion]);
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
