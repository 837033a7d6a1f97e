//! Files that glTF files name, as exporters write their names.

use std::path::Path;

use crate::common::gltf_text::{Gltf, warns};
use residual_scenegen::desc::{SceneDesc, Texels};
use residual_scenegen::import::{ImportOptions, import};
use serde_json::json;

/// Imports a square whose buffer and image have these URIs, with files of these names beside it. The image is red.
fn with_files(buffer: &str, image: &str, files: [&str; 2]) -> SceneDesc {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    };
    let mut gltf = Gltf::square();
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_pixel(1, 1, image::Rgb([255, 0, 0]))
        .write_to(&mut png, image::ImageFormat::Png)
        .unwrap();
    write(files[0], &gltf.bytes);
    write(files[1], png.get_ref());
    let place = folder.path().to_str().unwrap();
    let uri = |uri: &str| uri.replace("{FOLDER}", place);
    gltf.json["buffers"] = json!([{ "uri": uri(buffer), "byteLength": gltf.bytes.len() }]);
    gltf.json["images"] = json!([{ "uri": uri(image) }]);
    gltf.json["textures"] = json!([{ "source": 0 }]);
    gltf.json["materials"] =
        json!([{ "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }]);
    gltf.primitive()["material"] = json!(0);
    let path = folder.path().join("scene.gltf");
    std::fs::write(&path, gltf.json.to_string()).unwrap();
    import(Path::new(&path), &ImportOptions::default()).unwrap()
}

fn is_red(scene: &SceneDesc) -> bool {
    matches!(&scene.images[0].texels, Texels::Rgba8(texels) if texels[..] == [[255, 0, 0, 255]])
}

#[test]
fn names_are_read_as_exporters_write_them() {
    for (uri, file) in [
        ("a.png", "a.png"),
        ("red%20tile.png", "red tile.png"),
        ("red tile.png", "red tile.png"),
        ("red%20tile.png", "red%20tile.png"),
        ("red%2520tile.png", "red tile.png"),
        ("gr%C3%BCn.png", "grün.png"),
        ("gr%FCn.png", "grün.png"),
        ("textures\\a.png", "textures/a.png"),
        (".\\textures\\a.png", "textures/a.png"),
        ("./textures/a.png", "textures/a.png"),
        ("textures%5Ca.png", "textures/a.png"),
        ("Textures/A.PNG", "textures/a.png"),
        ("100%.png", "100%.png"),
        ("a#1.png", "a#1.png"),
        ("a.png?v=2", "a.png"),
        ("file:a.png", "a.png"),
        ("file://{FOLDER}/a.png", "a.png"),
        ("FILE://localhost{FOLDER}/a.png", "a.png"),
        ("{FOLDER}/a.png", "a.png"),
    ] {
        let scene = with_files("scene.bin", uri, ["scene.bin", file]);
        assert!(is_red(&scene), "{uri}: {:?}", scene.warnings);
        assert!(!warns(&scene, "images", ""), "{uri}: {:?}", scene.warnings);
        // Buffers likewise.
        let scene = with_files(uri, "i.tga", [file, "i.tga"]);
        assert_eq!(scene.meshes.len(), 1, "{uri}");
        assert!(!warns(&scene, "buffers", ""), "{uri}");
    }
}

#[test]
fn files_of_other_machines_are_looked_for_beside_the_scene() {
    for (uri, file) in [
        ("C:\\Users\\me\\textures\\a.png", "a.png"),
        ("file:///C:/Users/me/textures/a.png", "textures/a.png"),
        ("/home/me/models/textures/A.png", "textures/a.png"),
        ("../../models/a.png", "a.png"),
    ] {
        let scene = with_files("scene.bin", uri, ["scene.bin", file]);
        assert!(is_red(&scene), "{uri}: {:?}", scene.warnings);
        assert!(
            warns(&scene, "images/0", "is not here"),
            "{uri}: {:?}",
            scene.warnings
        );
    }
    let absent = with_files("scene.bin", "b.png", ["scene.bin", "a.png"]);
    assert!(!is_red(&absent) && warns(&absent, "images/0", "b.png"));
    let remote = with_files(
        "scene.bin",
        "https://example.com/a.png",
        ["scene.bin", "a.png"],
    );
    assert!(!is_red(&remote) && warns(&remote, "images/0", "not fetched"));
}

#[test]
fn data_is_told_by_its_last_parameter() {
    for uri in [
        "data:application/octet-stream;base64,{}",
        "data:application/gltf-buffer;base64,{}",
        "DATA:;BASE64,{}",
        "data:application/octet-stream;charset=utf-8;base64,{}",
    ] {
        let gltf = Gltf::square();
        let digits: Vec<u8> = gltf.bytes.clone();
        let text = base64(&digits);
        let scene = with_files(&uri.replace("{}", &text), "i.tga", ["i", "i.tga"]);
        assert_eq!(scene.meshes.len(), 1, "{uri}");
    }
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    assert!(bytes.len().is_multiple_of(3));
    let digit = |bits: u32, k: u32| char::from(DIGITS[(bits >> (18 - 6 * k) & 63) as usize]);
    bytes
        .chunks(3)
        .flat_map(|three| {
            let bits = u32::from(three[0]) << 16 | u32::from(three[1]) << 8 | u32::from(three[2]);
            (0..4).map(move |k| digit(bits, k))
        })
        .collect()
}
