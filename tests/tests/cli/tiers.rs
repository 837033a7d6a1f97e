//! Compiled renderers, and no compiler.

use std::fs;
use std::path::Path;
use std::process::Command;

use residual_tests::pictures::{first_difference, read_exr};

use super::{good, statistics, workplace};

/// Compiles a renderer, by way of a target directory given relative to where the command is run.
#[cfg(unix)]
#[test]
fn specialised_renderers_are_compiled_from_any_folder() {
    let folder = workplace();
    let target = Path::new(env!("CARGO_BIN_EXE_residual-tests"))
        .ancestors()
        .nth(2)
        .unwrap();
    std::os::unix::fs::symlink(target, folder.path().join("built")).unwrap();
    let render = |tier: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_residual-tests"))
            .current_dir(&folder)
            .env("CARGO_TARGET_DIR", "built")
            .args([
                "render",
                "triangle.obj",
                "--size",
                "16x12",
                "--spp",
                "2",
                "--stats",
                "json",
            ])
            .args(["--tier", tier, "-o", &format!("{tier}.exr")])
            .output()
            .unwrap();
        let stats = statistics(&good(output));
        assert_eq!(stats["tier"], tier);
        let compile = stats["seconds"]["compile"].as_f64().unwrap();
        assert_eq!(compile > 0.0, tier == "specialized");
        read_exr(&folder.path().join(format!("{tier}.exr")))
            .unwrap()
            .1
    };
    assert_eq!(
        first_difference(&render("interpreted"), &render("specialized")),
        None
    );
}

/// Without a compiler the image is made all the same, and it is said why it was interpreted; a compiled renderer that
/// was asked for outright is not replaced by another.
#[test]
fn a_missing_compiler_is_reported() {
    let folder = workplace();
    let render = |tier: &str| {
        Command::new(env!("CARGO_BIN_EXE_residual-tests"))
            .current_dir(&folder)
            .env("CARGO", "no-such-cargo")
            .args(["render", "triangle.obj", "--size", "64x48", "--time", "2s"])
            .args(["--tier", tier])
            .output()
            .unwrap()
    };
    let auto = render("auto");
    let messages = String::from_utf8_lossy(&auto.stderr);
    assert_eq!(auto.status.code(), Some(0), "{messages}");
    assert!(messages.contains("could not be compiled"), "{messages}");
    assert!(messages.contains("no-such-cargo"), "{messages}");
    assert!(folder.path().join("triangle.png").exists());

    let specialized = render("specialized");
    assert_eq!(specialized.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&specialized.stderr).contains("no-such-cargo"));
}
