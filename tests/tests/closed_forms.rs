//! Whole renders whose radiance is known (hard case L-12): the interpreter on the CPU device, hand-made scenes.

use std::ops::ControlFlow;

use residual_bvh::BuildQuality;
use residual_device_cpu::{AnyBvh, CpuDevice, LaneCount, SceneView, Width};
use residual_render::alias_table::AliasEntry;
use residual_render::camera::CameraRecord;
use residual_render::film::Film;
use residual_render::layer::Layers;
use residual_render::light::{AreaRecord, push_light, set_picks};
use residual_render::passes::RenderOptions;
use residual_render::program::{
    BsdfNode, CameraNode, ColorNode, EmissionNode, InputNode, LightNode, Program, SourceNode,
    Structure,
};
use residual_render::sampler::AnySampler;
use residual_render::scene_data::SceneData;
use residual_render::surface::Attributes;
use residual_render::texture::Input;
use residual_render::tracer::{Between, TracerNode};
use residual_render::triangle::TriangleRecord;
use residual_variants::AnyLanes;

type Triangle = [[f32; 3]; 3];

/// A diffuse program, emitting if `emission` is not 0.
fn diffuse(albedo: f32, emission: f32) -> Program {
    let input = |name, value: f32| InputNode {
        name,
        source: SourceNode::Color(ColorNode::Const([value; 3])),
    };
    let emits = EmissionNode {
        radiance: Input(1),
        double_sided: true,
    };
    Program {
        attributes: Attributes::default(),
        inputs: vec![input("albedo", albedo), input("emission", emission)],
        normal: None,
        tangent: None,
        interior: None,
        emission: (emission > 0.0).then_some(emits),
        bsdf: BsdfNode::Diffuse { albedo: Input(0) },
        alpha_test: None,
    }
}

/// Triangles with their programs; those of programs that emit are lights, picked by area.
fn scene(
    triangles: &[(Triangle, u32)],
    programs: Vec<Program>,
    emission: f32,
    camera: CameraRecord,
) -> (Structure, SceneData) {
    let mut data = SceneData::default();
    for &(triangle, program) in triangles {
        data.push(TriangleRecord {
            program,
            ..TriangleRecord::new(triangle)
        });
    }
    data.push(camera);
    data.single_sided = vec![false; triangles.len()];
    let emits = |program: u32| programs[program as usize].emission.is_some();
    let lights: Vec<u32> = (0..triangles.len() as u32)
        .filter(|k| emits(triangles[*k as usize].1))
        .collect();
    for (light, &triangle) in (0..).zip(&lights) {
        data.set_light(triangle as usize, light);
        let record = AreaRecord {
            kind: 0,
            triangle,
            double_sided: 1,
        };
        push_light(&mut data, record);
    }
    // All lights of these scenes have the same area.
    let probability = 1.0 / lights.len() as f32;
    let entry = |alias| AliasEntry {
        threshold: 1.0,
        alias,
        density: probability,
        alias_density: probability,
    };
    set_picks(&mut data, (0..lights.len() as u32).map(entry));
    let emission = ColorNode::Const([emission; 3]);
    let area = LightNode::Area {
        emission,
        attributes: Attributes::default(),
    };
    let structure = Structure {
        programs,
        lights: if lights.is_empty() {
            vec![]
        } else {
            vec![area]
        },
        light_tree: None,
        camera: CameraNode::Perspective,
        sampler: AnySampler::Sobol,
        tracer: TracerNode::default(),
        between: Between::default(),
        layers: Layers::NONE,
    };
    (structure, data)
}

fn render(
    structure: &Structure,
    data: &SceneData,
    lanes: LaneCount,
    samples: u32,
    max_depth: u32,
) -> Film {
    let bvh = AnyBvh::build(data, Width::Native, BuildQuality::Medium);
    let view = SceneView {
        buffers: data.buffers(),
        traversal: &bvh,
    };
    let interpreter = AnyLanes::new(structure.clone(), lanes);
    let device = CpuDevice::new(2).expect("threads");
    let options = RenderOptions {
        size: [16, 16],
        samples: Some(samples),
        time: None,
        max_depth,
        seed: 1,
        ..RenderOptions::default()
    };
    let (film, _) = device.render(
        || &interpreter,
        &view,
        &options,
        |_| ControlFlow::Continue(()),
    );
    assert_eq!(
        (film.samples(), film.invalid_samples()),
        (u64::from(samples), 0)
    );
    film
}

/// The closed cube [−1, 1]³, its front faces inside.
fn cube() -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let corner = |u: f32, v: f32| {
                let mut p = [side; 3];
                (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (u, v);
                p
            };
            let [a, b, c, d] = [
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ];
            triangles.extend(if side < 0.0 {
                [[a, b, c], [a, c, d]]
            } else {
                [[a, c, b], [a, d, c]]
            });
        }
    }
    triangles
}

/// A pinhole whose film is a square of side 2·`half` around the place at `forward` from the eye, its right +X, its top +Y.
fn camera(eye: [f32; 3], half: f32, forward: [f32; 3]) -> CameraRecord {
    CameraRecord {
        eye: eye.into(),
        lens_radius: 0.0,
        right: [half, 0.0, 0.0].into(),
        frame_width: 0.0,
        up: [0.0, half, 0.0].into(),
        frame_height: half,
        forward: forward.into(),
        focus_distance: 0.0,
    }
}

