//! EXT_lights_area: rectangles and discs that shine.

use crate::common::gltf_text::{F32, Gltf, U8, f32_bytes, warns};
use glam::{Vec3, Vec3A};
use residual_scenegen::desc::{Dismissed, MeshDesc, SceneDesc};
use residual_scenegen::import::ImportOptions;
use serde_json::{Value, json};

fn node(light: usize) -> Value {
    json!({ "extensions": { "EXT_lights_area": { "light": light } } })
}

/// A file of these lights, on these nodes.
fn file(lights: &Value, nodes: &Value) -> Gltf {
    let mut gltf = Gltf::square();
    gltf.json["extensionsRequired"] = json!(["EXT_lights_area"]);
    gltf.json["extensions"] = json!({ "EXT_lights_area": { "lights": lights } });
    gltf.json["scenes"][0]["nodes"] =
        json!((0..nodes.as_array().unwrap().len()).collect::<Vec<_>>());
    gltf.json["nodes"] = nodes.clone();
    gltf
}

fn mesh(scene: &SceneDesc, instance: usize) -> &MeshDesc {
    &scene.meshes[scene.instances[instance].mesh]
}

/// Sum of the triangles' areas times their normals, in the world.
fn vector_area(scene: &SceneDesc, instance: usize) -> Vec3A {
    let placed = &scene.instances[instance];
    let mesh = &scene.meshes[placed.mesh];
    let area = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| {
            placed
                .transform
                .transform_point3a(mesh.positions[corner as usize].into())
        });
        0.5 * (b - a).cross(c - a)
    };
    mesh.triangles.iter().map(area).sum()
}

#[test]
fn rectangles_and_discs_shine_along_minus_z_from_their_front() {
    let lights = json!([
        { "name": "window", "type": "rect", "size": 2, "rect": { "aspect": 1.5 }, "intensity": 10,
          "color": [1, 0.5, 0] },
        { "type": "disk", "size": 3, "intensity": 4 },
        { "type": "rect" },
    ]);
    let scene = file(&lights, &json!([node(0), node(1), node(2)]))
        .import()
        .unwrap();
    assert!(warns(&scene, "extensionsUsed", "draft"));
    assert_eq!(
        scene
            .warnings
            .iter()
            .filter(|warning| warning.message.contains("draft"))
            .count(),
        1
    );
    let areas = [6.0, std::f32::consts::PI * 2.25, 1.0];
    let radiances = [[10.0, 5.0, 0.0], [4.0; 3], [1000.0; 3]];
    for (instance, (area, radiance)) in areas.into_iter().zip(radiances).enumerate() {
        let found = vector_area(&scene, instance);
        assert!(
            (found - Vec3A::NEG_Z * area).length() < 1e-5 * area,
            "{found}"
        );
        let mesh = mesh(&scene, instance);
        assert!(mesh.normals.iter().all(|&normal| normal == Vec3::NEG_Z));
        let material = &scene.materials[mesh.material];
        assert_eq!(material.emission.factor, radiance);
        assert!(!material.double_sided);
    }
    let [window, disc] = [mesh(&scene, 0), mesh(&scene, 1)];
    assert_eq!(window.name, "window");
    let widest = |mesh: &MeshDesc| mesh.positions.iter().copied().fold(Vec3::ZERO, Vec3::max);
    assert_eq!(
        widest(window),
        Vec3::new(1.5, 1.0, 0.0),
        "the aspect is width over height"
    );
    let reach = disc
        .positions
        .iter()
        .map(|corner| corner.length())
        .fold(0.0, f32::max);
    assert!((reach - 1.5).abs() < 2e-3, "{reach}");
}

/// By the largest of their nodes' scales, whatever mirrors and shears there are.
#[test]
fn their_scale_is_uniform_and_positive() {
    let mut flat = node(0);
    flat["scale"] = json!([1, -3, 2]);
    flat["translation"] = json!([5, 6, 7]);
    let mut turned = node(0);
    // About +Y by 90°: −Z becomes −X.
    turned["rotation"] = json!([0, 0.707_106_77, 0, 0.707_106_77]);
    let mut sheared = node(0);
    sheared["matrix"] = json!([1, 0, 0, 0, 1, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]);
    let scene = file(
        &json!([{ "type": "rect", "rect": { "aspect": 2 } }]),
        &json!([flat, turned, sheared]),
    );
    let scene = scene.import().unwrap();
    assert_eq!(scene.meshes.len(), 1, "all share the light's mesh");
    for (instance, expected) in [
        (0, Vec3A::new(0.0, 0.0, -18.0)),
        (1, Vec3A::new(-2.0, 0.0, 0.0)),
        // √2 is the length of the longest axis, squared for an area.
        (2, Vec3A::new(0.0, 0.0, 4.0)),
    ] {
        let found = vector_area(&scene, instance);
        assert!((found - expected).length() < 1e-5, "{found}");
    }
    // A scale of 0 leaves the other axes, of which the third follows.
    let scaled = |scale: [f32; 3]| {
        let mut node = node(0);
        node["scale"] = json!(scale);
        node
    };
    let nodes = json!([
        scaled([0., 1., 2.]),
        scaled([2., 0., 1.]),
        scaled([1., 2., 0.])
    ]);
    let flat = file(&json!([{ "type": "rect" }]), &nodes).import().unwrap();
    for instance in 0..3 {
        let found = vector_area(&flat, instance);
        assert!((found - Vec3A::NEG_Z * 4.0).length() < 1e-5, "{found}");
    }
    let centre = scene.instances[0].transform.translation;
    assert_eq!(Vec3::from(centre), Vec3::new(5.0, 6.0, 7.0));
}

