//! `.obj` files, without libraries.

#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    residual_fuzz::write("scene.obj", data);
    residual_fuzz::read("scene.obj", None);
});
