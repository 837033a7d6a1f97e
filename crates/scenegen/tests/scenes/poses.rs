//! Morph targets, skins and animations of glTF files, by where their vertices end.

use crate::common::gltf_text::{F32, Gltf, SQUARE, U8, U16, f32_bytes, warns};
use glam::{DAffine3, DQuat, DVec3, Vec3};
use residual_scenegen::desc::SceneDesc;
use residual_scenegen::import::ImportOptions;
use serde_json::{Value, json};

fn at_time(gltf: &Gltf, time_code: Option<f64>) -> SceneDesc {
    gltf.import_with(&ImportOptions {
        time_code,
        ..ImportOptions::default()
    })
    .unwrap()
}

/// World positions of the corners of an instance's triangles, in order.
fn corners(scene: &SceneDesc, instance: usize) -> Vec<Vec3> {
    let instance = &scene.instances[instance];
    let mesh = &scene.meshes[instance.mesh];
    let corners = mesh.triangles.iter().flatten();
    corners
        .map(|&corner| {
            instance
                .transform
                .transform_point3(mesh.positions[corner as usize])
        })
        .collect()
}

fn near(found: &[Vec3], expected: &[Vec3]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.distance(*expected) < 1e-5, "{found} {expected}");
    }
}

/// One triangle of the square's first three corners.
fn triangle() -> Gltf {
    let mut gltf = Gltf::square();
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf
}

fn targets(gltf: &mut Gltf) {
    let mut target = |delta: [f32; 3]| {
        let accessor = gltf.accessor("VEC3", F32, &f32_bytes(&delta.repeat(4)), 4);
        json!({ "POSITION": accessor })
    };
    let targets = json!([target([1.0, 0.0, 0.0]), target([0.0, 2.0, 0.0])]);
    gltf.primitive()["targets"] = targets;
}

#[test]
fn weights_of_morph_targets_are_of_the_node_then_of_the_mesh() {
    let mut gltf = triangle();
    targets(&mut gltf);
    let square = [0, 1, 2].map(|k| Vec3::from(SQUARE[k]));
    let moved = |x: f32, y: f32| square.map(|p| p + Vec3::new(x, y, 0.0)).to_vec();
    near(&corners(&at_time(&gltf, None), 0), &moved(0.0, 0.0));
    gltf.json["meshes"][0]["weights"] = json!([0.5, 0.25]);
    near(&corners(&at_time(&gltf, None), 0), &moved(0.5, 0.5));
    gltf.json["nodes"] = json!([{ "mesh": 0, "weights": [1] }, { "mesh": 0 }, { "mesh": 0 }]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1, 2]);
    let scene = at_time(&gltf, None);
    near(&corners(&scene, 0), &moved(1.0, 0.0));
    near(&corners(&scene, 1), &moved(0.5, 0.5));
    near(&corners(&scene, 2), &moved(0.5, 0.5));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);

    let short = gltf.accessor("VEC3", F32, &f32_bytes(&[0.0; 9]), 3);
    gltf.primitive()["targets"][0] = json!({ "POSITION": short });
    gltf.refused(&["targets/0", "4 vertices"]);
}

/// The triangle's corners follow two joints, by halves, wholly, and by unequal shares.
fn skinned() -> Gltf {
    let mut gltf = triangle();
    gltf.attribute(
        "JOINTS_0",
        "VEC4",
        U8,
        &[0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0],
        4,
    );
    let weights = [
        [0.5, 0.5, 0.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
        // Joint 1 thrice joint 0, of a sum that is not 1.
        [1.5, 0.5, 0.0, 0.0],
        [1.0, 0.0, 0.0, 0.0],
    ];
    gltf.floats("WEIGHTS_0", "VEC4", weights.as_flattened());
    let translation = |t: [f32; 3]| {
        [
            1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., t[0], t[1], t[2], 1.,
        ]
    };
    let matrices = [translation([0.0; 3]), translation([0.0, -1.0, 0.0])];
    let inverse = gltf.accessor("MAT4", F32, &f32_bytes(matrices.as_flattened()), 2);
    gltf.json["skins"] = json!([{ "joints": [1, 2], "inverseBindMatrices": inverse }]);
    gltf.json["nodes"] = json!([
        { "mesh": 0, "skin": 0, "translation": [100, 100, 100] },
        { "children": [2], "translation": [1, 0, 0] },
        // Turned about +Z by 90°.
        { "translation": [0, 1, 0], "rotation": [0, 0, std::f64::consts::FRAC_1_SQRT_2, std::f64::consts::FRAC_1_SQRT_2] },
    ]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1]);
    gltf
}