fn inside() -> CameraRecord {
    camera([0.1, 0.2, 0.3], 0.7, [0.0, 0.0, -1.0])
}

#[test]
fn furnace_box_is_a_geometric_series() {
    let (albedo, emission) = (0.7_f32, 0.4_f32);
    let triangles: Vec<_> = cube().into_iter().map(|t| (t, 0)).collect();
    let (structure, data) = scene(
        &triangles,
        vec![diffuse(albedo, emission)],
        emission,
        inside(),
    );
    for depth in [1, 2, 3, 4, 8, 20] {
        let film = render(&structure, &data, LaneCount::native(), 256, depth);
        let exact = f64::from(emission) * (1.0 - f64::from(albedo).powi(depth as i32))
            / (1.0 - f64::from(albedo));
        let mean = film.mean()[0];
        println!("depth {depth}: {mean:.6}, exact {exact:.6}");
        // Standard error of the image's mean, from the pixels.
        let pixels = film.image();
        let n = pixels.len() as f64;
        let spread = pixels
            .iter()
            .map(|p| (f64::from(p[0]) - mean).powi(2))
            .sum::<f64>()
            / (n - 1.0)
            / n;
        assert!(
            (mean - exact).abs() < 4.5 * spread.sqrt() + 1e-5 * exact,
            "depth {depth}: {mean} {exact}"
        );
        assert!(spread.sqrt() < 3e-3 * exact, "{spread}");
    }
}

#[test]
fn lane_counts_render_the_same_furnace() {
    let triangles: Vec<_> = cube().into_iter().map(|t| (t, 0)).collect();
    let (structure, data) = scene(&triangles, vec![diffuse(0.7, 0.4)], 0.4, inside());
    let images = LaneCount::ALL.map(|lanes| render(&structure, &data, lanes, 8, 6).image());
    for image in &images[1..] {
        assert_eq!(image, &images[0]);
    }
}

#[test]
fn triangle_light_over_a_plane_is_lamberts_formula() {
    // A black emitter over a white floor, seen from beside it at one point of the floor.
    let floor: Triangle = [[-50.0, -50.0, 0.0], [50.0, -50.0, 0.0], [0.0, 100.0, 0.0]];
    let lamp: Triangle = [[-0.5, -0.5, 1.0], [0.0, 1.0, 1.3], [0.8, -0.4, 1.1]];
    let at = [0.4_f32, 0.3, 0.0];
    let eye = [3.0_f32, 0.3, 1.0];
    let towards = [0, 1, 2].map(|k| at[k] - eye[k]);
    let camera = camera(eye, 1e-4, towards);
    let programs = vec![diffuse(0.5, 0.0), diffuse(0.0, 3.0)];
    let (structure, data) = scene(&[(floor, 0), (lamp, 1)], programs, 3.0, camera);
    let film = render(&structure, &data, LaneCount::native(), 512, 2);
    let seen = lamp.map(|v| {
        let d = [0, 1, 2].map(|k| f64::from(v[k]) - f64::from(at[k]));
        let length = d.iter().map(|c| c * c).sum::<f64>().sqrt();
        d.map(|c| c / length)
    });
    let edge = |k: usize| {
        let (a, b) = (seen[k], seen[(k + 1) % 3]);
        let n = [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ];
        let sine = n.iter().map(|c| c * c).sum::<f64>().sqrt();
        sine.atan2(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]) * n[2] / sine
    };
    let irradiance = (0..3).map(edge).sum::<f64>().abs() / 2.0 * 3.0;
    let exact = 0.5 / std::f64::consts::PI * irradiance;
    let mean = film.mean()[0];
    println!("{mean} {exact}");
    assert!((mean / exact - 1.0).abs() < 2e-3, "{mean} {exact}");
}

#[test]
fn nothing_is_black() {
    // No triangles; one triangle without light; a box without light.
    let (structure, data) = scene(&[], vec![diffuse(0.5, 0.0)], 0.0, inside());
    assert_eq!(
        render(&structure, &data, LaneCount::native(), 4, 5).mean(),
        [0.0; 3]
    );
    let one: Triangle = [[-2.0, -2.0, -1.0], [2.0, -2.0, -1.0], [0.0, 3.0, -1.0]];
    let (structure, data) = scene(&[(one, 0)], vec![diffuse(0.5, 0.0)], 0.0, inside());
    assert_eq!(
        render(&structure, &data, LaneCount::native(), 4, 5).mean(),
        [0.0; 3]
    );
    let triangles: Vec<_> = cube().into_iter().map(|t| (t, 0)).collect();
    let (structure, data) = scene(&triangles, vec![diffuse(0.9, 0.0)], 0.0, inside());
    assert_eq!(
        render(&structure, &data, LaneCount::native(), 4, 9).mean(),
        [0.0; 3]
    );
}

#[test]
fn one_emitting_triangle_is_seen_at_its_radiance() {
    let one: Triangle = [[-20.0, -20.0, -1.0], [20.0, -20.0, -1.0], [0.0, 30.0, -1.0]];
    let (structure, data) = scene(&[(one, 0)], vec![diffuse(0.5, 2.5)], 2.5, inside());
    let film = render(&structure, &data, LaneCount::native(), 4, 5);
    assert!(film.image().iter().all(|pixel| *pixel == [2.5; 3]));
}
