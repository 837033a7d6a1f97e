//! `emit`.

use std::fs;

use super::{good, run, workplace};

#[test]
fn emission_is_deterministic_and_the_same_everywhere() {
    let folder = workplace();
    fs::copy(
        folder.path().join("triangle.obj"),
        folder.path().join("house.v2.obj"),
    )
    .unwrap();
    for (scene, file) in [
        ("triangle.obj", "out/triangle.rs"),
        ("house.v2.obj", "out/house.v2.rs"),
    ] {
        let emit = |more: &[&str]| {
            good(run(
                &folder,
                &[&["emit", scene, "--target", "rust"], more].concat(),
            ))
            .stdout
        };
        let text = emit(&[]);
        assert!(text.starts_with(b"// Renderer for the scene"));
        assert_eq!(text, emit(&[]));
        emit(&["-o", "out"]);
        assert_eq!(text, fs::read(folder.path().join(file)).unwrap());
        assert_ne!(text, emit(&["--lanes", "1"]));
    }
}