/// The corners of [`skinned`], joint by joint and by hand.
fn expected(first: DAffine3, second: DAffine3) -> Vec<Vec3> {
    let second = second * DAffine3::from_translation(DVec3::new(0.0, -1.0, 0.0));
    let shares = [[0.5, 0.5], [0.0, 1.0], [0.25, 0.75]];
    (0..3)
        .map(|k| {
            let p = Vec3::from(SQUARE[k]).as_dvec3();
            let moved = first.transform_point3(p) * shares[k][0]
                + second.transform_point3(p) * shares[k][1];
            moved.as_vec3()
        })
        .collect()
}

#[test]
fn skins_carry_vertices_with_their_joints_wherever_the_node_is() {
    let gltf = skinned();
    let scene = at_time(&gltf, None);
    let first = DAffine3::from_translation(DVec3::X);
    let turned = DAffine3::from_rotation_translation(
        DQuat::from_rotation_z(std::f64::consts::FRAC_PI_2),
        DVec3::new(1.0, 1.0, 0.0),
    );
    near(&corners(&scene, 0), &expected(first, turned));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);

    // Joints that there are not, and weights of nothing.
    let mut odd = skinned();
    odd.attribute("JOINTS_0", "VEC4", U16, &[7, 0].repeat(16), 4);
    let scene = at_time(&odd, None);
    assert!(warns(
        &scene,
        "primitives/0",
        "joints that the skin does not have"
    ));
    assert!(warns(&scene, "primitives/0", "follow the first"));
    let mut empty = skinned();
    empty.json["skins"] = json!([{ "joints": [] }]);
    assert!(warns(&at_time(&empty, None), "skins/0", "no joints"));
    let mut short = skinned();
    short.json["skins"][0]["joints"] = json!([1, 2, 1]);
    short.refused(&["skins/0", "fewer inverse bind matrices"]);
}

/// An animation of one node's property, with keys at 1 and 3 seconds.
fn animate(gltf: &mut Gltf, node: usize, path: &str, interpolation: &str, values: &[f32]) {
    let times = gltf.accessor("SCALAR", F32, &f32_bytes(&[1.0, 3.0]), 2);
    let (kind, size) = match path {
        "weights" => ("SCALAR", 1),
        "rotation" => ("VEC4", 4),
        _ => ("VEC3", 3),
    };
    let output = gltf.accessor(kind, F32, &f32_bytes(values), values.len() / size);
    let animation = json!({
        "channels": [{ "sampler": 0, "target": { "node": node, "path": path } }],
        "samplers": [{ "input": times, "output": output, "interpolation": interpolation }],
    });
    if gltf.json.get("animations").is_none() {
        gltf.json["animations"] = json!([]);
    }
    let Value::Array(animations) = &mut gltf.json["animations"] else {
        panic!("a list")
    };
    animations.push(animation);
}

#[test]
fn samplers_interpolate_as_the_specification_says() {
    let place = |interpolation: &str, values: &[f32], time: f64| {
        let mut gltf = triangle();
        animate(&mut gltf, 0, "translation", interpolation, values);
        corners(&at_time(&gltf, Some(time)), 0)[0]
    };
    let [a, b] = [[0.0, 0.0, 0.0], [4.0, 2.0, 0.0]];
    let keys = [a, b].concat();
    for (time, x) in [
        (-5.0, 0.0),
        (1.0, 0.0),
        (1.5, 1.0),
        (2.0, 2.0),
        (3.0, 4.0),
        (9.0, 4.0),
    ] {
        assert_eq!(
            place("LINEAR", &keys, time),
            Vec3::new(x, x / 2.0, 0.0),
            "{time}"
        );
    }
    for (time, x) in [(0.0, 0.0), (2.9, 0.0), (3.0, 4.0)] {
        assert_eq!(place("STEP", &keys, time).x, x, "{time}");
    }
    // Tangents of 1 a second at both ends: the line itself has 2.
    let one = [1.0, 1.0, 1.0];
    let spline = [one, a, one, one, b, one].concat();
    let t = 0.25_f32;
    let exact = 2.0 * (t * t * t - 2.0 * t * t + t)
        + (3.0 * t * t - 2.0 * t * t * t) * 4.0
        + 2.0 * (t * t * t - t * t);
    assert!((place("CUBICSPLINE", &spline, 1.5).x - exact).abs() < 1e-6);

    // The short way round, at an even pace.
    let mut gltf = triangle();
    let half = std::f32::consts::FRAC_1_SQRT_2;
    animate(
        &mut gltf,
        0,
        "rotation",
        "LINEAR",
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, -half, -half],
    );
    let scene = at_time(&gltf, Some(2.0));
    near(&corners(&scene, 0)[1..2], &[Vec3::new(half, half, 0.0)]);

    // Without a time nothing moves, and nobody is warned.
    let scene = at_time(&gltf, None);
    near(&corners(&scene, 0)[1..2], &[Vec3::X]);
    assert!(scene.warnings.is_empty());
    assert!(
        scene
            .dismissed
            .iter()
            .any(|d| d.reason.contains("--time-code"))
    );
    let still = at_time(&triangle(), Some(1.0));
    assert!(warns(&still, "animations", "there are none"));
}

