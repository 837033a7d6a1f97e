//! Compressed geometry and textures: written by the encoders of the same crates, and files of others.

use std::path::PathBuf;

use crate::common;
use crate::common::gltf_text::{F32, Gltf, SQUARE, U16, f32_bytes};
use glam::Vec3;
use meshoptimizer_rs::codec::{self, IndexEncoding, VertexEncoding};
use meshoptimizer_rs::{Limits, Workspace};
use residual_scenegen::desc::{SceneDesc, Texels};
use residual_scenegen::import::{ImportOptions, import};
use serde_json::{Value, json};

/// Models of another project, or nothing where they are not there.
fn peers() -> Option<PathBuf> {
    let folder = common::scenes()?.join("peers");
    folder.is_dir().then_some(folder)
}

fn read(path: &std::path::Path) -> SceneDesc {
    import(path, &ImportOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn extension(buffer_length: usize, count: usize, stride: usize, mode: &str) -> Value {
    json!({ "buffer": 0, "byteLength": buffer_length, "count": count, "byteStride": stride, "mode": mode })
}

/// The square, with its positions and its indices compressed under an extension's name.
fn compressed(name: &str, change: impl Fn(&mut Vec<u8>)) -> Gltf {
    let workspace = &mut Workspace::new(Limits::default());
    let mut gltf = Gltf::new();
    gltf.json["extensionsRequired"] = json!([name]);
    // Four floats each, as the codec wants multiples of four bytes, which twelve are.
    let positions = f32_bytes(SQUARE.as_flattened());
    let mut bytes =
        codec::encode_vertex_buffer(&positions, 4, 12, VertexEncoding::default(), workspace)
            .unwrap();
    change(&mut bytes);
    let accessor = gltf.attribute("POSITION", "VEC3", F32, &bytes, 4);
    let mut json = extension(bytes.len(), 4, 12, "ATTRIBUTES");
    json["byteOffset"] = gltf.json["bufferViews"][accessor]["byteOffset"].clone();
    gltf.json["bufferViews"][accessor]["extensions"] = json!({ name: json });
    let indices =
        codec::encode_index_buffer(&[0, 1, 2, 0, 2, 3], IndexEncoding::default(), workspace)
            .unwrap();
    gltf.indices(U16, &indices, 6);
    let mut json = extension(indices.len(), 6, 2, "TRIANGLES");
    json["byteOffset"] = gltf.json["bufferViews"][1]["byteOffset"].clone();
    gltf.json["bufferViews"][1]["extensions"] = json!({ name: json });
    gltf
}

#[test]
fn compressed_buffer_views_are_decoded() {
    for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
        let scene = compressed(name, |_| {}).import().unwrap();
        let mesh = &scene.meshes[0];
        let mut corners: Vec<Vec<Vec3>> = mesh
            .triangles
            .iter()
            .map(|corners| {
                corners
                    .map(|corner| mesh.positions[corner as usize])
                    .to_vec()
            })
            .collect();
        for triangle in &mut corners {
            // The codec turns triangles.
            triangle.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        }
        let [a, b, c, d] = SQUARE.map(Vec3::from);
        assert_eq!(corners, [vec![a, b, c], vec![a, d, c]]);
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

#[test]
fn damage_of_compressed_buffer_views_is_named() {
    let name = "EXT_meshopt_compression";
    compressed(name, |bytes| bytes[0] = 0).refused(&["bufferViews/0", "cannot be decoded"]);
    compressed(name, |bytes| bytes.truncate(5)).refused(&["bufferViews/0", "cannot be decoded"]);
    let with = |member: &str, value: Value| {
        let mut gltf = compressed(name, |_| {});
        gltf.json["bufferViews"][0]["extensions"][name][member] = value;
        gltf
    };
    with("mode", json!("STRIPS")).refused(&["unknown mode \"STRIPS\""]);
    with("filter", json!("MAGIC")).refused(&["unknown filter \"MAGIC\""]);
    with("count", json!(-4)).refused(&["bufferViews/0", "count"]);
    with("count", json!(4_000_000_000_u64)).refused(&["1 GiB"]);
    with("byteLength", json!(1_000_000)).refused(&["reaches beyond"]);
    with("buffer", json!(7)).refused(&["buffer that there is not"]);
}

/// Positions and normals of an instance, in the world.
fn in_world(scene: &SceneDesc, instance: usize) -> Vec<[Vec3; 2]> {
    let instance = &scene.instances[instance];
    let mesh = &scene.meshes[instance.mesh];
    let vertices = mesh.positions.iter().zip(&mesh.normals);
    vertices
        .map(|(&position, &normal)| {
            let normal = instance.transform.transform_vector3(normal).normalize();
            [instance.transform.transform_point3(position), normal]
        })
        .collect()
}

#[test]
fn files_of_other_encoders_are_decoded() {
    let Some(peers) = peers() else { return };
    let folder = peers.join("gltf-transform/packages/extensions/test/in");
    for name in ["BoxMeshopt.glb", "BoxMeshopt.gltf", "BoxDraco.gltf"] {
        let scene = read(&folder.join(name));
        let vertices = in_world(&scene, 0);
        let positions = vertices.iter().map(|[position, _]| *position);
        let low = positions.clone().reduce(Vec3::min).unwrap();
        let high = positions.reduce(Vec3::max).unwrap();
        let half = Vec3::splat(0.5);
        assert!(
            low.distance(-half) < 1e-3 && high.distance(half) < 1e-3,
            "{name}: {low} {high}"
        );
        assert_eq!(scene.meshes[0].triangles.len(), 12, "{name}");
        // Normals point away from the middle of a box.
        let outwards = |[position, normal]: &[Vec3; 2]| normal.dot(*position) > 0.4;
        assert!(vertices.iter().all(outwards), "{name}");
    }
    // Sparse accessors replace elements of what was compressed.
    let scene = read(&folder.join("DracoSparseMesh.gltf"));
    assert!(!scene.meshes.is_empty());
    // As many triangles as its accessors say.
    let path = peers.join("assimp/glTF2/draco/2CylinderEngine.gltf");
    let json: Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    let meshes = json["meshes"].as_array().unwrap().iter();
    let primitives = meshes.flat_map(|mesh| mesh["primitives"].as_array().unwrap());
    let count = |primitive: &Value| {
        let indices = primitive["indices"].as_u64().unwrap() as usize;
        json["accessors"][indices]["count"].as_u64().unwrap() as usize
    };
    let expected: usize = primitives.map(count).sum();
    let engine = read(&path);
    let triangles: usize = engine.meshes.iter().map(|mesh| mesh.triangles.len()).sum();
    assert_eq!(3 * triangles, expected);
}

#[test]
fn damaged_draco_is_an_error_and_never_a_panic() {
    let Some(peers) = peers() else { return };
    let folder = peers.join("gltf-transform/packages/extensions/test/in");
    let text = std::fs::read_to_string(folder.join("BoxDraco.gltf")).unwrap();
    let json: Value = serde_json::from_str(&text).unwrap();
    let uri = json["buffers"][0]["uri"].as_str().unwrap();
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("box.gltf");
    let Some((head, digits)) = uri.split_once(',') else {
        return;
    };
    for at in (0..digits.len()).step_by(3) {
        let mut damaged = digits.as_bytes().to_vec();
        damaged[at] = if damaged[at] == b'A' { b'/' } else { b'A' };
        let mut json = json.clone();
        json["buffers"][0]["uri"] =
            json!(format!("{head},{}", String::from_utf8(damaged).unwrap()));
        std::fs::write(&path, json.to_string()).unwrap();
        // Either is fine.
        let _ = import(&path, &ImportOptions::default());
    }
}

#[test]
fn basis_textures_are_decoded() {
    let Some(peers) = peers() else { return };
    let folder = peers.join("gltf-transform/packages/extensions/test/in");
    let texels = |name: &str| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let mut gltf = Gltf::square();
        let view = gltf.view(&bytes);
        gltf.json["extensionsRequired"] = json!(["KHR_texture_basisu"]);
        gltf.json["images"] = json!([{ "bufferView": view, "mimeType": "image/ktx2" }]);
        gltf.json["textures"] =
            json!([{ "extensions": { "KHR_texture_basisu": { "source": 0 } } }]);
        gltf.json["materials"] =
            json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
        gltf.primitive()["material"] = json!(0);
        gltf.import().unwrap()
    };
    // The same picture three times: raw bytes are no Basis texture, and a reason to be white.
    let [etc1s, uastc] = ["2d_etc1s.ktx2", "2d_uastc.ktx2"].map(|name| {
        let mut scene = texels(name);
        let image = scene.images.remove(0);
        assert!(
            !scene.warnings.iter().any(|w| w.place.contains("images")),
            "{:?}",
            scene.warnings
        );
        match image.texels {
            Texels::Rgba8(texels) => ([image.width, image.height], texels),
            other => panic!("{other:?}"),
        }
    });
    assert_eq!(etc1s.0, uastc.0);
    let count = (etc1s.0[0] * etc1s.0[1]) as f64;
    let difference: f64 = etc1s
        .1
        .iter()
        .flatten()
        .zip(uastc.1.iter().flatten())
        .map(|(a, b)| f64::from(a.abs_diff(*b)))
        .sum();
    assert!(difference / count < 60.0, "{}", difference / count);
    let distinct: std::collections::HashSet<_> = uastc.1.iter().collect();
    assert!(distinct.len() > 4);
    let raw = texels("2d_rgba8.ktx2");
    assert!(common::gltf_text::warns(
        &raw,
        "images/0",
        "no Basis Universal texture"
    ));
}
