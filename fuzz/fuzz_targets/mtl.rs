//! `.mtl` files, with an object that asks for materials of the names that seeds have.

#![no_main]

use std::fmt::Write;

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let mut object = "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n".to_owned();
    let text = String::from_utf8_lossy(data);
    let names = text.lines().filter_map(|line| line.strip_prefix("newmtl "));
    for name in names.take(16) {
        let _ = writeln!(object, "usemtl {name}\nf 1/1 2/2 3/3");
    }
    residual_fuzz::write("scene.mtl", data);
    residual_fuzz::write("scene.obj", object.as_bytes());
    residual_fuzz::read("scene.obj", None);
});
