//! Compiled renderers, and no compiler.

use std::path::Path;
use std::process::{Command, Output};

use residual_tests::pictures::{first_difference, read_exr};
use tempfile::TempDir;

use super::{fails, good, statistics, stderr, workplace};

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

/// Renders without a compiler and without compiled renderers.
fn without_compiler(folder: &TempDir, args: &[&str]) -> Output {
    let size = ["--size", "64x48", "--threads", "1"];
    // Enough samples for the failure to be known before the last.
    let samples = ["--spp", "1024", "--stats", "json"];
    Command::new(env!("CARGO_BIN_EXE_residual-tests"))
        .current_dir(folder)
        .env("CARGO", "no-such-cargo")
        .env("CARGO_TARGET_DIR", folder.path().join("target"))
        .env_remove("RESIDUAL_CACHE_DIR")
        .args(["render", "triangle.obj"])
        .args([&size[..], &samples, args].concat())
        .output()
        .unwrap()
}

/// Without a compiler the image is made all the same, and it is said why it was interpreted; a compiled renderer that
/// was asked for outright is not replaced by another.
#[test]
fn a_missing_compiler_is_reported() {
    let folder = workplace();
    let picture = |name: &str| read_exr(&folder.path().join(name)).unwrap().1;
    let auto = good(without_compiler(&folder, &["-o", "auto.exr"]));
    let messages = stderr(&auto);
    assert!(messages.contains("could not be compiled"), "{messages}");
    assert!(messages.contains("no-such-cargo"), "{messages}");
    assert_eq!(statistics(&auto)["tier"], "interpreted");

    for (name, args) in [
        ("tier.exr", ["--tier", "interpreted"]),
        ("none.exr", ["--specialize", "none"]),
    ] {
        let output = good(without_compiler(
            &folder,
            &[&args[..], &["-o", name]].concat(),
        ));
        let stats = statistics(&output);
        assert_eq!(stats["tier"], "interpreted");
        assert_eq!(stats["seconds"]["compile"], 0.0);
        // Nobody has asked for a compiler.
        assert!(!stderr(&output).contains("compiled"), "{}", stderr(&output));
        let difference = first_difference(&picture("auto.exr"), &picture(name));
        assert_eq!(difference, None, "{name}");
    }

    let specialized = without_compiler(&folder, &["--tier", "specialized", "-o", "s.exr"]);
    fails(&specialized, &["no-such-cargo", "--tier interpreted"]);
    assert!(!folder.path().join("s.exr").exists());
}