#[test]
fn weights_and_joints_are_animated() {
    let mut gltf = triangle();
    targets(&mut gltf);
    animate(&mut gltf, 0, "weights", "LINEAR", &[0.0, 0.0, 1.0, 0.5]);
    near(
        &corners(&at_time(&gltf, Some(2.0)), 0)[..1],
        &[Vec3::new(0.5, 0.5, 0.0)],
    );
    let mut gltf = skinned();
    animate(
        &mut gltf,
        2,
        "rotation",
        "STEP",
        &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0],
    );
    animate(
        &mut gltf,
        1,
        "translation",
        "STEP",
        &[0.0, 0.0, 0.0, 0.0, 5.0, 0.0],
    );
    // Another animation of the same property is not shown.
    animate(&mut gltf, 1, "translation", "STEP", &[7.0; 6]);
    let scene = at_time(&gltf, Some(3.0));
    let first = DAffine3::from_translation(DVec3::new(0.0, 5.0, 0.0));
    let half_turn = DAffine3::from_rotation_translation(
        DQuat::from_rotation_z(std::f64::consts::PI),
        DVec3::new(0.0, 6.0, 0.0),
    );
    near(&corners(&scene, 0), &expected(first, half_turn));
    assert!(warns(&scene, "animations/2", "another animation"));

    let mut gltf = triangle();
    animate(&mut gltf, 0, "translation", "CUBICSPLINE", &[0.0; 6]);
    let options = ImportOptions {
        time_code: Some(0.0),
        ..ImportOptions::default()
    };
    let message = gltf.import_with(&options).unwrap_err().to_string();
    assert!(
        message.contains("2 values where its keys need 6"),
        "{message}"
    );
}

#[test]
fn one_animation_is_chosen_by_its_name_or_index() {
    let mut gltf = Gltf::square();
    gltf.primitive()["mode"] = json!(6);
    let time = gltf.accessor("SCALAR", F32, &f32_bytes(&[0.0]), 1);
    let moved = |gltf: &mut Gltf, x: f32, name: &str| {
        let output = gltf.accessor("VEC3", F32, &f32_bytes(&[x, 0.0, 0.0]), 1);
        json!({
            "name": name,
            "samplers": [{ "input": time, "output": output }],
            "channels": [
                { "sampler": 0, "target": { "node": 0, "path": "translation" } },
                // It moves nothing, and costs nothing.
                { "sampler": 0, "target": { "path": "translation" } },
            ],
        })
    };
    let walk = moved(&mut gltf, 1.0, "walk");
    let run = moved(&mut gltf, 2.0, "run");
    gltf.json["animations"] = json!([walk, run]);
    let shown = |animation: Option<&str>| {
        gltf.import_with(&ImportOptions {
            animation: animation.map(str::to_owned),
            time_code: Some(0.0),
            ..ImportOptions::default()
        })
    };
    for (animation, x, warnings) in [
        (None, 1.0, 1),
        (Some("run"), 2.0, 0),
        (Some("1"), 2.0, 0),
        (Some("walk"), 1.0, 0),
    ] {
        let scene = shown(animation).unwrap();
        assert_eq!(
            scene.instances[0].transform.translation.x, x,
            "{animation:?}"
        );
        assert_eq!(scene.warnings.len(), warnings, "{:?}", scene.warnings);
    }
    let message = shown(Some("jump")).unwrap_err().to_string();
    for text in ["jump", "0 \"walk\", 1 \"run\"", "--animation"] {
        assert!(message.contains(text), "{message}");
    }
}
