//! What is built around emitted code is linked with the crates that the command line was built with. Cargo builds a crate
//! again where other features are asked for, of itself or of anything below it: minutes, before the first scene is compiled.

use std::collections::{BTreeMap, BTreeSet};

use residual_driver::cargo;

/// All that a package is built from, each with its version and features, as cargo resolves them for this package alone.
fn built_from(package: &str) -> BTreeSet<String> {
    tree(&["--package", package, "--edges", "normal,build"])
}

/// All that the workspace with its tests is built from.
fn of_workspace() -> BTreeSet<String> {
    tree(&["--workspace", "--edges", "normal,build,dev"])
}

/// What cargo resolves for what the arguments choose.
fn tree(arguments: &[&str]) -> BTreeSet<String> {
    let output = cargo::command()
        .args(["tree", "--offline", "--prefix", "none"])
        .args(arguments)
        .args(["--format", "{p} with features {f}"])
        .output()
        .unwrap();
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{message}");
    let text = String::from_utf8(output.stdout).unwrap();
    let lines = text.lines().map(|line| line.trim_end_matches(" (*)"));
    lines.map(|line| line.trim_end().to_owned()).collect()
}

#[test]
fn what_is_built_around_emitted_code_has_nothing_else_built_again() {
    for around in ["residual-compiled-scene", "residual-standalone"] {
        let needed = built_from(around);
        assert!(needed.len() > 10, "{needed:?}");
        // The command line without its GPU device, which compiles no scenes.
        let program = built_from("xtask");
        let again: Vec<_> = needed.difference(&program).collect();
        let [only] = again[..] else {
            panic!("{again:#?}")
        };
        assert!(only.starts_with(&format!("{around} ")), "{only}");
    }
}

/// Tests follow on the command line's build. What asks for other features then is to be asked for by bvh, frontend or scenegen, too:
/// their Cargo.toml have lists.
#[test]
fn tests_have_nothing_built_again_behind_the_command_line() {
    let program = built_from("xtask");
    let tests = of_workspace();
    let again: Vec<_> = program
        .difference(&tests)
        // These have a feature of their own for the GPU device.
        .filter(|crate_| !crate_.starts_with("xtask ") && !crate_.starts_with("residual-driver "))
        .collect();
    assert!(again.is_empty(), "{again:#?}");
}

/// Examples have build scripts that make renderers: with other features below scenegen, cargo would build it for them again.
#[test]
fn build_scripts_share_what_the_workspace_builds() {
    let mut features = BTreeMap::<String, BTreeSet<String>>::new();
    for line in of_workspace() {
        // Between members there are blank lines.
        if let Some((package, of_package)) = line.split_once(" with features") {
            let all = features.entry(package.to_owned()).or_default();
            all.insert(of_package.to_owned());
        }
    }
    assert!(features.len() > 100, "{features:?}");
    // The compiler's own macros need other parts of these than programs that read Rust.
    let again = features.iter().filter(|(package, of_package)| {
        of_package.len() > 1
            && !["syn ", "proc-macro2 "]
                .iter()
                .any(|of| package.starts_with(of))
    });
    let again: Vec<_> = again.collect();
    assert!(again.is_empty(), "{again:#?}");
}
