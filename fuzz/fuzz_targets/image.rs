//! Images: as the texture and the normal map of a square, and as the sky.

#![no_main]

use libfuzzer_sys::fuzz_target;

const SCENE: &str = r#"{"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}},"normalTexture":{"index":0}}],
"textures":[{"source":0}],"images":[{"uri":"image"}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}]}"#;

fuzz_target!(|data: &[u8]| {
    residual_fuzz::write("scene.gltf", SCENE.as_bytes());
    residual_fuzz::write("image", data);
    residual_fuzz::read("scene.gltf", Some("image"));
});
