//! One motion, brought about in different ways.

use residual_render::passes::RenderOptions;
use serde_json::json;

use super::file::{File, options};

const SIZE: [u32; 2] = [32, 24];
const AWAY: [f32; 3] = [0.75, 0.25, -0.5];

fn scene() -> (File, usize) {
    let mut file = File::perspective(0.5);
    let mesh = file.rectangle([-0.5, 0.25], [-0.5, 0.375], 0);
    (file, mesh)
}

fn render(file: &File) -> Vec<[f32; 3]> {
    let look: RenderOptions = options(SIZE, 64, 5);
    file.film(16, &look).image()
}

/// By a node that moves.
fn by_node() -> File {
    let (mut file, mesh) = scene();
    let node = file.node(json!({ "mesh": mesh }));
    file.animate(node, "translation", "LINEAR", &[&[0.0; 3], &AWAY]);
    file
}

/// Fails unless the images are the same but for roundings, which turn few samples at edges.
fn expect_alike(a: &[[f32; 3]], b: &[[f32; 3]]) {
    let different = a.iter().zip(b).filter(|(a, b)| (a[0] - b[0]).abs() > 1e-5);
    let largest = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).abs());
    let largest = largest.fold(0.0, f32::max);
    assert!(largest < 2.5 / 64.0, "{largest}");
    assert!(different.count() < 8);
    let blurred = a.iter().filter(|[red, ..]| (0.1..0.9).contains(red));
    assert!(blurred.count() > 50, "it moves");
}

#[test]
fn a_moving_camera_is_the_scene_moving_the_other_way() {
    let (mut file, mesh) = scene();
    file.node(json!({ "mesh": mesh }));
    let back = AWAY.map(|x| -x);
    let keys: [&[f32]; 2] = [&[0.0, 0.0, 5.0], &[back[0], back[1], 5.0 + back[2]]];
    file.animate(0, "translation", "LINEAR", &keys);
    expect_alike(&render(&by_node()), &render(&file));
}

#[test]
fn morph_targets_move_as_nodes_do() {
    let (mut file, mesh) = scene();
    let target = file.floats("VEC3", 6, &AWAY.repeat(6));
    file.primitive(mesh)["targets"] = json!([{ "POSITION": target }]);
    let node = file.node(json!({ "mesh": mesh }));
    file.animate(node, "weights", "LINEAR", &[&[0.0], &[1.0]]);
    expect_alike(&render(&by_node()), &render(&file));
}

#[test]
fn skins_move_as_their_joints_do() {
    let (mut file, mesh) = scene();
    let joints = file.accessor("VEC4", 5121, 6, &[0; 24]);
    let weights = file.floats("VEC4", 6, &[1.0, 0.0, 0.0, 0.0].repeat(6));
    let attributes = &mut file.primitive(mesh)["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    let joint = file.node(json!({ "name": "joint" }));
    let skin = file.skin(json!({ "joints": [joint] }));
    file.node(json!({ "mesh": mesh, "skin": skin, "translation": [9, 9, 9] }));
    file.animate(joint, "translation", "LINEAR", &[&[0.0; 3], &AWAY]);
    expect_alike(&render(&by_node()), &render(&file));
}
