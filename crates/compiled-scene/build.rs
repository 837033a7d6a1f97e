//! Says where the emitted code is: in the file that `RESIDUAL_SCENE` names, or in `src/no_scene.rs` without it. The build
//! script of all crates that are built around emitted code.

use std::env;
use std::path::PathBuf;

fn main() {
    let package = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let code = env::var_os("RESIDUAL_SCENE")
        .map_or_else(|| package.join("src").join("no_scene.rs"), PathBuf::from);
    println!("cargo::rerun-if-env-changed=RESIDUAL_SCENE");
    println!("cargo::rustc-env=RESIDUAL_EMITTED_CODE={}", code.display());
}
