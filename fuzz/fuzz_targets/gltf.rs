//! `.gltf` and `.glb` files, which tell each other apart by how they begin.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    residual_fuzz::write("scene.gltf", data);
    residual_fuzz::read("scene.gltf", None);
});
