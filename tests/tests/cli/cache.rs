//! `cache`, in a place of its own: the developer's is left alone.

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};

use residual_tests::pictures::{first_difference, read_exr};
use serde_json::json;
use tempfile::TempDir;

use super::{fails, good, statistics, workplace};

/// A command with a cache in the folder.
fn command(folder: &TempDir, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_residual-tests"));
    let command_line = command.current_dir(folder).args(args);
    command_line.env("RESIDUAL_CACHE_DIR", folder.path().join("kept"));
    command
}

/// Renders with a compiled renderer.
fn specialized(folder: &TempDir, scene: &str, change: fn(&mut Command) -> &mut Command) -> Output {
    let mut command = command(folder, &["render", scene, "--tier", "specialized"]);
    command.args(["--size", "16x12", "--spp", "2", "--threads", "1"]);
    command.args(["--stats", "json", "-o", "a.exr"]);
    change(&mut command).output().unwrap()
}

fn without_cargo(command: &mut Command) -> &mut Command {
    command.env("CARGO", "no-such-cargo")
}

/// Where compiled renderers lie.
fn entries(folder: &TempDir) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder.path().join("kept/residual"));
    let entries = entries.into_iter().flatten();
    entries.map(|entry| entry.unwrap().path()).collect()
}

fn says(folder: &TempDir, args: &[&str]) -> String {
    String::from_utf8(good(command(folder, args).output().unwrap()).stdout).unwrap()
}

#[test]
fn compiled_renderers_are_kept_and_found_and_removed() {
    let folder = workplace();
    let picture = || read_exr(&folder.path().join("a.exr")).unwrap().1;
    fails(
        &specialized(&folder, "triangle.obj", without_cargo),
        &["no-such-cargo", "--tier interpreted"],
    );
    assert!(says(&folder, &["cache", "list"]).contains("0 compiled renderers"));
    assert!(entries(&folder).is_empty());

    good(specialized(&folder, "triangle.obj", |c| c));
    let [kept] = &entries(&folder)[..] else {
        panic!("one is kept")
    };
    let first = picture();
    let list = says(&folder, &["cache", "list"]);
    let key = kept.file_name().unwrap().to_str().unwrap();
    assert!(list.contains("1 compiled renderers"), "{list}");
    assert!(list.contains(key) && list.contains("triangle"), "{list}");

    // The same scene under another name needs no compiler.
    let copy = folder.path().join("house.v2.obj");
    fs::copy(folder.path().join("triangle.obj"), copy).unwrap();
    fs::remove_file(folder.path().join("a.exr")).unwrap();
    let again = good(specialized(&folder, "house.v2.obj", without_cargo));
    assert_eq!(statistics(&again)["tier"], json!("specialized"));
    assert_eq!(first_difference(&first, &picture()), None);
    assert_eq!(entries(&folder), std::slice::from_ref(kept));

    // A damaged one is made anew.
    fs::write(kept.join("library"), "no library").unwrap();
    fails(&specialized(&folder, "triangle.obj", without_cargo), &[]);
    good(specialized(&folder, "triangle.obj", |c| c));
    good(specialized(&folder, "triangle.obj", without_cargo));
    assert_eq!(entries(&folder), std::slice::from_ref(kept));

    // Where there is too much, the last stays.
    good(specialized(&folder, "cameras.gltf", |c| {
        c.env("RESIDUAL_CACHE_MIB", "0")
    }));
    let [other] = &entries(&folder)[..] else {
        panic!("one is kept")
    };
    assert_ne!(other, kept);

    let beside = folder.path().join("kept/precious");
    fs::write(&beside, "").unwrap();
    assert!(says(&folder, &["cache", "clear"]).contains("removed 1 compiled"));
    assert!(entries(&folder).is_empty() && beside.exists());
    assert!(says(&folder, &["cache", "clear"]).contains("removed 0 compiled"));
}