#[test]
fn lights_that_cannot_shine_are_left_out_with_a_warning() {
    for (light, problem) in [
        (json!(5), "no object"),
        (json!({ "type": "sphere" }), "neither rect nor disk"),
        (json!({ "type": "disk", "size": 0 }), "no area"),
        (json!({ "type": "disk", "size": 1e-60 }), "no area"),
        (json!({ "rect": { "aspect": 0 } }), "no area"),
        (
            json!({ "size": 1e30, "rect": { "aspect": 1e30 } }),
            "infinite",
        ),
        (json!({ "intensity": 0 }), "lights nothing"),
        (
            json!({ "intensity": 3e38, "color": [100, 1, 1] }),
            "lights nothing",
        ),
    ] {
        let mut gltf = file(&json!([light]), &json!([node(0), { "mesh": 0 }]));
        gltf.indices(U8, &[0, 1, 2], 3);
        let scene = gltf.import().unwrap();
        assert_eq!(scene.instances.len(), 1);
        assert!(
            warns(&scene, "lights/0", problem),
            "{light}: {:?}",
            scene.warnings
        );
    }
    let strange = json!({ "extensions": { "EXT_lights_area": { "light": -1 } } });
    let nodes = json!([node(1), strange, { "mesh": 0 }]);
    let mut gltf = file(&json!([{ "type": "rect" }]), &nodes);
    gltf.indices(U8, &[0, 1, 2], 3);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.instances.len(), 1);
    assert!(
        warns(&scene, "nodes/0", "there are 1"),
        "{:?}",
        scene.warnings
    );
    assert!(warns(&scene, "nodes/1", "no index"), "{:?}", scene.warnings);
}

/// Numbers that mean nothing, of which the rest of the light does not suffer.
#[test]
fn impossible_numbers_have_their_defaults() {
    let light = json!({ "type": "rect", "size": "large", "intensity": -3, "color": [1, 2], "rect": { "aspect": 1e300 } });
    let scene = file(&json!([light]), &json!([node(0)])).import().unwrap();
    for member in ["size", "intensity", "color", "aspect"] {
        assert!(warns(&scene, "lights/0", member), "{member}");
    }
    assert!((vector_area(&scene, 0).length() - 1.0).abs() < 1e-6);
    assert_eq!(scene.materials[0].emission.factor, [1000.0; 3]);

    let square = json!([{ "type": "rect", "rect": [2, 1] }]);
    let scene = file(&square, &json!([node(0)])).import().unwrap();
    assert!(warns(&scene, "lights/0", "rect is no object"));
    assert!((vector_area(&scene, 0).length() - 1.0).abs() < 1e-6);
}

/// A node has one light, however many copies of its mesh there are; hidden nodes have none.
#[test]
fn lights_are_not_copied_and_are_hidden_with_their_nodes() {
    let mut gltf = file(&json!([{ "type": "disk" }]), &json!([]));
    let places = gltf.accessor("VEC3", F32, &f32_bytes(&[0.0; 9]), 3);
    let copies = json!({ "attributes": { "TRANSLATION": places } });
    gltf.indices(U8, &[0, 1, 2], 3);
    gltf.json["nodes"] = json!([
        { "mesh": 0, "extensions": { "EXT_lights_area": { "light": 0 }, "EXT_mesh_gpu_instancing": copies } },
        { "name": "out", "extensions": { "EXT_lights_area": { "light": 0 }, "KHR_node_visibility": { "visible": false } } },
    ]);
    gltf.json["scenes"][0]["nodes"] = json!([0, 1]);
    let scene = gltf.import().unwrap();
    assert_eq!(scene.instances.len(), 4);
    let is_hidden = |dismissed: &Dismissed| {
        dismissed.place.contains("out") && dismissed.reason.contains("hides")
    };
    assert!(scene.dismissed.iter().any(is_hidden));
}

/// One whose node has no extent at a moment is there all the same, without size.
#[test]
fn lights_move_with_their_nodes() {
    let mut gltf = file(&json!([{ "type": "disk" }]), &json!([node(0)]));
    super::moments::animate(&mut gltf, 0, "scale", "LINEAR", &[[0.0; 3], [2.0; 3]]);
    let options = ImportOptions {
        moments: vec![0.0, 1.0],
        ..ImportOptions::default()
    };
    let scene = gltf.import_with(&options).unwrap();
    let scales: Vec<f32> = scene
        .poses()
        .map(|pose| pose.instances[0].transform.matrix3.x_axis.length())
        .collect();
    assert_eq!(scales, [0.0, 2.0]);
}
